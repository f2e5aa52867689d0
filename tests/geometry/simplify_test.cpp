#include "easypbr/geometry/remesh.h"

#include <gtest/gtest.h>

#include <limits>

#include "easypbr/core/log.h"
#include "easypbr/geometry/nearest.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/geometry/repair.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/merge.h"
#include "geometry/measure.h"
#include "refusal.h"
#include "test_data.h"

namespace easypbr::simplify_test {
namespace {

TEST(Decimate, APlaneNeedsFewFaces) {
    // All errors are 0, so the error says where to stop: at faces that reach from border to border.
    const auto plane = decimate(make_plane(2, 32), {{}, 1e-6}).snapshot();
    EXPECT_LT(plane->F.rows(), 40);
    EXPECT_NEAR(area(*plane), 4, 1e-5);
    EXPECT_EQ(plane->N.rows(), plane->V.rows());
    for (Eigen::Index i = 0; i < plane->V.rows(); ++i)
        // What is left is vertices of the original with all that they had.
        EXPECT_LT(
            (Vec2(plane->UV.row(i)) - Vec2(plane->V(i, 0) / 2 + 0.5f, 0.5f - plane->V(i, 2) / 2)).norm(),
            1e-6f);
}

TEST(Decimate, ASphereToANumberOfFaces) {
    const Mesh ball = make_icosphere(1, 5);  // 20480 faces
    const auto simple = decimate(ball, {2000, {}}).snapshot();
    EXPECT_LE(simple->F.rows(), 2000);
    EXPECT_GE(simple->F.rows(), 1990) << "an edge takes two faces with it";
    EXPECT_TRUE(is_closed(*simple));
    EXPECT_EQ(euler_characteristic(*simple), 2);
    // A sphere of m equal faces has edges of h^2 = 16 pi / (m sqrt(3)) = 0.0145 and volume 4/3 pi (1 - h^2 /
    // 4 + ...).
    EXPECT_NEAR(volume(*simple), 4.18879, 4.18879 * 0.008);
    EXPECT_LT(surface_distance(Mesh(*simple), ball).max, 0.02);
}

TEST(Decimate, ToAnErrorInTheMeshsUnit) {
    for (const float scale : {1.0f, 100.0f}) {
        const Mesh ball = make_icosphere(scale, 5);
        const Mesh simple = decimate(ball, {{}, 0.01 * double(scale)});
        EXPECT_LT(simple.F().rows(), 2000);
        EXPECT_GT(simple.F().rows(), 100);
        // The quadric error is a mean over planes, not a bound on the distance; it is near it.
        EXPECT_LT(surface_distance(simple, ball).max, 0.02 * double(scale));
    }
}

TEST(Decimate, PartsStayApartWithoutCracks) {
    MeshData left = *make_plane(2, 32).snapshot();
    MeshData right = transformed(left, Eigen::Affine3d(Eigen::Translation3d(2, 0, 0)));
    left.name = "left";
    right.name = "right";
    right.materials.resize(1);
    right.materials[0].roughness = 0.125f;
    const auto simple = decimate(Mesh(merged(std::vector{left, right})), {400, {}}).snapshot();
    EXPECT_NO_THROW(validate(*simple));
    ASSERT_EQ(simple->parts.size(), 2u);
    EXPECT_EQ(simple->parts[1].first_face, simple->parts[0].face_count);
    EXPECT_EQ(simple->parts[0].face_count + simple->parts[1].face_count, simple->F.rows());
    EXPECT_EQ(simple->materials.at(size_t(simple->parts[1].material)).roughness, 0.125f);
    for (int f = simple->parts[1].first_face; f < simple->F.rows(); ++f)
        for (int k = 0; k < 3; ++k)
            ASSERT_GE(simple->V(simple->F(f, k), 0), 1 - 1e-6f) << "a face of the right part";
    // The common border is still in 32 pieces on both sides.
    int on_border = 0;
    for (Eigen::Index v = 0; v < simple->V.rows(); ++v) on_border += std::abs(simple->V(v, 0) - 1) < 1e-6f;
    EXPECT_EQ(on_border, 2 * 33);
}

TEST(Decimate, LeavesOutWhatBelongsToFaces) {
    MeshData plane = *make_plane(1, 16).snapshot();
    plane.L = Array1i(Array1i::Dense::Ones(plane.F.rows()));
    plane.scalars = {{"of faces", Array1f(Array1f::Dense::Ones(plane.F.rows()))},
                     {"of vertices", Array1f(Array1f::Dense(plane.V.col(0)))}};
    std::vector<std::string> warnings;
    set_log_sink([&](LogLevel, std::string_view text) { warnings.emplace_back(text); });
    const auto simple = decimate(Mesh(plane), {100, {}}).snapshot();
    plane.L = {};
    plane.scalars.erase(plane.scalars.begin());
    (void)decimate(Mesh(plane), {100, {}});
    set_log_sink(nullptr);
    ASSERT_EQ(warnings.size(), 1u) << "nothing is lost of the second one";
    EXPECT_NE(warnings[0].find("labels, scalars 'of faces' belong to its faces"), std::string::npos);
    EXPECT_TRUE(simple->L.empty());
    ASSERT_EQ(simple->scalars.size(), 1u);
    EXPECT_EQ(simple->scalars[0].values, simple->V.col(0));
}

TEST(Decimate, RefusesWhatIsNoGoal) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(refusal([] { decimate(make_box(), {}); }).find("got neither"), std::string::npos);
    EXPECT_THROW(decimate(make_box(), {-1, {}}), ArgumentError);
    EXPECT_THROW(decimate(make_box(), {{}, -1.0}), ArgumentError);
    EXPECT_THROW(decimate(make_box(), {{}, nan}), ArgumentError);
    EXPECT_THROW(decimate(Mesh(), {10, {}}), ArgumentError);
    EXPECT_EQ(decimate(make_box(), {1000, {}}).F().rows(), 12) << "fewer already";
}

TEST(Decimate, SurvivesDegenerateFaces) {
    MeshData data;
    data.V = Array3f::Dense(Array3f::Dense::Constant(30, 3, 1.0f));
    Array3i::Dense F(10, 3);
    for (int f = 0; f < 10; ++f) F.row(f) << 3 * f, 3 * f + 1, 3 * f + 2;
    data.F = F;
    EXPECT_NO_THROW(decimate(Mesh(data), {5, {}}));
    EXPECT_NO_THROW(decimate(Mesh(data), {{}, 0.1}));
}

TEST(RealDecimation, KeepsTheBunny) {
    REQUIRE_TEST_DATA();
    const Mesh bunny = io::load_mesh(test_data("bunny.ply"));
    const Mesh simple = decimate(bunny, {5000, {}});
    EXPECT_LE(simple.F().rows(), 5000);
    EXPECT_GE(simple.F().rows(), 4950);
    // The bunny is 0.25 long; a twelfth of its faces stay within half a percent of that.
    EXPECT_LT(hausdorff_distance(simple, bunny, 20000), 0.00125);
}

}  // namespace
}  // namespace easypbr::simplify_test

#include "easypbr/geometry/remesh.h"

#include <gtest/gtest.h>

#include <cmath>

#include "easypbr/geometry/primitives.h"
#include "geometry/measure.h"
#include "refusal.h"

namespace easypbr::refine_test {
namespace {

using Rows3 = Array3f::Dense;

TEST(Upsample, MidpointsLeaveTheSurfaceWhereItIs) {
    const auto box = upsample(make_box({1, 2, 3}), 2).snapshot();
    EXPECT_EQ(box->F.rows(), 12 * 16);
    EXPECT_NEAR(area(*box), 22, 1e-5);
    EXPECT_NEAR(volume(*box), 6, 1e-6);
    EXPECT_TRUE(is_closed(*box));
    EXPECT_EQ(euler_characteristic(*box), 2);
    EXPECT_EQ(normal_agreement(*box).first, 1) << "the sides are flat as before";
    EXPECT_NO_THROW(validate(*box));
}

TEST(Upsample, HandsDownWhatVerticesAndFacesHave) {
    MeshData data;
    data.V = Rows3{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
    data.F = Array3i::Dense{{0, 1, 2}};
    data.I = Array1f(Array1f::Dense{{0, 2, 4}});
    data.L = Array1i(Array1i::Dense{{5}});
    data.scalars = {{"face", Array1f(Array1f::Dense{{7}})}, {"vertex", Array1f(Array1f::Dense{{1, 2, 3}})}};
    data.materials.resize(1);
    data.parts = {{"all", 0, 1, 0}};
    const auto fine = upsample(Mesh(data)).snapshot();
    EXPECT_NO_THROW(validate(*fine));
    ASSERT_EQ(fine->V.rows(), 6);
    for (Eigen::Index i = 0; i < 6; ++i) EXPECT_EQ(fine->I[i], fine->V(i, 0) + 2 * fine->V(i, 1));
    EXPECT_EQ(Array1i::Dense(fine->L), Array1i::Dense::Constant(4, 5));
    EXPECT_EQ(fine->scalars[0].values.rows(), 4);
    EXPECT_EQ(fine->scalars[1].values.rows(), 6);
    EXPECT_EQ(fine->parts[0].face_count, 4);
}

TEST(Upsample, LoopKeepsPlanesAndTheirBorders) {
    const auto plane = upsample(make_plane(2, 4), 2, Subdivision::loop).snapshot();
    EXPECT_EQ(plane->V.col(1).cwiseAbs().maxCoeff(), 0);
    // Straight borders stay; of the corners, where a smooth curve cannot turn, 3/4 + 2/8 * 3/4 is left each
    // time.
    EXPECT_NEAR(plane->V.col(0).maxCoeff(), 1, 1e-6);
    EXPECT_LT(area(*plane), 4);
    EXPECT_GT(area(*plane), 3.9);
}

TEST(Upsample, LoopLimitOfATetrahedronIsOnPaper) {
    // One step by hand on corners (1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1): a corner has three
    // neighbours of sum -corner, so it becomes (1 - 9/16) c - 3/16 c = c / 4; an edge's middle is 3/8 (a + b)
    // + 1/8 (c + d) with c + d = -(a + b): (a + b) / 4.
    MeshData data;
    data.V = Rows3{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    data.F = Array3i::Dense{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
    const auto fine = upsample(Mesh(data), 1, Subdivision::loop).snapshot();
    ASSERT_EQ(fine->V.rows(), 10);
    for (Eigen::Index i = 0; i < 4; ++i) EXPECT_EQ(fine->V.row(i), data.V.row(i) / 4);
    for (Eigen::Index i = 4; i < 10; ++i)
        EXPECT_FLOAT_EQ(fine->V.row(i).norm(), 0.5f) << "(a + b) / 4 is +-e / 2";
    EXPECT_TRUE(is_closed(*fine));
}

TEST(Upsample, LoopKeepsSeamsClosed) {
    // The box's sides have vertices of their own, the torus' texture a seam; both stay closed.
    for (const Mesh& mesh : {make_box(), make_torus(1, 0.3f, 12, 8)}) {
        const auto fine = upsample(mesh, 2, Subdivision::loop).snapshot();
        EXPECT_TRUE(is_closed(*fine));
        EXPECT_EQ(fine->UV.rows(), fine->V.rows());
        EXPECT_NO_THROW(validate(*fine));
        // Rounded, and with normals that follow, also across seams: the 192 faces of the rounded box meet at
        // up to 30 degrees, cos 30 = 0.87, and a corner's normal may be as far from a small face beside it.
        EXPECT_GT(normal_agreement(*fine).first, 0.85);
    }
}

TEST(Smooth, TaubinKeepsTheSizeThatLaplaceLoses) {
    const Mesh ball = make_icosphere(1, 4);
    MeshData noisy = *ball.snapshot();
    Rows3 V = noisy.V;
    for (Eigen::Index i = 0; i < V.rows(); ++i) V.row(i) *= i % 2 == 0 ? 1.03f : 0.97f;
    noisy.V = V;
    const auto roughness = [](const Mesh& mesh) {
        const Eigen::VectorXf radii = mesh.V().rowwise().norm();
        return std::sqrt((radii.array() - radii.mean()).square().mean());
    };
    const double before = roughness(Mesh(noisy));
    const Mesh taubin = smooth(Mesh(noisy), 20), laplacian = smooth(Mesh(noisy), 40, Smoothing::laplacian);
    EXPECT_LT(roughness(taubin), before / 4);
    EXPECT_LT(roughness(laplacian), before / 4);
    const double size = volume(*ball.snapshot());
    EXPECT_NEAR(volume(*taubin.snapshot()), size, 0.01 * size);
    EXPECT_LT(volume(*laplacian.snapshot()), 0.95 * size);
    EXPECT_GT(normal_agreement(*taubin.snapshot()).first, 0.98) << "normals are computed anew";
}

TEST(Smooth, BordersStayAndSeamsStayClosed) {
    MeshData plane = *make_plane(2, 8).snapshot();
    Rows3 V = plane.V;
    V(40, 1) = 1;  // the middle one
    plane.V = V;
    const Mesh flat = smooth(Mesh(plane), 100, Smoothing::laplacian);
    EXPECT_LT(flat.V().col(1).cwiseAbs().maxCoeff(), 0.01f);
    EXPECT_EQ(flat.V().colwise().maxCoeff().x(), 1);
    EXPECT_NEAR(area(*flat.snapshot()), 4, 1e-3);
    EXPECT_TRUE(is_closed(*smooth(make_box(), 5).snapshot()));
    EXPECT_EQ(smooth(Mesh(plane), 0).V(), plane.V);
}

TEST(Refine, RefusesWhatMakesNoSense) {
    EXPECT_THROW(upsample(Mesh()), ArgumentError);
    EXPECT_THROW(upsample(make_box(), -1), ArgumentError);
    EXPECT_THROW(upsample(make_box(), 13), ArgumentError);
    EXPECT_NE(refusal([] { upsample(make_icosphere(1, 6), 9); }).find("at most 715827882 faces"),
              std::string::npos);
    EXPECT_THROW(smooth(Mesh()), ArgumentError);
    EXPECT_THROW(smooth(make_box(), -1), ArgumentError);
    EXPECT_EQ(upsample(make_box(), 0).F().rows(), 12);
}

TEST(Refine, SurvivesDegenerateFaces) {
    MeshData data;
    data.V = Rows3{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
    data.F = Array3i::Dense{{0, 1, 2}, {0, 3, 1}, {1, 1, 1}};
    for (const Subdivision subdivision : {Subdivision::midpoint, Subdivision::loop})
        EXPECT_TRUE(upsample(Mesh(data), 2, subdivision).V().allFinite());
    EXPECT_TRUE(smooth(Mesh(data)).V().allFinite());
}

}  // namespace
}  // namespace easypbr::refine_test

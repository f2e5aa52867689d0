#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "easypbr/core/error.h"
#include "easypbr/core/math.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/merge.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/normals.h"

namespace easypbr::tangents_test {
namespace {

ArrayXf tangents_of(const Mesh& mesh) {
    const auto data = mesh.snapshot();
    return corner_tangents(data->V, data->N, data->UV, data->F);
}

/// Two unit squares in the xy plane, at x = -1 .. 0 and 0 .. 1, that share the edge x = 0; u is given per
/// vertex column.
struct TwoSquares {
    Array3f::Dense V{6, 3}, N{6, 3};
    Array2f::Dense UV{6, 2};
    Array3i::Dense F{4, 3};

    TwoSquares(float u_left, float u_middle, float u_right) {
        V << -1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 1, 0, 0, 1, 0, 1, 1, 0;
        N.rowwise() = Eigen::RowVector3f(0, 0, 1);
        UV << u_left, 0, u_middle, 0, u_right, 0, u_left, 1, u_middle, 1, u_right, 1;
        F << 0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4;
    }
    ArrayXf tangents() const { return corner_tangents(V, N, UV, F); }
};

TEST(CornerTangents, OfAPlanePointAlongU) {
    // make_plane: u grows with x, v with -z, normal +y: cross(n, t) = y x x = -z = +v, so the sign is +1.
    const ArrayXf T = tangents_of(make_plane(3));
    ASSERT_EQ(T.rows(), 6);
    for (Eigen::Index i = 0; i < T.rows(); ++i) EXPECT_EQ(T.row(i), Eigen::RowVector4f(1, 0, 0, 1));
}

TEST(MeshTangents, AreThoseOfTheMeshWhereItHasThem) {
    MeshData mesh = *make_plane(3).snapshot();
    const ArrayXf computed = corner_tangents(mesh.V, mesh.N, mesh.UV, mesh.F);
    Array4f::Dense given = Array4f::Dense::Zero(mesh.V.rows(), 4);
    given.row(mesh.F(0, 1)) << 0, 0, 1, -1;
    mesh.uv_tangents = given;
    const ArrayXf T = mesh_tangents(mesh, mesh.N);
    for (Eigen::Index i = 0; i < mesh.F.size(); ++i) {
        const bool is_given = mesh.F.data()[i] == mesh.F(0, 1);
        EXPECT_EQ(T.row(i), is_given ? Eigen::RowVector4f(0, 0, 1, -1) : Eigen::RowVector4f(computed.row(i)));
    }
}

TEST(MeshTangents, AreDroppedByEditsOfWhatTheyBelongTo) {
    MeshData data = *make_plane(3).snapshot();
    data.uv_tangents = Array4f::Dense(Eigen::RowVector4f(0, 0, 1, 1).replicate(data.V.rows(), 1));
    const auto kept = [&](auto&& edit) {
        Mesh mesh(data);
        edit(mesh);
        return !mesh.snapshot()->uv_tangents.empty();
    };
    EXPECT_TRUE(kept([](Mesh& m) { m.set_C(ArrayXf::Dense(ArrayXf::Dense::Ones(m.V().rows(), 3))); }));
    EXPECT_FALSE(kept([](Mesh& m) { m.set_V(Array3f::Dense(2 * m.V())); }));
    EXPECT_FALSE(kept([](Mesh& m) { m.set_N({}); }));
    EXPECT_FALSE(kept([](Mesh& m) { m.set_UV(Array2f::Dense(2 * m.UV())); }));
    EXPECT_FALSE(kept([](Mesh& m) { m.set_F(Array3i::Dense(m.F().topRows(1))); }));
}

// A mirror at x = 0 with y doubled: directions turn as differences of positions do, (3, 4, 0) / 5 to
// (-3, 8, 0); normals stay on their side, so that the bitangent's sign changes.
TEST(MeshTangents, TurnWithTheMesh) {
    MeshData data = *make_plane(3).snapshot();
    data.uv_tangents = Array4f::Dense(Eigen::RowVector4f(0.6f, 0.8f, 0, 1).replicate(data.V.rows(), 1));
    Eigen::Affine3d T = Eigen::Affine3d::Identity();
    T.linear().diagonal() << -1, 2, 1;
    const MeshData turned = transformed(data, T);
    const Vec3 wanted = Vec3(-3, 8, 0).normalized();
    // Rounding of single precision.
    EXPECT_LT((Vec3(turned.uv_tangents.row(0).head<3>()) - wanted).norm(), 1e-6f);
    EXPECT_EQ(turned.uv_tangents(0, 3), -1);
}

TEST(CornerTangents, MirroredHalvesDoNotMix) {
    // u = |x|: on the left u falls with x, so t = -x and cross(n, t) = -y = -v: sign -1. Position, normal and
    // uv of the middle vertices are the same on both sides; averaging them would cancel.
    const ArrayXf T = TwoSquares(1, 0, 1).tangents();
    for (Eigen::Index i = 0; i < 6; ++i) EXPECT_EQ(T.row(i), Eigen::RowVector4f(-1, 0, 0, -1)) << i;
    for (Eigen::Index i = 6; i < 12; ++i) EXPECT_EQ(T.row(i), Eigen::RowVector4f(1, 0, 0, 1)) << i;
}

TEST(CornerTangents, CornersOfASeamAverageByAngle) {
    // The sheet is bent by 90 degrees at x = 0: the right square stands up along z. At vertices of the bend,
    // with a common slanted normal, the two tangents projected to its plane are equal and opposite in slope;
    // both squares fill an angle of the same size there, so that the mean is the projection's symmetric
    // direction.
    TwoSquares sheet(0, 1, 2);
    sheet.V.row(2) << 0, 0, 1;
    sheet.V.row(5) << 0, 1, 1;
    const Vec3 bend = Vec3(-1, 0, 1).normalized();
    sheet.N.row(1) = sheet.N.row(4) = bend.transpose();
    sheet.N.row(2) = sheet.N.row(5) = Eigen::RowVector3f(-1, 0, 0);
    const ArrayXf T = sheet.tangents();
    const Vec3 expected = Vec3(1, 0, 1).normalized();
    // Corners at vertices 1 and 4: of the faces' table above.
    for (const int corner : {1, 2, 4, 6, 9, 11}) {
        EXPECT_LT((T.row(corner).head<3>().transpose() - expected).norm(), 1e-6f) << corner;
        EXPECT_EQ(T(corner, 3), 1);
    }
}

TEST(CornerTangents, EqualVerticesAreOne) {
    // The same bent sheet with every face having vertices of its own gives the same tangents.
    TwoSquares sheet(0, 1, 2);
    sheet.V.row(2) << 0, 0, 1;
    sheet.V.row(5) << 0, 1, 1;
    sheet.N.row(1) = sheet.N.row(4) = Vec3(-1, 0, 1).normalized().transpose();
    Array3f::Dense V(12, 3), N(12, 3);
    Array2f::Dense UV(12, 2);
    Array3i::Dense F(4, 3);
    for (int i = 0; i < 12; ++i) {
        const int v = sheet.F(i / 3, i % 3);
        V.row(i) = sheet.V.row(v);
        N.row(i) = sheet.N.row(v);
        UV.row(i) = sheet.UV.row(v);
        F(i / 3, i % 3) = i;
    }
    EXPECT_TRUE((corner_tangents(V, N, UV, F).array() == sheet.tangents().array()).all());
}

TEST(CornerTangents, FacesThatOnlyTouchAtAPointStayApart) {
    // Two triangles share vertex 0 with equal uv, but no edge: u grows along x in one and along y in the
    // other.
    Array3f::Dense V(5, 3), N(5, 3);
    Array2f::Dense UV(5, 2);
    Array3i::Dense F(2, 3);
    V << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 0, 1, -1, 0;
    UV << 0, 0, 1, 0, 0, 1, -1, 0, -1, -1;
    N.rowwise() = Eigen::RowVector3f(0, 0, 1);
    F << 0, 1, 2, 0, 3, 4;
    const ArrayXf T = corner_tangents(V, N, UV, F);
    EXPECT_EQ(T.row(0), Eigen::RowVector4f(1, 0, 0, 1));
    EXPECT_LT((T.row(3) - Eigen::RowVector4f(0, 1, 0, 1)).norm(), 1e-6f);
}

TEST(CornerTangents, OfASphereRunEast) {
    // d/du of (sin t sin p, cos t, sin t cos p) is (cos p, 0, -sin p). Away from the poles the mean of the
    // chords left and right of a vertex is parallel to it. At the seam one side is missing: the chord leans
    // by half a segment, 1.41 degrees, of which the sine of the latitude stays in the normal's plane.
    const auto sphere = make_sphere(1, 128).snapshot();
    const ArrayXf T = corner_tangents(sphere->V, sphere->N, sphere->UV, sphere->F);
    for (Eigen::Index i = 0; i < T.rows(); ++i) {
        const Vec3 n = sphere->N.row(sphere->F.data()[i]).transpose();
        if (std::abs(n.y()) > 0.95f) continue;
        const float u = sphere->UV(sphere->F.data()[i], 0);
        const double tolerance_deg = u == 0 || u == 1 ? 1.42 : 0.1;
        const Vec3 east = Vec3(n.z(), 0, -n.x()).normalized();
        ASSERT_GT(T.row(i).head<3>().dot(east.transpose()), std::cos(radians(tolerance_deg)))
            << "corner " << i;
        ASSERT_EQ(T(i, 3), 1);
    }
}

TEST(CornerTangents, FaceWithoutUvAreaTakesOverItsNeighbours) {
    // The right square's uv are all on one line; at the shared vertices it has the left square's tangent.
    const ArrayXf T = TwoSquares(0, 1, 1).tangents();
    EXPECT_EQ(T.row(6), Eigen::RowVector4f(1, 0, 0, 1));
    EXPECT_EQ(T.row(9), Eigen::RowVector4f(1, 0, 0, 1));
    // Vertex 2 has no neighbour to take from: any unit vector in the plane.
    EXPECT_NEAR(T.row(7).head<3>().norm(), 1, 1e-6f);
    EXPECT_NEAR(T(7, 2), 0, 1e-6f);
}

TEST(CornerTangents, AreFiniteAndOrthonormalForAnyTriangles) {
    std::mt19937 random(3);
    std::uniform_int_distribution<int> pick(0, 199), grid(-2, 2);
    std::uniform_real_distribution<float> real(-1, 1);
    Array3f::Dense V(200, 3), N(200, 3);
    Array2f::Dense UV(200, 2);
    Array3i::Dense F(3000, 3);
    for (int v = 0; v < 200; ++v) {
        // Coarse numbers, so that degenerate faces, equal vertices and cancelling sums are frequent.
        V.row(v) << float(grid(random)), float(grid(random)), float(grid(random));
        UV.row(v) << float(grid(random)), float(grid(random));
        N.row(v) = Vec3(real(random), real(random), real(random)).normalized().transpose();
    }
    UV.row(0) << NAN, INFINITY;
    for (Eigen::Index i = 0; i < F.size(); ++i) F.data()[i] = pick(random);
    const ArrayXf T = corner_tangents(V, N, UV, F);
    ASSERT_EQ(T.rows(), 9000);
    for (Eigen::Index i = 0; i < T.rows(); ++i) {
        ASSERT_NEAR(T.row(i).head<3>().norm(), 1, 1e-5f) << i;
        ASSERT_NEAR(T.row(i).head<3>().dot(N.row(F.data()[i])), 0, 1e-5f) << i;
        ASSERT_EQ(std::abs(T(i, 3)), 1) << i;
    }
}

TEST(CornerTangents, ZeroAndNaNNormalsAreSurvived) {
    TwoSquares sheet(0, 1, 2);
    sheet.N.row(0).setZero();
    sheet.N.row(5).setConstant(NAN);
    const ArrayXf T = sheet.tangents();
    for (Eigen::Index i = 0; i < T.rows(); ++i) ASSERT_NEAR(T.row(i).head<3>().norm(), 1, 1e-5f) << i;
}

TEST(CornerTangents, WrongShapesAreRefused) {
    TwoSquares sheet(0, 1, 2);
    EXPECT_THROW(corner_tangents(sheet.V, {}, sheet.UV, sheet.F), ArgumentError);
    EXPECT_THROW(corner_tangents(sheet.V, sheet.N, {}, sheet.F), ArgumentError);
    Array3i::Dense beyond = sheet.F;
    beyond(1, 2) = int32_t(sheet.V.rows());
    EXPECT_THROW(corner_tangents(sheet.V, sheet.N, sheet.UV, beyond), ArgumentError);
}

}  // namespace
}  // namespace easypbr::tangents_test

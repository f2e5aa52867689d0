#include "easypbr/gpu/facing.h"

#include <gtest/gtest.h>

#include "easypbr/geometry/primitives.h"

namespace easypbr::gpu::facing_test {
namespace {

/// A tetrahedron with outward faces.
const Eigen::Matrix<float, 4, 3, Eigen::RowMajor> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const Eigen::Matrix<int, 4, 3, Eigen::RowMajor> outward{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

Array3i faces(const Eigen::MatrixXi& F) {
    return Array3i(Array3i::Dense(F));
}
Array3f points(const Eigen::MatrixXf& V) {
    return Array3f(Array3f::Dense(V));
}

TEST(Facing, ClosedOutward) {
    EXPECT_TRUE(is_closed_outward(points(corners), faces(outward)));
}

TEST(Facing, Inward) {
    const Array3i inward = faces(outward.rowwise().reverse());
    EXPECT_FALSE(is_closed_outward(points(corners), inward));
    EXPECT_EQ(winding_of(points(corners), inward), Winding::inward);
}

TEST(Facing, Open) {
    EXPECT_EQ(winding_of(points(corners), faces(outward.topRows(3))), Winding::open);
    EXPECT_EQ(winding_of(points(corners), faces(outward.topRows(1))), Winding::open);
}

TEST(Facing, OneFaceFlipped) {
    Eigen::MatrixXi F = outward;
    F.row(2) = F.row(2).reverse().eval();
    EXPECT_EQ(winding_of(points(corners), faces(F)), Winding::unknown) << "no edge has one face";
}

// A second, larger component that looks inward: the total volume is negative, the first alone is not.
TEST(Facing, EveryComponentCounts) {
    Eigen::MatrixXf V(8, 3);
    V << corners, (corners * 0.1f).rowwise() + Eigen::RowVector3f(5, 0, 0);
    Eigen::MatrixXi F(8, 3);
    F << outward, (outward.rowwise().reverse().array() + 4).matrix();
    EXPECT_EQ(winding_of(points(V), faces(F)), Winding::unknown);
    F << outward, (outward.array() + 4).matrix();
    EXPECT_TRUE(is_closed_outward(points(V), faces(F)));
}

// More faces than one thread looks through at once, those of a component far from each other.
TEST(Facing, ManyComponentsInAnyOrder) {
    const int count = 30000;
    Eigen::MatrixXf V(4 * count, 3);
    Eigen::MatrixXi F(4 * count, 3);
    for (int i = 0; i < count; ++i) {
        V.middleRows(4 * i, 4) = corners.rowwise() + Eigen::RowVector3f(float(2 * i), 0, 0);
        for (int k = 0; k < 4; ++k) F.row(k * count + i) = outward.row(k).array() + 4 * i;
    }
    EXPECT_TRUE(is_closed_outward(points(V), faces(F)));
    for (int k = 0; k < 4; ++k) F.row(k * count + 777) = F.row(k * count + 777).reverse().eval();
    EXPECT_FALSE(is_closed_outward(points(V), faces(F)));
    F.row(777) = F.row(777).reverse().eval();
    EXPECT_FALSE(is_closed_outward(points(V), faces(F)));
}

/// Each face with corners of its own, as creases have them.
Eigen::MatrixXf unshared(const Eigen::MatrixXi& F) {
    Eigen::MatrixXf V(F.size(), 3);
    for (int i = 0; i < F.size(); ++i) V.row(i) = corners.row(F(i / 3, i % 3));
    return V;
}

TEST(Facing, VerticesAtOnePlaceAreOne) {
    Eigen::MatrixXi F(4, 3);
    for (int i = 0; i < F.size(); ++i) F(i / 3, i % 3) = i;
    Eigen::MatrixXf V = unshared(outward);
    EXPECT_TRUE(is_closed_outward(points(V), faces(F)));
    EXPECT_FALSE(is_closed_outward(points(V), faces(F.topRows(3))));
    EXPECT_FALSE(is_closed_outward(points(unshared(outward.rowwise().reverse())), faces(F)));
    // A zero with a sign is the same place.
    V = V.unaryExpr([](float x) { return x == 0 ? -0.0f : x; });
    V(0, 0) = 0.0f;
    EXPECT_TRUE(is_closed_outward(points(V), faces(F)));
    V(0, 0) = 0.01f;
    EXPECT_FALSE(is_closed_outward(points(V), faces(F)));
    // A ball whose texture coordinates have a seam, a box with a normal for each face.
    const Mesh ball = make_sphere(1, 16), box = make_box(Vec3(1, 1, 1));
    EXPECT_GT(ball.V().rows(), ball.F().rows() / 2 + 2);  // Euler's formula for what is closed by its indices
    EXPECT_TRUE(is_closed_outward(ball.V(), ball.F()));
    EXPECT_TRUE(is_closed_outward(box.V(), box.F()));
}

TEST(Facing, NormalsAgree) {
    const Mesh sphere = make_sphere(1, 16);
    const Array3f V = sphere.V(), N = sphere.N();
    EXPECT_TRUE(normals_agree_with_winding(V, N, sphere.F()));
    EXPECT_FALSE(normals_agree_with_winding(V, Array3f(Array3f::Dense(-N)), sphere.F()));
}

}  // namespace
}  // namespace easypbr::gpu::facing_test

#include "easypbr/gpu/facing.h"

#include <gtest/gtest.h>

#include "easypbr/geometry/primitives.h"

namespace easypbr::gpu {
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
    EXPECT_FALSE(is_closed_outward(points(corners), faces(outward.rowwise().reverse())));
}

TEST(Facing, Open) {
    EXPECT_FALSE(is_closed_outward(points(corners), faces(outward.topRows(3))));
}

TEST(Facing, OneFaceFlipped) {
    Eigen::MatrixXi F = outward;
    F.row(2) = F.row(2).reverse().eval();
    EXPECT_FALSE(is_closed_outward(points(corners), faces(F)));
}

// A second, larger component that looks inward: the total volume is negative, the first alone is not.
TEST(Facing, EveryComponentCounts) {
    Eigen::MatrixXf V(8, 3);
    V << corners, (corners * 0.1f).rowwise() + Eigen::RowVector3f(5, 0, 0);
    Eigen::MatrixXi F(8, 3);
    F << outward, (outward.rowwise().reverse().array() + 4).matrix();
    EXPECT_FALSE(is_closed_outward(points(V), faces(F)));
    F << outward, (outward.array() + 4).matrix();
    EXPECT_TRUE(is_closed_outward(points(V), faces(F)));
}

TEST(Facing, NormalsAgree) {
    const Mesh sphere = make_sphere(1, 16);
    const Array3f V = sphere.V(), N = sphere.N();
    EXPECT_TRUE(normals_agree_with_winding(V, N, sphere.F()));
    EXPECT_FALSE(normals_agree_with_winding(V, Array3f(Array3f::Dense(-N)), sphere.F()));
}

}  // namespace
}  // namespace easypbr::gpu

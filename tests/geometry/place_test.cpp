#include "easypbr/geometry/place.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "easypbr/geometry/primitives.h"
#include "easypbr/geometry/sample.h"
#include "geometry/measure.h"

namespace easypbr::place_test {
namespace {

Mesh cloud(Array3f::Dense V) {
    MeshData data;
    data.V = std::move(V);
    return Mesh(std::move(data));
}

Eigen::Affine3d turn(double degrees, const Vec3d& axis) {
    return Eigen::Affine3d(Eigen::AngleAxisd(radians(degrees), axis.normalized()));
}

TEST(TransformedMesh, MovesChildrenAlong) {
    Mesh parent = make_box(), child = make_box();
    child.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(3, 0, 0)));
    parent.add_child(child);
    const Eigen::Affine3d T = Eigen::Translation3d(0, 1, 0) * turn(90, Vec3d::UnitZ());
    const Box3d before = bounding_box(parent), after = bounding_box(transformed(parent, T));
    EXPECT_TRUE(before.isApprox(Box3d(Vec3d(-0.5, -0.5, -0.5), Vec3d(3.5, 0.5, 0.5))));
    // x becomes y: from -0.5 .. 3.5 to 0.5 .. 4.5.
    EXPECT_TRUE(after.isApprox(Box3d(Vec3d(-0.5, 0.5, -0.5), Vec3d(0.5, 4.5, 0.5)), 1e-6));
    EXPECT_EQ(child.T_parent_mesh().translation(), Vec3d(3, 0, 0)) << "the given mesh stays as it was";
}

TEST(TransformedMesh, RefusesWhatCannotBeUndone) {
    EXPECT_THROW(transformed(make_box(), Eigen::Affine3d(Eigen::Scaling(1.0, 0.0, 1.0))), ArgumentError);
    Eigen::Affine3d T = Eigen::Affine3d::Identity();
    T.translation().x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(transformed(make_box(), T), ArgumentError);
    EXPECT_THROW(transformed(make_box(), Eigen::Affine3d(Eigen::Scaling(1e300))), ArgumentError)
        << "positions that no float holds";
}

TEST(MergedMeshes, AppliesPosesOfMeshesAndDescendants) {
    Mesh a = make_box(), b = make_sphere(), child = make_box();
    a.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(10, 0, 0)));
    child.set_T_parent_mesh(Eigen::Affine3d(Eigen::Scaling(2.0)));
    b.add_child(child);
    const Mesh both = merged(std::vector{a, b});
    const auto data = both.snapshot();
    EXPECT_EQ(data->F.rows(), 12 + b.F().rows() + 12);
    EXPECT_EQ(data->parts.size(), 3u);
    EXPECT_EQ(data->V.topRows(24).colwise().maxCoeff(), Vec3(10.5f, 0.5f, 0.5f).transpose());
    EXPECT_EQ(data->V.bottomRows(24).colwise().maxCoeff(), Vec3(1, 1, 1).transpose());
    EXPECT_TRUE(data->children.empty());
    EXPECT_TRUE(both.T_parent_mesh().matrix().isIdentity(0));
    EXPECT_THROW(merged(std::vector<Mesh>{}), ArgumentError);
}

TEST(BoundingBox, IsThatOfTheTurnedVertices) {
    // The box around the turned box of a sphere would be sqrt(2) times as large.
    Mesh ball = make_icosphere(1, 5);
    ball.set_T_parent_mesh(turn(45, Vec3d::UnitZ()));
    const Box3d box = bounding_box(ball);
    // Edges of 0.04 leave at most h^2 / 8 between the sphere and the faces' vertices.
    EXPECT_NEAR(box.sizes().maxCoeff(), 2, 2e-3);
    EXPECT_NEAR(bounding_box(ball, Eigen::Affine3d(Eigen::Scaling(3.0))).max().x(), 3, 3e-3);
    EXPECT_THROW(bounding_box(Mesh()), ArgumentError);
}

TEST(Centered, PutsTheMiddleOfTheBoxAtTheOrigin) {
    const Mesh mesh = centered(cloud(Array3f::Dense{{1, 2, 3}, {3, 6, 3}, {1.5f, 2, 9}}));
    EXPECT_EQ(Vec3(mesh.V().row(0)), Vec3(-1, -2, -3));
    EXPECT_EQ(bounding_box(mesh).center(), Vec3d(0, 0, 0));
    EXPECT_THROW(centered(Mesh()), ArgumentError);
}

TEST(WithSize, MakesTheLongestSideThatLong) {
    const Mesh mesh = with_size(make_box({1, 4, 2}), 2);
    EXPECT_TRUE(bounding_box(mesh).sizes().isApprox(Vec3d(0.5, 2, 1)));
    EXPECT_THROW(with_size(make_box(), 0), ArgumentError);
    EXPECT_THROW(with_size(make_box(), std::numeric_limits<double>::quiet_NaN()), ArgumentError);
    EXPECT_THROW(with_size(cloud(Array3f::Dense{{1, 2, 3}, {1, 2, 3}}), 1), ArgumentError);
}

TEST(OrientedBoundingBox, IsTheBoxItself) {
    Mesh box = make_box({1, 3, 2});
    const Eigen::Isometry3d pose =
        Eigen::Translation3d(5, 6, 7) * Eigen::AngleAxisd(0.8, Vec3d(1, 2, 3).normalized());
    box.set_T_parent_mesh(Eigen::Affine3d(pose.matrix()));
    const OrientedBox found = oriented_bounding_box(box);
    EXPECT_TRUE(found.size.isApprox(Vec3d(3, 2, 1), 1e-5)) << found.size.transpose();
    EXPECT_TRUE(found.T_world_box.translation().isApprox(Vec3d(5, 6, 7), 1e-5));
    // Its longest axis is the box's y, up to the sign.
    EXPECT_NEAR(std::abs(found.T_world_box.linear().col(0).dot(pose.linear().col(1))), 1, 1e-6);
    EXPECT_NEAR(found.T_world_box.linear().determinant(), 1, 1e-9);
}

TEST(OrientedBoundingBox, OfACubeIsNotMisledByItsMoments) {
    // All directions are principal ones of a cube, so its moments alone say nothing.
    Mesh cube = make_box();
    cube.set_T_parent_mesh(turn(37, Vec3d(3, 1, 2)));
    EXPECT_NEAR(oriented_bounding_box(cube).size.prod(), 1, 1e-4);
}

TEST(OrientedBoundingBox, ContainsEverythingAndIsNotTheLargerOne) {
    std::mt19937 random(4);
    std::normal_distribution<float> normal;
    Array3f::Dense V(3000, 3);
    for (Eigen::Index i = 0; i < V.rows(); ++i) {
        const float a = normal(random), b = normal(random);
        V.row(i) << a + 0.2f * b, a - 0.3f * b, 0.1f * normal(random);
    }
    const OrientedBox box = oriented_bounding_box(cloud(V));
    const Eigen::Isometry3d T_box_world = box.T_world_box.inverse();
    for (Eigen::Index i = 0; i < V.rows(); ++i) {
        const Vec3d inside = T_box_world * V.row(i).transpose().cast<double>();
        ASSERT_TRUE(((2 * inside).cwiseAbs().array() <= box.size.array() + 1e-6).all()) << i;
    }
    EXPECT_LT(box.size.prod(), 0.7 * bounding_box(cloud(V)).volume());
}

TEST(OrientedBoundingBox, OfWhatHasNoVolume) {
    const OrientedBox line = oriented_bounding_box(cloud(Array3f::Dense{{0, 0, 0}, {3, 4, 0}, {6, 8, 0}}));
    EXPECT_NEAR(line.size.x(), 10, 1e-6);
    EXPECT_NEAR(line.size.y(), 0, 1e-6);
    const OrientedBox point = oriented_bounding_box(cloud(Array3f::Dense{{1, 2, 3}}));
    EXPECT_EQ(point.size, Vec3d(0, 0, 0));
    EXPECT_EQ(point.T_world_box.translation(), Vec3d(1, 2, 3));
    EXPECT_THROW(oriented_bounding_box(Mesh()), ArgumentError);
}

/// Far from zero, as in UTM's coordinates: `V` at `at`, by its offset.
Mesh far_away(const Mesh& mesh, const Vec3d& at) {
    Mesh result = mesh.clone();
    result.set_offset(at);
    return result;
}

const Vec3d utm(691000, 5335000, 520);

TEST(FarMesh, IsTransformedAsItsCoordinatesAre) {
    Mesh far = far_away(make_box(), utm), child = far_away(make_box(), utm + Vec3d(0, 3, 0));
    far.add_child(child);
    // T moves (x, y, z) to (-2 y + 7, 2 x, 2 z).
    const Eigen::Affine3d T = Eigen::Translation3d(7, 0, 0) * turn(90, Vec3d::UnitZ()) * Eigen::Scaling(2.0);
    const Box3d box = bounding_box(transformed(far, T));
    const Vec3d centre = 2 * Vec3d(-utm.y(), utm.x(), utm.z()) + Vec3d(7, 0, 0);
    // Of a box of 1 and one that is 3 further along y: from centre.x - 7 to centre.x + 1. float32 of places
    // within 10 of the offset, which doubles at 1e7 hold to 2e-9.
    EXPECT_NEAR(box.min().x(), centre.x() - 7, 1e-5);
    EXPECT_NEAR(box.max().x(), centre.x() + 1, 1e-5);
    EXPECT_NEAR(box.min().y(), centre.y() - 1, 1e-5);
    EXPECT_NEAR(box.max().z(), centre.z() + 1, 1e-5);
}

TEST(FarMesh, IsBroughtToZero) {
    const Mesh far = far_away(make_box(), utm), near = centered(far),
               moved = transformed(far, Eigen::Affine3d(Eigen::Translation3d(-utm)));
    for (const Mesh& mesh : {near, moved}) {
        EXPECT_EQ(mesh.offset(), Vec3d(0, 0, 0));
        EXPECT_TRUE(bounding_box(mesh).isApprox(Box3d(Vec3d(-0.5, -0.5, -0.5), Vec3d(0.5, 0.5, 0.5))));
    }
    // About the origin of its coordinates.
    EXPECT_TRUE(with_size(far, 2).offset().isApprox(2 * utm));
}

TEST(FarMesh, HasItsBoxesWhereItIs) {
    const Mesh far = far_away(make_box(), utm);
    EXPECT_EQ(bounding_box(far).center(), utm);
    EXPECT_TRUE(oriented_bounding_box(far).T_world_box.translation().isApprox(utm));
    EXPECT_EQ(crop_box(far, bounding_box(far)).V().rows(), far.V().rows());
}

}  // namespace
}  // namespace easypbr::place_test

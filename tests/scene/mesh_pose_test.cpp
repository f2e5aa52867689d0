#include <gtest/gtest.h>

#include <limits>
#include <thread>

#include "easypbr/core/error.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/scene.h"

namespace easypbr::mesh_pose_test {
namespace {

Mesh point(const std::string& name) {
    MeshData data;
    data.name = name;
    data.V = Array3f::Dense(Array3f::Dense::Zero(1, 3));
    return Mesh(std::move(data));
}

Vec3d position(const Mesh& mesh) {
    return mesh.T_world_mesh().translation();
}

TEST(MeshPose, StepsActInTheParentsFrame) {
    Mesh mesh = point("m");
    mesh.translate({1, 2, 3});
    mesh.translate({1, 0, 0});
    EXPECT_EQ(position(mesh), Vec3d(2, 2, 3));
    // A quarter turn about z takes x to y and leaves the position alone.
    mesh.rotate_axis_angle({0, 0, 2}, 90);
    EXPECT_EQ(position(mesh), Vec3d(2, 2, 3));
    EXPECT_LT((mesh.T_parent_mesh().linear() * Vec3d::UnitX() - Vec3d::UnitY()).norm(), 1e-15);
    // Half way around the y axis through (0, 0, 3): x changes sign, and the mesh turns with it.
    mesh.orbit({0, 1, 0}, {0, 0, 3}, 180);
    EXPECT_LT((position(mesh) - Vec3d(-2, 2, 3)).norm(), 1e-15);
    EXPECT_LT((mesh.T_parent_mesh().linear() * Vec3d::UnitX() - Vec3d::UnitY()).norm(), 1e-15);
    EXPECT_LT((mesh.T_parent_mesh().linear() * Vec3d::UnitY() - Vec3d::UnitX()).norm(), 1e-15);
    mesh.scale({2, 3, 4});
    EXPECT_LT((mesh.T_parent_mesh().linear() * Vec3d::UnitX() - 2 * Vec3d::UnitY()).norm(), 1e-14);
}

// 360 / 7 degrees have no exact binary value and 100,002 steps are 14,286 whole turns. Rounding of 1e-16 per
// step, were it all to one side, would be 1e-11 in the end; the angle itself may be off by as much.
TEST(MeshPose, DoesNotDriftOverAHundredThousandSteps) {
    Mesh mesh = point("m");
    mesh.translate({3, 0, 0});
    const Vec3d axis(1, 2, 3);
    for (int i = 0; i < 100002; ++i) {
        mesh.rotate_axis_angle(axis, 360.0 / 7);
        mesh.orbit({0, 1, 0}, {1, 0, 1}, -360.0 / 7);
    }
    const Mat3d R = mesh.T_parent_mesh().linear();
    EXPECT_LT((R * R.transpose() - Mat3d::Identity()).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_NEAR((position(mesh) - Vec3d(1, 0, 1)).norm(), std::sqrt(5.0), 1e-10);
    EXPECT_LT((position(mesh) - Vec3d(3, 0, 0)).norm(), 1e-10);
}

TEST(MeshPose, ScaledAndShearedMeshesTurnAsTheyAre) {
    Mesh mesh = point("m");
    Eigen::Affine3d T = Eigen::Affine3d::Identity();
    T.linear() << 2, 1, 0, 0, 3, 0, 0, 0, -1;
    mesh.set_T_parent_mesh(T);
    mesh.rotate_axis_angle({0, 0, 1}, 90);
    const Mat3d expected = Eigen::AngleAxisd(pi / 2, Vec3d::UnitZ()) * T.linear();
    EXPECT_LT((mesh.T_parent_mesh().linear() - expected).norm(), 1e-15);
}

TEST(MeshPose, ChildrenMoveWithTheirParent) {
    Mesh body = point("body"), wheel = point("wheel"), bolt = point("bolt");
    body.add_child(wheel);
    wheel.add_child(bolt);
    wheel.translate({1, 0, 0});
    bolt.translate({0, 0, 1});
    body.translate({10, 0, 0});
    EXPECT_EQ(position(bolt), Vec3d(11, 0, 1));
    wheel.rotate_axis_angle({0, 1, 0}, 90);
    EXPECT_LT((position(bolt) - Vec3d(12, 0, 0)).norm(), 1e-15);
    ASSERT_TRUE(bolt.parent());
    EXPECT_TRUE(*bolt.parent() == wheel);
    EXPECT_FALSE(body.parent());
    bolt.set_T_world_mesh(Eigen::Affine3d(Eigen::Translation3d(5, 6, 7)));
    EXPECT_LT((position(bolt) - Vec3d(5, 6, 7)).norm(), 1e-14);
}

TEST(MeshPose, AChildMayStayWhereItIs) {
    Mesh parent = point("parent"), child = point("child");
    parent.translate({1, 0, 0});
    parent.rotate_axis_angle({0, 0, 1}, 30);
    child.translate({0, 2, 0});
    const Eigen::Affine3d before = child.T_world_mesh();
    parent.add_child(child, true);
    EXPECT_TRUE(child.T_world_mesh().isApprox(before, 1e-15));
    EXPECT_FALSE(child.T_parent_mesh().isApprox(before, 0.1));
    parent.remove_child(child, true);
    EXPECT_TRUE(child.T_parent_mesh().isApprox(before, 1e-15));
    EXPECT_FALSE(child.parent());
    EXPECT_THROW(parent.remove_child(child), ArgumentError);
}

TEST(MeshPose, AMeshHasOneParent) {
    Mesh a = point("a"), b = point("b"), child = point("child");
    a.add_child(child);
    a.add_child(child);
    EXPECT_EQ(a.children().size(), 1u);
    try {
        b.add_child(child);
        FAIL() << "nothing was thrown";
    } catch (const ArgumentError& error) {
        EXPECT_NE(std::string(error.what()).find("it is a child of 'a'"), std::string::npos) << error.what();
    }
    EXPECT_TRUE(b.children().empty());
    // A parent that is gone is none.
    {
        Mesh passing = point("passing"), orphan = point("orphan");
        passing.add_child(child.clone());
        passing.add_child(orphan);
        child = orphan;
    }
    EXPECT_FALSE(child.parent());
    b.add_child(child);
}

TEST(MeshPose, ParentsFollowAnyChangeOfTheList) {
    Mesh parent, a, b, c;
    const auto has_parent = [&](const Mesh& mesh) {
        const std::optional<Mesh> known = mesh.parent();
        return known && *known == parent;
    };
    const auto set = [&](const MeshList& children) {
        parent.edit([&](MeshData& data) { data.children = children; });
    };
    set({a, b, c});
    EXPECT_TRUE(has_parent(a) && has_parent(b) && has_parent(c));
    set({c, a});
    EXPECT_TRUE(has_parent(a) && !has_parent(b) && has_parent(c));
    set({c, b, c});
    EXPECT_TRUE(!has_parent(a) && has_parent(b) && has_parent(c));
    set({c, b});
    EXPECT_TRUE(!has_parent(a) && has_parent(b) && has_parent(c));
    set({});
    EXPECT_FALSE(has_parent(a) || has_parent(b) || has_parent(c));
}

TEST(MeshPose, RefusesWhatIsNoMotion) {
    Mesh mesh = point("m");
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(mesh.translate({nan, 0, 0}), ArgumentError);
    EXPECT_THROW(mesh.rotate_axis_angle({0, 0, 0}, 10), ArgumentError);
    EXPECT_THROW(mesh.rotate_axis_angle({0, 1, 0}, nan), ArgumentError);
    EXPECT_THROW(mesh.orbit({0, 1, 0}, {nan, 0, 0}, 10), ArgumentError);
    EXPECT_THROW(mesh.scale({1, 0, 1}), ArgumentError);
    Mesh flat = point("flat");
    flat.set_T_parent_mesh(Eigen::Affine3d(Eigen::Scaling(1.0, 0.0, 1.0)));
    flat.add_child(mesh);
    EXPECT_THROW(mesh.set_T_world_mesh(Eigen::Affine3d::Identity()), ArgumentError);
    EXPECT_TRUE(mesh.T_parent_mesh().matrix().isIdentity(0));
}

TEST(MeshPose, AChildShownUnderItsOwnNameIsDrawnOnceAndFollows) {
    Mesh car = point("car"), wheel = point("wheel");
    Scene scene;
    scene.show(car, "car");
    scene.show(wheel, "wheel");
    wheel.translate({1, 0, 0});
    car.add_child(wheel);
    car.translate({0, 5, 0});
    const SceneSnapshot shown = scene.snapshot();
    ASSERT_EQ(shown.objects.size(), 2u);
    EXPECT_EQ(shown.objects[1].name, "wheel");
    EXPECT_EQ(shown.objects[1].T_world_mesh.translation(), Vec3d(1, 5, 0));
    scene.remove("wheel");
    EXPECT_EQ(scene.snapshot().objects[1].name, "car/wheel");
}

TEST(MeshPose, MayBeMovedFromManyThreads) {
    Mesh parent = point("parent"), child = point("child");
    parent.add_child(child);
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&] {
            for (int i = 0; i < 1000; ++i) {
                child.translate({1, 0, 0});
                child.T_world_mesh();
                Mesh other = point("other");
                parent.add_child(other);
                parent.remove_child(other);
            }
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(child.T_parent_mesh().translation().x(), 4000);
    EXPECT_EQ(parent.children().size(), 1u);
}

}  // namespace
}  // namespace easypbr::mesh_pose_test

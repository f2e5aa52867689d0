#include "easypbr/scene/scene.h"

#include <gtest/gtest.h>

#include "easypbr/core/error.h"
#include "point_mesh.h"

namespace easypbr::scene_test {

TEST(Scene, KeepsMeshesByName) {
    Scene scene;
    const Mesh a = points({{0, 0, 0}}), b = points({{1, 1, 1}});
    scene.show(a, "drone");
    scene.show(b, "drone");
    EXPECT_TRUE(scene.get("drone") == b);
    scene.show(a, "car");
    EXPECT_EQ(scene.names(), (std::vector<std::string>{"car", "drone"}));
    scene.remove("car");
    EXPECT_FALSE(scene.contains("car"));
    scene.clear();
    EXPECT_TRUE(scene.names().empty());
}

TEST(Scene, SuggestsNames) {
    Scene scene;
    scene.show(points({{0, 0, 0}}), "drone");
    scene.set_light("sun", {});
    const auto message_of = [](const auto& call) -> std::string {
        try {
            call();
        } catch (const NameError& error) {
            return error.what();
        }
        return "no error";
    };
    EXPECT_EQ(message_of([&] { scene.get("dron"); }), "the scene has no mesh 'dron' (did you mean 'drone'?)");
    EXPECT_EQ(message_of([&] { scene.remove("car"); }), "the scene has no mesh 'car'");
    EXPECT_NE(message_of([&] { scene.hide("dronee"); }).find("drone"), std::string::npos);
    EXPECT_EQ(message_of([&] { scene.light("sum"); }), "the scene has no light 'sum' (did you mean 'sun'?)");
    EXPECT_NE(message_of([&] { scene.remove_light("x"); }), "no error");
}

TEST(Scene, LeavesOutWhatIsHidden) {
    Scene scene;
    Mesh car = points({{0, 0, 0}}), wheel = points({{1, 0, 0}}), bolt = points({{9, 0, 0}});
    wheel.edit([](MeshData& d) { d.name = "wheel"; });
    wheel.add_child(bolt);
    car.add_child(wheel);
    scene.show(car, "car");
    scene.show(points({{5, 0, 0}}), "box");
    SceneSnapshot shown = scene.snapshot();
    ASSERT_EQ(shown.objects.size(), 4u);
    EXPECT_EQ(shown.objects[0].name, "box");
    EXPECT_EQ(shown.objects[2].name, "car/wheel");
    EXPECT_EQ(shown.bounds().max(), Vec3d(9, 0, 0));

    Style invisible;
    invisible.visible = false;
    wheel.set_style(invisible);
    EXPECT_EQ(scene.snapshot().objects.size(), 2u);
    scene.hide("box");
    EXPECT_EQ(scene.snapshot().bounds().max(), Vec3d(0, 0, 0));
    scene.hide("box", false);
    EXPECT_EQ(scene.snapshot().bounds().max(), Vec3d(5, 0, 0));
    // What was taken before stays as it was.
    EXPECT_EQ(shown.objects.size(), 4u);
}

TEST(Scene, HasNoBoundsWithoutVertices) {
    Scene scene;
    EXPECT_TRUE(scene.snapshot().bounds().isEmpty());
    scene.show(Mesh(), "nothing");
    EXPECT_TRUE(scene.snapshot().bounds().isEmpty());
}

// A needle from (-1,-1,0) to (1,1,0) turned by 45 degrees about z lies along y: its box has no width. A box
// made from turned corners of the mesh's own box would be 2 sqrt(2) wide.
TEST(Scene, BoundsAreExactUnderRotation) {
    Scene scene;
    Mesh needle = points({{-1, -1, 0}, {1, 1, 0}});
    needle.set_T_parent_mesh(Eigen::Affine3d(Eigen::AngleAxisd(pi / 4, Vec3d::UnitZ())));
    scene.show(needle, "needle");
    const Box3d box = scene.snapshot().bounds();
    EXPECT_NEAR(box.sizes().x(), 0, 1e-15);
    EXPECT_NEAR(box.sizes().y(), 2 * std::sqrt(2.0), 1e-15);
}

TEST(Scene, BoundsOfManyVerticesAreThoseOfALoop) {
    Array3f::Dense V = Array3f::Dense::Random(200000, 3);
    const Vec3d low = V.colwise().minCoeff().transpose().cast<double>();
    const Vec3d high = V.colwise().maxCoeff().transpose().cast<double>();
    Scene scene;
    scene.show(cloud(V), "cloud");
    EXPECT_EQ(scene.snapshot().bounds().min(), low);
    EXPECT_EQ(scene.snapshot().bounds().max(), high);
}

// Cells around two points, turned by 45 degrees: half a cell's diagonal more on all sides in the plane of the
// turn, half an edge along its axis.
TEST(Scene, BoundsHoldVoxelsAndPoints) {
    Scene scene;
    Mesh cells = points({{0, 0, 0}, {0, 0, 1}});
    cells.edit([](MeshData& data) { data.voxel_size = 0.5f; });
    cells.set_T_parent_mesh(Eigen::Affine3d(Eigen::AngleAxisd(pi / 4, Vec3d::UnitZ())));
    scene.show(cells, "cells");
    const Box3d box = scene.snapshot().bounds();
    const double half_diagonal = 0.25 * std::sqrt(2.0);
    EXPECT_NEAR((box.max() - Vec3d(half_diagonal, half_diagonal, 1.25)).norm(), 0,
                1e-12);  // double precision
    EXPECT_NEAR((box.min() + Vec3d(half_diagonal, half_diagonal, 0.25)).norm(), 0, 1e-12);

    Mesh dots = points({{0, 0, 0}, {1, 0, 0}});
    Style style;
    style.point_size = 0.5f;
    style.point_size_unit = SizeUnit::world;
    dots.set_style(style);
    scene.clear();
    scene.show(dots, "dots");
    EXPECT_EQ(scene.snapshot().bounds().min(), Vec3d(-0.25, -0.25, -0.25));
    EXPECT_EQ(scene.snapshot().bounds().max(), Vec3d(1.25, 0.25, 0.25));
    style.point_size_unit = SizeUnit::pixels;
    dots.set_style(style);
    scene.show(dots, "dots");
    EXPECT_EQ(scene.snapshot().bounds().max(), Vec3d(1, 0, 0));
}

}  // namespace easypbr::scene_test

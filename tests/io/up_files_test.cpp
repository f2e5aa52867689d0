// The up axis of what files hold.
#include <gtest/gtest.h>

#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/scene/merge.h"
#include "easypbr/scene/resolve.h"
#include "test_data.h"

namespace easypbr::up_files_test {

namespace {

std::string up_of_file(const std::string& name) {
    Scene scene;
    scene.show(io::load_mesh(test_data(name)), "mesh");
    return resolve(scene.snapshot(), {}, {64, 48}).settings.camera.up;
}

/// A PCD file with two points, whose second coordinate along z is `z`.
MeshData pcd(int rows, float z) {
    const std::string text = fmt::format(
        "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {}\nHEIGHT {}\nPOINTS 2\n"
        "DATA ascii\n0 0 1\n1 1 {}\n",
        2 / rows, rows, z);
    return io::read_pcd(io::Source(std::string_view(text), "test.pcd"));
}

/// A PLY file with the points (0, 0, 0) and (2, 0, 0), and a camera.
MeshData ply(const Vec3d& camera) {
    const std::string text = fmt::format(
        "ply\nformat ascii 1.0\nelement camera 1\nproperty float view_px\nproperty float view_py\n"
        "property float view_pz\nproperty float focal\nelement vertex 2\nproperty float x\nproperty float y\n"
        "property float z\nend_header\n{} {} {} 1\n0 0 0\n2 0 0\n",
        camera.x(), camera.y(), camera.z());
    return io::read_ply(io::Source(std::string_view(text), "test.ply"));
}

}  // namespace

TEST(UpOfFiles, OfDepthImagesIsTheirCamerasUp) {
    EXPECT_EQ(pcd(1, 2).up, Vec3d(0, 0, 1));
    EXPECT_EQ(pcd(2, 2).up, Vec3d(0, -1, 0));
    EXPECT_EQ(pcd(2, -2).up, Vec3d(0, 0, 1)) << "a lidar's rings";
}

TEST(FrontOfFiles, OfDepthImagesIsWhereTheirCameraStood) {
    EXPECT_EQ(pcd(1, 2).front, Vec3d(0, 0, 0));
    EXPECT_EQ(pcd(2, 2).front, Vec3d(0, 0, -1));
    EXPECT_EQ(pcd(2, -2).front, Vec3d(0, 0, 0)) << "a lidar's rings";
    EXPECT_LT((ply({1, 4, 3}).front - Vec3d(0, 0.8, 0.6)).norm(), 1e-6);
    EXPECT_EQ(ply({1, 0.5, 0}).front, Vec3d(0, 0, 0)) << "among the points";
    EXPECT_EQ(ply(Vec3d::Constant(std::nan(""))).front, Vec3d(0, 0, 0));
}

TEST(UpOfFiles, SurvivesMergingAndTurning) {
    MeshData one;
    one.V = Array3f::Dense(Array3f::Dense::Identity(3, 3));
    one.up = Vec3d::UnitZ();
    EXPECT_EQ(transformed(one, Eigen::Affine3d(Eigen::AngleAxisd(pi, Vec3d::UnitX()))).up.z(), -1);
    MeshData other = one;
    EXPECT_EQ(merged(std::vector{one, other}).up, Vec3d(0, 0, 1));
    other.up = Vec3d::UnitY();
    EXPECT_EQ(merged(std::vector{one, other}).up, Vec3d(0, 0, 0));
    MeshData root;
    root.up = Vec3d::UnitY();
    other.up.setZero();
    root.children.push_back(Mesh(other));
    EXPECT_EQ(flatten(Mesh(root)).up, Vec3d(0, 1, 0));
}

TEST(FrontOfFiles, SurvivesMergingAndTurning) {
    MeshData one;
    one.V = Array3f::Dense(Array3f::Dense::Identity(3, 3));
    one.front = Vec3d::UnitZ();
    EXPECT_EQ(transformed(one, Eigen::Affine3d(Eigen::AngleAxisd(pi, Vec3d::UnitX()))).front.z(), -1);
    MeshData other = one;
    EXPECT_EQ(merged(std::vector{one, other}).front, Vec3d(0, 0, 1));
    other.front.setZero();
    EXPECT_EQ(merged(std::vector{one, other}).front, Vec3d(0, 0, 0));
}

TEST(FrontOfFiles, IsThatOfTheScanner) {
    REQUIRE_TEST_DATA();
    EXPECT_EQ(io::load_mesh(test_data("clouds/room_rgb.pcd")).snapshot()->front, Vec3d(0, 0, -1));
    const Vec3d scanner = io::load_mesh(test_data("misc/rangemap.ply")).snapshot()->front;
    EXPECT_GT(scanner.z(), 0.99) << scanner.transpose();
    EXPECT_EQ(io::load_mesh(test_data("bunny.ply")).snapshot()->front, Vec3d(0, 0, 0));
}

TEST(UpOfFiles, LetsScansStand) {
    REQUIRE_TEST_DATA();
    EXPECT_EQ(up_of_file("clouds/lion.ply"), "+z");
    EXPECT_EQ(up_of_file("clouds/room_rgb.pcd"), "-y");
    EXPECT_EQ(up_of_file("clouds/terrain.pcd"), "+z");
    EXPECT_EQ(up_of_file("nefertiti.obj"), "+z");
}

TEST(UpOfFiles, LeavesWhatStands) {
    REQUIRE_TEST_DATA();
    for (const char* name :
         {"bunny.ply", "head.obj", "spot.obj", "sphere.obj", "room_scene.obj", "lantern/lantern_obj.obj",
          "misc/brain.ply", "misc/office_chair.obj", "misc/knot_max_simplified.STL", "misc/rangemap.ply",
          "misc/bunny10k_textured.obj", "misc/matteonormb.ply", "DamagedHelmet/DamagedHelmet.gltf",
          "Duck/Duck.gltf"})
        EXPECT_EQ(up_of_file(name), "+y") << name;
}

}  // namespace easypbr::up_files_test

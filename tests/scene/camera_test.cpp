#include "easypbr/scene/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "easypbr/core/error.h"

namespace easypbr::camera_test {

namespace {

Vec3d ndc_of(const Camera& camera, double aspect, const Vec3d& in_camera) {
    return (camera.projection_matrix(aspect) * in_camera.homogeneous()).hnormalized();
}

Mat4d random_pose(std::mt19937& random) {
    std::normal_distribution<double> normal;
    const Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
    Mat4d T = Mat4d::Identity();
    T.topLeftCorner<3, 3>() = q.normalized().toRotationMatrix();
    T.topRightCorner<3, 1>() = Vec3d(normal(random), normal(random), normal(random));
    return T;
}

const Mat3d example_K = (Mat3d() << 520, 0, 313, 0, 515, 250, 0, 0, 1).finished();

}  // namespace

// z_ndc = near / distance; a point on the upper edge stands at tan(fov / 2).
TEST(Camera, ProjectsPerspectively) {
    Camera camera;
    camera.fov_y_deg = 90;
    camera.near = 0.25;
    EXPECT_NEAR(ndc_of(camera, 2, {0, 0, -0.25}).z(), 1, 1e-15);
    EXPECT_NEAR(ndc_of(camera, 2, {0, 0, -1000}).z(), 0.25 / 1000, 1e-15);
    EXPECT_TRUE(ndc_of(camera, 2, {8, 4, -4}).isApprox(Vec3d(1, 1, 0.0625), 1e-12));
    EXPECT_TRUE(ndc_of(camera, 2, {-4, -2, -4}).isApprox(Vec3d(-0.5, -0.5, 0.0625), 1e-12));
}

TEST(Camera, ProjectsOrthographically) {
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.ortho_height = 4;
    camera.near = 1;
    camera.far = 9;
    EXPECT_TRUE(ndc_of(camera, 1.5, {3, -2, -1}).isApprox(Vec3d(1, -1, 1), 1e-15));
    EXPECT_TRUE(ndc_of(camera, 1.5, {1.5, 1, -9}).isApprox(Vec3d(0.5, 0.5, 0), 1e-15));
    EXPECT_NEAR(ndc_of(camera, 1.5, {0, 0, -5}).z(), 0.5, 1e-15);
    EXPECT_THROW(camera.opencv_K(100, 100), ArgumentError);
}

TEST(Camera, UnprojectsWhatItProjects) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < 100; ++i) {
        Camera camera = i % 2 ? Camera::from_opencv(example_K, random_pose(random), 640, 480)
                              : Camera::from_opengl(random_pose(random), 40);
        const Mat4d P = camera.projection_matrix(4.0 / 3) * camera.view();
        const Vec3d world = camera.T_world_cam * Vec3d(unit(random), unit(random), -2 + unit(random));
        const Vec3d ndc = (P * world.homogeneous()).hnormalized();
        // Double precision times the conditioning of a perspective inverse (near 0.01, distance 3).
        EXPECT_TRUE(Vec3d((P.inverse() * ndc.homogeneous()).hnormalized()).isApprox(world, 1e-10));
    }
}

// OpenCV projects (X, Y, Z) of its own axes to (fx X/Z + cx, fy Y/Z + cy) with pixel centres at integers: the
// pixel whose centre is hit by NDC (x, y) in our picture (edges at 0 and width) is half a pixel less.
TEST(Camera, ProjectsAsOpenCvDoes) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < 100; ++i) {
        const Mat4d T = random_pose(random);
        const Camera camera = Camera::from_opencv(example_K, T, 640, 480);
        const Vec3d in_opencv(unit(random), unit(random), 3 + unit(random));
        const Vec3d pixel = example_K * in_opencv / in_opencv.z();
        const Vec3d world = (T * in_opencv.homogeneous()).head<3>();
        const Vec3d ndc = ndc_of(camera, 640.0 / 480, camera.T_world_cam.inverse() * world);
        EXPECT_NEAR((ndc.x() + 1) / 2 * 640 - 0.5, pixel.x(), 1e-9);
        EXPECT_NEAR((1 - ndc.y()) / 2 * 480 - 0.5, pixel.y(), 1e-9);
    }
}

TEST(Camera, GivesBackOpenCvMatrices) {
    std::mt19937 random(3);
    const Mat4d T = random_pose(random);
    const Camera camera = Camera::from_opencv(example_K, T, 640, 480);
    EXPECT_TRUE(camera.opencv_K(640, 480).isApprox(example_K, 1e-14));
    EXPECT_TRUE(camera.opencv_T_world_cam().isApprox(T, 1e-15));
    // Twice the size: the principal point scales from the picture's corner, which is at -0.5 for OpenCV.
    const Mat3d twice = camera.opencv_K(1280, 960);
    EXPECT_NEAR(twice(0, 0), 1040, 1e-9);
    EXPECT_NEAR(twice(0, 2), 2 * 313.5 - 0.5, 1e-9);
    EXPECT_NEAR(twice(1, 2), 2 * 250.5 - 0.5, 1e-9);
    // Without intrinsics: fy = (h / 2) / tan(fov / 2), the principal point between the two middle pixels.
    Camera plain;
    plain.fov_y_deg = 90;
    const Mat3d expected = (Mat3d() << 50, 0, 99.5, 0, 50, 49.5, 0, 0, 1).finished();
    EXPECT_TRUE(plain.opencv_K(200, 100).isApprox(expected, 1e-14));
}

TEST(Camera, LooksAtThings) {
    const Camera camera = Camera::look_at({0, 0, 5}, {0, 0, 0});
    EXPECT_TRUE(camera.T_world_cam.linear().isApprox(Mat3d::Identity(), 1e-15));
    const Camera aside = Camera::look_at({5, 0, 0}, {0, 0, 0});
    EXPECT_TRUE(Vec3d(aside.T_world_cam.linear().col(0)).isApprox(Vec3d(0, 0, -1), 1e-15));
    EXPECT_THROW(Camera::look_at({1, 2, 3}, {1, 2, 3}), ArgumentError);
}

TEST(Camera, LooksAlongUpWithoutLosingItsAxes) {
    struct Case {
        Vec3d position, up, top;
    };
    for (const Case& c : {Case{{0, 3, 0}, {0, 1, 0}, {0, 0, -1}}, Case{{0, -3, 0}, {0, 1, 0}, {0, 0, 1}},
                          Case{{0, 0, 3}, {0, 0, 1}, {0, 1, 0}}, Case{{3, 0, 0}, {1, 0, 0}, {0, 0, -1}}}) {
        const Mat3d R = Camera::look_at(c.position, Vec3d::Zero(), c.up).T_world_cam.linear();
        EXPECT_TRUE((R * R.transpose()).isApprox(Mat3d::Identity(), 1e-14));
        EXPECT_NEAR(R.determinant(), 1, 1e-14);
        EXPECT_TRUE(Vec3d(R.col(1)).isApprox(c.top, 1e-14)) << R;
        EXPECT_TRUE(Vec3d(R.col(2)).isApprox(c.position / 3, 1e-14)) << R;
    }
}

TEST(Camera, HasAPoseWhateverTheLengthOfUpIs) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const Vec3d position(1, 2, 3), target(0, 0, 0);
    const auto pose = [&](const Vec3d& up) {
        return Camera::look_at(position, target, up).T_world_cam.matrix();
    };
    const Mat4d upright = pose({0, 1, 0});
    // Their squares underflow, and overflow.
    EXPECT_EQ(pose({0, 1e-200, 0}), upright);
    EXPECT_EQ(pose({0, 1e200, 0}), upright);
    EXPECT_EQ(pose({0, 0, 0}), upright) << "none is +y";
    for (const Vec3d& down : {Vec3d(0, -1, 0), Vec3d(0, 0, -1)}) {
        const Mat3d R = Camera::look_at({0, 0, 0}, down, {0, 0, 0}).T_world_cam.linear();
        // Sums of products of numbers of at most 1.
        EXPECT_LT((R * R.transpose() - Mat3d::Identity()).cwiseAbs().maxCoeff(), 1e-15);
    }
    EXPECT_THROW(pose({0, std::nan(""), 0}), ArgumentError);
    EXPECT_THROW(pose({0, infinity, 0}), ArgumentError);
}

TEST(Camera, RefusesWhatIsNoCamera) {
    const Mat4d identity = Mat4d::Identity();
    Mat4d mirrored = identity, scaled = identity, sheared = identity, nan = identity;
    mirrored(0, 0) = -1;
    scaled *= 1.01;
    scaled(3, 3) = 1;
    sheared(3, 0) = 0.1;
    nan(1, 1) = std::nan("");
    for (const Mat4d& pose : {mirrored, scaled, sheared, nan}) {
        EXPECT_THROW(Camera::from_opengl(pose), ArgumentError) << pose;
        EXPECT_THROW(Camera::from_opencv(example_K, pose, 640, 480), ArgumentError) << pose;
    }
    EXPECT_THROW(Camera::from_opengl(identity, 180), ArgumentError);
    EXPECT_THROW(Camera::from_opencv(example_K, identity, 0, 480), ArgumentError);
    EXPECT_THROW(Camera::from_opencv(-example_K, identity, 640, 480), ArgumentError);
    EXPECT_THROW(Camera::from_opencv(example_K.transpose(), identity, 640, 480), ArgumentError);
}

}  // namespace easypbr::camera_test

#include "easypbr/geometry/camera_shapes.h"

#include <gtest/gtest.h>

#include "easypbr/core/error.h"

namespace easypbr::camera_path_shape_test {
namespace {

TEST(CameraPathShape, IsTheCurveWithACameraAtEachKey) {
    std::vector<CameraKey> keys(3);
    keys[1].T_world_cam.translation() = Vec3d(1, 2, 0);
    keys[2].T_world_cam.translation() = Vec3d(3, 0, 0);
    const CameraPath path(keys);
    const Mesh mesh = make_camera_path(path);
    EXPECT_EQ(mesh.V().rows(), 65);
    EXPECT_EQ(mesh.E().rows(), 64);
    for (Eigen::Index i = 0; i < 65; ++i) {
        const Vec3d expected = path.pose(double(i) / 32).translation();
        EXPECT_LT((mesh.V().row(i).transpose().cast<double>() - expected).norm(), 1e-6);
    }
    ASSERT_EQ(mesh.children().size(), 3u);
    EXPECT_LT((mesh.children()[1].T_parent_mesh().translation() - Vec3d(1, 2, 0)).norm(), 1e-12);
    // A tenth of the curve's extent, along -z of each camera.
    const double extent = double((mesh.V().colwise().maxCoeff() - mesh.V().colwise().minCoeff()).norm());
    EXPECT_NEAR(-mesh.children()[0].V().col(2).minCoeff(), extent / 10, 1e-5);
    EXPECT_NEAR(-make_camera_path(path, {4, 3}, 30, 2.0).children()[0].V().col(2).minCoeff(), 2, 1e-6);
    EXPECT_THROW(make_camera_path(path, {4, 3}, 30, 0.0), ArgumentError);
}

TEST(CameraPathShape, OfAnOrbitIsAClosedCircleOfTwelve) {
    const CameraPath orbit = CameraPath::orbit(Camera::look_at(Vec3d(0, 0, 5), Vec3d::Zero()), Vec3d::Zero());
    const Mesh mesh = make_camera_path(orbit);
    EXPECT_EQ(mesh.children().size(), 12u);
    EXPECT_LT((mesh.V().row(0) - mesh.V().row(mesh.V().rows() - 1)).norm(), 1e-6);
    for (Eigen::Index i = 0; i < mesh.V().rows(); ++i) EXPECT_NEAR(mesh.V().row(i).norm(), 5, 1e-6);
}

}  // namespace
}  // namespace easypbr::camera_path_shape_test

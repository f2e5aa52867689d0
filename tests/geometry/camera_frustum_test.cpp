#include "easypbr/geometry/camera_shapes.h"

#include <gtest/gtest.h>

#include <limits>

#include "geometry/measure.h"

namespace easypbr::camera_frustum_test {
namespace {

Vec3d world_vertex(const Mesh& mesh, Eigen::Index vertex) {
    return mesh.T_parent_mesh() * mesh.V().row(vertex).transpose().cast<double>();
}

TEST(CameraFrustum, CornersProjectToTheCornersOfThePicture) {
    const Mat3d K = (Mat3d() << 500, 0, 300, 0, 400, 250, 0, 0, 1).finished();
    Mat4d T_world_cam = Mat4d::Identity();
    T_world_cam.topLeftCorner<3, 3>() =
        Eigen::AngleAxisd(0.7, Vec3d(1, 2, 3).normalized()).toRotationMatrix();
    T_world_cam.topRightCorner<3, 1>() = Vec3d(4, 5, 6);
    const Mesh frustum = make_camera_frustum(K, T_world_cam, Vec2i(640, 480), 2);
    EXPECT_EQ(world_vertex(frustum, 0), Vec3d(4, 5, 6)) << "the rays start at the camera";
    // OpenCV: pixel centres at integers, so the corners are (-0.5, 479.5), (639.5, 479.5), ... from the lower
    // left.
    const double pixels[4][2] = {{-0.5, 479.5}, {639.5, 479.5}, {639.5, -0.5}, {-0.5, -0.5}};
    for (int i = 0; i < 4; ++i) {
        const Vec3d in_camera =
            (T_world_cam.inverse() * world_vertex(frustum, 4 + i).homogeneous()).head<3>();
        EXPECT_NEAR(in_camera.z(), 2, 1e-6);
        const Vec3d pixel = K * in_camera / in_camera.z();
        // Float vertices: 2^-24 of 2 units, times 500 pixels per unit.
        EXPECT_NEAR(pixel.x(), pixels[i][0], 1e-4);
        EXPECT_NEAR(pixel.y(), pixels[i][1], 1e-4);
    }
}

TEST(CameraFrustum, ScalesIntrinsicsToTheSizeAskedFor) {
    const Camera camera = Camera::look_at(Vec3d(0, 0, 0), Vec3d(0, 0, -1));
    const Mesh frustum = make_camera_frustum(camera, Vec2i(200, 100), 1);
    const float half = float(std::tan(radians(15)));
    EXPECT_NEAR(frustum.V()(6, 0), 2 * half, 1e-6f);
    EXPECT_NEAR(frustum.V()(6, 1), half, 1e-6f);
    EXPECT_GT(frustum.V()(8, 1), half) << "the roof is above";
    EXPECT_TRUE(frustum.F().empty());
    EXPECT_EQ(frustum.E().rows(), 10);
}

TEST(CameraFrustum, OrthographicRaysAreParallel) {
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.ortho_height = 4;
    const Mesh frustum = make_camera_frustum(camera, Vec2i(30, 20), 5);
    for (int i = 0; i < 4; ++i)
        EXPECT_EQ(Vec3((frustum.V().row(4 + i) - frustum.V().row(i)).transpose()), Vec3(0, 0, -5));
    EXPECT_EQ(Vec3(frustum.V().row(6)), Vec3(3, 2, -5));
}

TEST(CameraFrustum, ShowsTheImageUpright) {
    Image image(3, 2, 3, PixelType::u8);
    image.at<uint8_t>(0, 0)[0] = 255;  // the upper left pixel is red
    const Mesh frustum = make_camera_frustum(Camera{}, Vec2i(3, 2), 1, image);
    const auto data = frustum.snapshot();
    ASSERT_EQ(data->children.size(), 1u);
    const auto picture = data->children[0].snapshot();
    EXPECT_EQ(picture->V.row(3), data->V.row(7)) << "upper left";
    EXPECT_EQ(Vec2(picture->UV.row(3)), Vec2(0, 1)) << "v is upwards: the upper left of the image";
    EXPECT_GT(area_vector(*picture, 0).z(), 0) << "faces the camera";
    EXPECT_TRUE(picture->materials.at(0).unlit);
    EXPECT_EQ(picture->materials[0].base_color_texture.image->at<uint8_t>(0, 0)[0], 255);
}

TEST(CameraFrustum, ImpossibleOnesAreRefused) {
    const Camera camera;
    EXPECT_THROW(make_camera_frustum(camera, Vec2i(0, 1)), ArgumentError);
    EXPECT_THROW(make_camera_frustum(camera, Vec2i(1, -1)), ArgumentError);
    EXPECT_THROW(make_camera_frustum(camera, Vec2i(1, 1), 0), ArgumentError);
    EXPECT_THROW(make_camera_frustum(camera, Vec2i(1, 1), std::numeric_limits<double>::quiet_NaN()),
                 ArgumentError);
    EXPECT_THROW(make_camera_frustum(Mat3d::Zero(), Mat4d::Identity(), Vec2i(4, 4)), ArgumentError);
}

}  // namespace
}  // namespace easypbr::camera_frustum_test

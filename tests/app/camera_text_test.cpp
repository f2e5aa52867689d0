// A camera as text: what is copied, and what pasting it replaces.
#include "easypbr/app/camera_text.h"

#include <gtest/gtest.h>

#include "easypbr/app/live_drawing.h"
#include "easypbr/core/error.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app::camera_text_test {
namespace {

const std::vector<double> pose = {1, 0, 0, 0.1, 0, 1, 0, 1.0 / 3, 0, 0, 1, 1e-17, 0, 0, 0, 1};

Settings plain_camera() {
    Settings settings;
    settings.camera.pose = pose;
    settings.camera.fov_y_deg = 41.5f;
    return settings;
}

Settings fisheye_camera() {
    Settings settings;
    settings.camera.pose = {0, 0, 1, 5, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 0, 1};
    settings.camera.intrinsics = {600, 610, 500, 300, 800, 600};
    settings.camera.distortion_model = DistortionModel::fisheye;
    settings.camera.distortion = {-0.3, 0.1, 1.0 / 3, 0};
    settings.camera.near = 0.25;
    return settings;
}

TEST(CameraText, GoesThroughTheClipboardExactly) {
    const Settings settings = plain_camera();
    Settings other;
    apply_camera_text("--set " + camera_text(settings), other);
    EXPECT_EQ(other.camera.pose, settings.camera.pose);
    EXPECT_EQ(other.camera.fov_y_deg, 41.5f);
    EXPECT_THROW(apply_camera_text("hello", other), FormatError);
    EXPECT_THROW(apply_camera_text("", other), FormatError);
    EXPECT_THROW(apply_camera_text("camera.fov_y_deg=far", other), ArgumentError);
    EXPECT_THROW(apply_camera_text("camera.pose=2,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1", other), ArgumentError);
    EXPECT_EQ(other.camera.pose, settings.camera.pose);
}

TEST(CameraText, HoldsTheWholeLens) {
    const Settings settings = fisheye_camera();
    Settings other;
    apply_camera_text(camera_text(settings), other);
    EXPECT_EQ(other.camera.intrinsics, settings.camera.intrinsics);
    EXPECT_EQ(other.camera.distortion_model, DistortionModel::fisheye);
    EXPECT_EQ(other.camera.distortion, settings.camera.distortion);
    EXPECT_EQ(other.camera.near, settings.camera.near);
}

TEST(CameraText, LeavesNothingOfTheCameraThatItReplaces) {
    Settings other = fisheye_camera();
    other.camera.up = "+z";
    apply_camera_text(camera_text(plain_camera()), other);
    EXPECT_EQ(other.camera.pose, pose);
    EXPECT_EQ(other.camera.fov_y_deg, 41.5f);
    EXPECT_TRUE(other.camera.intrinsics.empty());
    EXPECT_TRUE(other.camera.distortion.empty());
    EXPECT_EQ(other.camera.distortion_model, DistortionModel::brown_conrady);
    EXPECT_FALSE(other.camera.near.is_pinned());
    // The scene's, not the camera's.
    EXPECT_EQ(other.camera.up, Auto<std::string>("+z"));
}

TEST(CameraText, OfPoseOrLensAloneLeavesTheOther) {
    Settings other = fisheye_camera();
    apply_camera_text("camera.position=0,0,5", other);
    EXPECT_TRUE(other.camera.pose.empty());
    EXPECT_EQ(other.camera.position, Auto<Vec3d>(Vec3d(0, 0, 5)));
    EXPECT_EQ(other.camera.intrinsics, fisheye_camera().camera.intrinsics);
    other = fisheye_camera();
    apply_camera_text("camera.fov_y_deg=20", other);
    EXPECT_EQ(other.camera.pose, fisheye_camera().camera.pose);
    EXPECT_TRUE(other.camera.intrinsics.empty());
    EXPECT_EQ(other.camera.fov_y_deg, 20);
}

TEST(CameraText, BringsBackTheHeightOfAnOrthographicView) {
    const Vec2i size(120, 80);
    Scene scene;
    scene.show(make_sphere(1, 16), "ball");
    Session session(scene);
    session.settings().image.samples = 1;
    session.settings().camera.projection = Projection::orthographic;
    LiveDrawing live(session);
    const auto step = [&](const std::vector<InputEvent>& events = {}) {
        live.update(events, size, 0.02);
        return session.view_point(size).camera;
    };
    const auto control = [&](int key) {
        InputEvent event;
        event.kind = InputEvent::Kind::key_down;
        event.key = key;
        event.control = true;
        return step({event});
    };
    step();
    const Camera copied = control('C');
    InputEvent wheel;
    wheel.kind = InputEvent::Kind::scroll;
    wheel.position = {60, 40};
    wheel.scroll = {0, 6};
    const Camera zoomed = step({wheel});
    ASSERT_LT(zoomed.ortho_height, 0.9 * copied.ortho_height);
    const Camera pasted = control('V');
    EXPECT_EQ(pasted.ortho_height, copied.ortho_height);
    // A pose that is read is made a rotation again, to the last bits.
    EXPECT_TRUE(pasted.T_world_cam.matrix().isApprox(copied.T_world_cam.matrix(), 1e-12));
    const Camera undone = control('Z');
    EXPECT_EQ(undone.ortho_height, zoomed.ortho_height);
    EXPECT_EQ(undone.T_world_cam.matrix(), zoomed.T_world_cam.matrix());
}

}  // namespace
}  // namespace easypbr::app::camera_text_test

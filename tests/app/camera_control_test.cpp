#include "easypbr/app/camera_control.h"

#include <gtest/gtest.h>

namespace easypbr::app::camera_control_test {
namespace {

constexpr double exact = 1e-12;  // a few roundings of numbers near 1
const Vec2i size(800, 600);
const Vec3d up = Vec3d::UnitY();

ViewPoint front_view() {
    const Vec3d target(1, 2, 3);
    return {Camera::look_at(target + Vec3d(0, 0, 5), target, up), target};
}

ViewPoint with_projection(Projection projection) {
    ViewPoint view = front_view();
    view.camera.projection = projection;
    view.camera.ortho_height = 4;
    return view;
}

InputEvent event(InputEvent::Kind kind, Vec2d position, double time = 0) {
    InputEvent made;
    made.kind = kind;
    made.position = position;
    made.time = time;
    return made;
}

class ViewPoints : public testing::TestWithParam<Projection> {};

TEST_P(ViewPoints, PixelsAndPointsAreInverse) {
    const ViewPoint view = orbited(with_projection(GetParam()), up, 30, 20);
    for (const Vec2d& pixel : {Vec2d(0, 0), Vec2d(400, 300), Vec2d(123.5, 480)}) {
        const Vec3d back = pixel_of(view.camera, point_at(view.camera, pixel, size, 3.5), size);
        // Pixels are numbers of hundreds: 1e-9 is still thousands of roundings.
        EXPECT_NEAR(back.x(), pixel.x(), 1e-9);
        EXPECT_NEAR(back.y(), pixel.y(), 1e-9);
        EXPECT_NEAR(back.z(), 3.5, exact);
    }
}

TEST(ViewPoints, ALensAndItsInverse) {
    Camera camera = Camera::look_at(Vec3d(1, 2, 6), Vec3d(0, 0, 0));
    camera.intrinsics = Intrinsics{300, 310, 190, 140, 400, 300, 5};
    camera.distortion =
        Distortion::from_coefficients(DistortionModel::brown_conrady, {-0.3, 0.1, 0.01, 0.02});
    const Vec2i size(800, 600);
    for (const Vec2d& pixel : {Vec2d(0, 0), Vec2d(400, 300), Vec2d(799, 20), Vec2d(100, 580)})
        EXPECT_LT(
            (pixel_of(camera, point_at(camera, pixel, size, 3.5), size) - Vec3d(pixel.x(), pixel.y(), 3.5))
                .norm(),
            1e-8);
    // A lens moves what is off its axis, and a fold of it is no error.
    Camera pinhole = camera;
    pinhole.distortion.reset();
    EXPECT_GT((point_at(camera, {0, 0}, size, 1) - point_at(pinhole, {0, 0}, size, 1)).norm(), 0.01);
    camera.distortion = Distortion::from_coefficients(DistortionModel::brown_conrady, {-1, 0, 0, 0});
    EXPECT_TRUE(point_at(camera, {0, 0}, size, 1).allFinite());
    EXPECT_TRUE(pixel_of(camera, camera.T_world_cam * Vec3d(3, 0, -1), size).allFinite());
    EXPECT_TRUE(pixel_of(camera, camera.T_world_cam * Vec3d(0, 0, 1), size).allFinite());
}

TEST_P(ViewPoints, TheMiddleOfThePictureIsTheTarget) {
    const ViewPoint view = with_projection(GetParam());
    EXPECT_LT((point_at(view.camera, Vec2d(400, 300), size, 5) - view.target).norm(), exact);
}

TEST_P(ViewPoints, PanningMovesWhatIsAtTheTargetsDepthWithThePointer) {
    const ViewPoint view = with_projection(GetParam());
    const Vec3d seen = point_at(view.camera, Vec2d(200, 100), size, view.distance());
    const Vec3d after = pixel_of(panned(view, Vec2d(50, -30), size).camera, seen, size);
    EXPECT_NEAR(after.x(), 250, 1e-9);
    EXPECT_NEAR(after.y(), 70, 1e-9);
}

TEST_P(ViewPoints, ZoomingKeepsThePointAtItsPixel) {
    const ViewPoint view = with_projection(GetParam());
    const Vec3d about = point_at(view.camera, Vec2d(650, 90), size, 4);
    const ViewPoint nearer = zoomed(view, 0.5, about);
    const Vec3d after = pixel_of(nearer.camera, about, size);
    EXPECT_NEAR(after.x(), 650, 1e-9);
    EXPECT_NEAR(after.y(), 90, 1e-9);
    // The target stays on the optical axis.
    const Vec3d target = pixel_of(nearer.camera, nearer.target, size);
    EXPECT_NEAR(target.x(), 400, 1e-9);
    EXPECT_NEAR(target.y(), 300, 1e-9);
    if (GetParam() == Projection::perspective)
        EXPECT_NEAR(after.z(), 2, exact);
    else
        EXPECT_NEAR(nearer.camera.ortho_height, 2, exact);
}

INSTANTIATE_TEST_SUITE_P(Both, ViewPoints,
                         testing::Values(Projection::perspective, Projection::orthographic));

TEST(ViewPoints, OrbitingAQuarterToTheRightLooksFromTheRight) {
    const ViewPoint turned = orbited(front_view(), up, 90, 0);
    EXPECT_LT((turned.camera.position() - Vec3d(6, 2, 3)).norm(), exact);
    EXPECT_LT((turned.camera.T_world_cam.linear().col(1) - up).norm(), exact);
}

TEST(ViewPoints, OrbitingStopsBeforeTheAxisAndNeverTurnsOver) {
    ViewPoint view = front_view();
    for (int i = 0; i < 100; ++i) view = orbited(view, up, 3, 7);
    const Vec3d to_camera = (view.camera.position() - view.target) / 5;
    EXPECT_NEAR(std::acos(to_camera.dot(up)) * 180 / pi, 0.1, 1e-6);
    EXPECT_GT(view.camera.T_world_cam.linear().col(1).dot(up), 0);
}

TEST(ViewPoints, AHundredThousandTurnsStayARotationAtTheSameDistance) {
    ViewPoint view = front_view();
    for (int i = 0; i < 100000; ++i) view = orbited(view, up, 1.7, i % 2 ? 0.3 : -0.3);
    const Mat3d R = view.camera.T_world_cam.linear();
    EXPECT_LT((R.transpose() * R - Mat3d::Identity()).norm(), exact);
    // The distance takes a rounding each turn, which add up like a random walk at worst linearly: 1e5 eps.
    EXPECT_NEAR(view.distance(), 5, 1e-9);
    EXPECT_LT((view.target - front_view().target).norm(), exact);
}

TEST(ViewPoints, FocusingPutsThePointIntoTheMiddle) {
    const ViewPoint view = focused(front_view(), Vec3d(2, 2, 2));
    const Vec3d pixel = pixel_of(view.camera, Vec3d(2, 2, 2), size);
    EXPECT_NEAR(pixel.x(), 400, 1e-9);
    EXPECT_NEAR(pixel.y(), 300, 1e-9);
    EXPECT_NEAR(view.distance(), 5, exact);
}

TEST(CameraControl, ALeftDragToTheRightTurnsTheContentToTheRight) {
    CameraControl control;
    ViewPoint view = front_view();
    const Vec3d nearest(1, 2, 4);  // of a unit ball about the target, seen in the middle
    control.handle(event(InputEvent::Kind::press, {400, 300}), view, size, up);
    EXPECT_TRUE(control.is_moving());
    control.handle(event(InputEvent::Kind::move, {430, 300}), view, size, up);
    EXPECT_TRUE(control.has_dragged());
    EXPECT_GT(pixel_of(view.camera, nearest, size).x(), 400);
    control.handle(event(InputEvent::Kind::move, {430, 330}), view, size, up);
    EXPECT_GT(pixel_of(view.camera, nearest, size).y(), 300);
    control.handle(event(InputEvent::Kind::release, {430, 330}), view, size, up);
    EXPECT_FALSE(control.is_moving());
    const ViewPoint before = view;
    control.handle(event(InputEvent::Kind::move, {0, 0}), view, size, up);
    EXPECT_EQ(view.camera.T_world_cam.matrix(), before.camera.T_world_cam.matrix());
}

TEST(CameraControl, ATremblingClickMovesNothing) {
    CameraControl control;
    ViewPoint view = front_view();
    control.handle(event(InputEvent::Kind::press, {400, 300}), view, size, up);
    control.handle(event(InputEvent::Kind::move, {401, 300}), view, size, up);
    EXPECT_EQ(view.camera.T_world_cam.matrix(), front_view().camera.T_world_cam.matrix());
    EXPECT_FALSE(control.has_dragged());
}

TEST(CameraControl, RightDragPansByThePixelsOfThePointer) {
    CameraControl control;
    ViewPoint view = front_view();
    InputEvent press = event(InputEvent::Kind::press, {400, 300});
    press.button = MouseButton::right;
    control.handle(press, view, size, up);
    control.handle(event(InputEvent::Kind::move, {460, 290}), view, size, up);
    const Vec3d pixel = pixel_of(view.camera, front_view().target, size);
    EXPECT_NEAR(pixel.x(), 460, 1e-9);
    EXPECT_NEAR(pixel.y(), 290, 1e-9);
}

TEST(CameraControl, TwoQuickClicksAskForFocusAndSlowOnesDoNot) {
    const auto focus_after = [](double seconds) {
        CameraControl control;
        ViewPoint view = front_view();
        control.handle(event(InputEvent::Kind::press, {10, 20}, 1), view, size, up);
        control.handle(event(InputEvent::Kind::release, {10, 20}, 1.05), view, size, up);
        return control.handle(event(InputEvent::Kind::press, {11, 20}, 1 + seconds), view, size, up).focus;
    };
    EXPECT_EQ(focus_after(0.2), std::optional<Vec2d>(Vec2d(11, 20)));
    EXPECT_FALSE(focus_after(0.6));
}

TEST(CameraControl, TheWheelAsksToZoomAtThePointer) {
    CameraControl control;
    ViewPoint view = front_view();
    InputEvent scroll = event(InputEvent::Kind::scroll, {5, 6});
    scroll.scroll = {0, 1};
    const CameraControl::Wish wish = control.handle(scroll, view, size, up);
    EXPECT_EQ(wish.zoom, std::optional<Vec2d>(Vec2d(5, 6)));
    EXPECT_LT(wish.zoom_factor, 1);
}

TEST(CameraControl, FliesForwardWhileTheKeyIsHeldAndStopsWhenFocusIsLost) {
    CameraControl control;
    ViewPoint view = front_view();
    InputEvent w = event(InputEvent::Kind::key_down, {0, 0});
    w.key = 'W';
    control.handle(w, view, size, up);
    EXPECT_TRUE(control.advance(0.5, view));
    EXPECT_LT(view.camera.position().z(), 8);
    EXPECT_NEAR(view.distance(), 5, exact);
    control.handle(event(InputEvent::Kind::focus_lost, {0, 0}), view, size, up);
    EXPECT_FALSE(control.advance(0.5, view));
}

TEST(CameraControl, ControlKeysAreNotForTheCamera) {
    CameraControl control;
    ViewPoint view = front_view();
    InputEvent key = event(InputEvent::Kind::key_down, {0, 0});
    key.key = 'F';
    EXPECT_TRUE(control.handle(key, view, size, up).fit);
    key.control = true;
    EXPECT_FALSE(control.handle(key, view, size, up).fit);
}

}  // namespace
}  // namespace easypbr::app::camera_control_test

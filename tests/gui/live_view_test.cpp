// The window's inside, driven by events, without a window.
#include "easypbr/gui/live_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "easypbr/app/channels.h"
#include "easypbr/core/error.h"
#include "easypbr/core/interrupt.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/settings.h"

namespace easypbr::gui::live_view_test {
namespace {

using app::InputEvent;
using Kind = InputEvent::Kind;

const Vec2i size(900, 600);
const Vec2d middle(450, 300);

class Live : public testing::Test {
  protected:
    Live() : session_(ball_scene()) {
        session_.settings().image.samples = 6;
        view_.state().panels.shown = false;
        settle();
    }

    static Scene ball_scene() {
        Scene scene;
        scene.show(make_sphere(1, 32), "ball");
        return scene;
    }

    bool step(const std::vector<InputEvent>& events = {}) { return view_.update(events, size, 1, 0.02); }
    void settle() {
        for (int i = 0; i < 100 && (step() || view_.is_busy()); ++i) continue;
        EXPECT_FALSE(view_.is_busy());
    }
    static InputEvent at(Kind kind, Vec2d position) {
        InputEvent event;
        event.kind = kind;
        event.position = position;
        return event;
    }
    static InputEvent key(int code, bool control = false) {
        InputEvent event;
        event.kind = Kind::key_down;
        event.key = code;
        event.control = control;
        return event;
    }
    void drag(Vec2d from, Vec2d to) {
        step({at(Kind::move, from)});
        step({at(Kind::press, from)});
        step({at(Kind::move, (from + to) / 2)});
        step({at(Kind::move, to)});
        step({at(Kind::release, to)});
    }
    Vec3d camera_position() { return session_.view_point(size).camera.position(); }

    app::Session session_;
    LiveView view_{session_};
};

TEST_F(Live, RefinesToTheStillAndThenDrawsNothing) {
    const Image screen = view_.screen();
    const Image still = app::Session(session_.scene()).render({size, 6});
    double worst = 0;
    for (size_t i = 0; i < still.pixel_count(); ++i)
        for (size_t c = 0; c < 3; ++c)
            worst = std::max(worst, std::abs(double(screen.pixels<uint8_t>()[4 * i + c]) -
                                             still.pixels<uint8_t>()[4 * i + c]));
    EXPECT_LE(worst, 1);  // once more through 8 bits
    EXPECT_FALSE(step());
    EXPECT_FALSE(step());
}

TEST_F(Live, ALeftDragTurnsTheCameraAndUndoTurnsItBack) {
    const Vec3d before = camera_position();
    drag(middle, middle + Vec2d(120, 0));
    settle();
    const Vec3d after = camera_position();
    EXPECT_GT((after - before).norm(), 0.5);
    EXPECT_NEAR((after - session_.view_point(size).target).norm(),
                (before - session_.view_point(size).target).norm(), 1e-6);
    step({key('Z', true)});
    EXPECT_LT((camera_position() - before).norm(), 1e-9);
    InputEvent redo = key('Y', true);
    for (int way = 0; way < 2; ++way) {
        step({redo});
        EXPECT_LT((camera_position() - after).norm(), 1e-9);
        step({key('Z', true)});
        EXPECT_LT((camera_position() - before).norm(), 1e-9);
        redo = key('Z', true);
        redo.shift = true;
    }
}

TEST_F(Live, AQuickDragCountsThoughItIsOverBeforeTheFirstFrame) {
    // As a window hands it over after a slow frame: all at once.
    LiveView fresh(session_);
    const app::ViewPoint begin = session_.view_point(size);
    session_.set_view_point(begin);
    const Vec2d half = middle + Vec2d(60, 0), to = middle + Vec2d(120, 0);
    fresh.update({at(Kind::move, middle), at(Kind::press, middle), at(Kind::move, half), at(Kind::move, to),
                  at(Kind::release, to)},
                 size, 1, 0.02);
    const Vec3d quick = camera_position();
    EXPECT_GT((quick - begin.camera.position()).norm(), 0.5);
    session_.set_view_point(begin);
    drag(middle, to);
    EXPECT_LT((quick - camera_position()).norm(), 1e-6) << "another way than the slow drag's";
}

// Whoever presses a button waits for the next picture, not for a sample of the last one.
TEST_F(Live, InputInterruptsAFrameThatRefines) {
    session_.settings().path.enabled = true;
    session_.settings().image.samples = 8;
    app::Session other(session_.scene());
    other.replace_settings(session_.settings());
    const Image still = other.render({size, 8});
    int asked = 0, most = 1 << 30;
    view_.set_interrupt([&] { return ++asked > most; });
    step();
    const uint64_t pictures = view_.drawing().picture().statistics().pictures;
    for (int i = 0; i < 3; ++i) {
        asked = 0;
        step();
    }
    const int whole = asked;
    EXPECT_GT(whole, 10);
    const int frames = view_.drawing().picture().statistics().frames;
    EXPECT_GT(frames, 0);
    // In the middle of a frame, where a part of it has been added to the sum.
    for (const int part : {5, 4, 3}) {
        most = whole / part;
        asked = 0;
        step();
        EXPECT_EQ(asked, most + 1);
    }
    EXPECT_EQ(view_.drawing().picture().statistics().frames, frames);
    EXPECT_TRUE(view_.is_busy());
    // What was given up is drawn anew, bit for bit.
    most = 1 << 30;
    settle();
    EXPECT_EQ(view_.drawing().picture().statistics().pictures, pictures);
    const Image screen = view_.screen();
    double worst = 0;
    for (size_t i = 0; i < still.bytes().size(); ++i)
        if (i % 4 < 3)
            worst =
                std::max(worst, std::abs(double(screen.pixels<uint8_t>()[i]) - still.pixels<uint8_t>()[i]));
    EXPECT_LE(worst, 1);  // once more through 8 bits
}

// Nobody takes the input that waits before a finished screen is drawn.
TEST_F(Live, InputThatWaitsDoesNotKeepAScreenFromItsEnd) {
    session_.settings().image.samples = 5;
    int asked = 0;
    view_.set_interrupt([&] { return ++asked <= 20; });
    view_.finished_screen(size);
    EXPECT_TRUE(view_.drawing().picture().is_complete());
    session_.settings().image.samples = 4;
    view_.drawing().draw_finished({.interrupt = [&] { return ++asked <= 20; }});
    EXPECT_TRUE(view_.drawing().picture().is_complete());
    EXPECT_EQ(asked, 0);
}

TEST_F(Live, ScreenshotsOfNoPicturesSizeAndOfOtherScalesAreRefused) {
    for (const float scale : {0.0f, -1.0f, 1e-3f, 0.49f, 4.01f, std::nanf(""), HUGE_VALF})
        EXPECT_THROW(view_.finished_screen(size, scale), ArgumentError) << scale;
    for (const Vec2i& wrong : {Vec2i(0, 5), Vec2i(5, 0), Vec2i(-3, 5), Vec2i(5, 65537)})
        EXPECT_THROW(view_.finished_screen(wrong), ArgumentError) << wrong.transpose();
    EXPECT_EQ(view_.finished_screen({64, 48}, 4).width(), 64);
    // 4 of the screen times 4 of the panels: their font would be larger than a texture.
    view_.set_panel_scale(4);
    view_.update({}, {64, 48}, 4, 0.02);
    EXPECT_EQ(view_.state().screen.scale, 8);
}

TEST_F(Live, AScreenshotIsGivenUpBetweenTwoFrames) {
    int asked = 0;
    const InterruptScope scope([&] { return ++asked > 2; });
    // The panels alone take three frames to settle.
    EXPECT_THROW(view_.finished_screen(size), Interrupted);
}

TEST_F(Live, AnAutomaticCameraShowsTheContentBelowTheMenuBar) {
    app::Session session(session_.scene());
    LiveView view(session);
    view.update({}, size, 1, 0.02);
    ASSERT_TRUE(view.state().panels.shown);
    const double bar = session.insets().top * size.y();
    EXPECT_GT(bar, 10);
    EXPECT_LT(bar, 40);
    const auto check = [&](double top) {
        const Camera camera = session.view_point(size).camera;
        double low = 1e9, high = -1e9;
        for (double angle = 0; angle < 2 * pi; angle += 0.01) {
            // The silhouette of the ball: seen from a distance d, of radius sqrt(1 - 1/d^2) about 1/d of the
            // way.
            const double d = camera.position().norm();
            const Vec3d to = camera.position() / d, up = camera.T_world_cam.linear().col(1),
                        right = up.cross(to).normalized(), above = to.cross(right);
            const Vec3d point =
                to / d + std::sqrt(1 - 1 / (d * d)) * (std::cos(angle) * right + std::sin(angle) * above);
            const Eigen::Vector4d clip =
                camera.projection_matrix(double(size.x()) / size.y()) * (camera.view() * point.homogeneous());
            const double row = (1 - clip.y() / clip.w()) / 2 * size.y();
            low = std::min(low, row);
            high = std::max(high, row);
        }
        const double margin = 0.05 * (size.y() - top) / 2;
        // The mesh is a ball of 32 segments: up to a percent smaller than the ball.
        EXPECT_NEAR(low, top + margin, 4);
        EXPECT_NEAR(high, size.y() - margin, 4);
    };
    check(bar);
    view.update({key('H')}, size, 1, 0.02);
    view.update({key('F')}, size, 1, 0.02);
    view.update({}, size, 1, 0.02);
    EXPECT_EQ(session.insets().top, 0);
    check(0);
}

TEST_F(Live, AClickSelectsAndTheWheelZoomsToThePointer) {
    const Vec2d place = middle + Vec2d(60, 30);
    step({at(Kind::move, place)});
    step({at(Kind::press, place), at(Kind::release, place)});
    EXPECT_EQ(view_.drawing().selection().object, "ball");
    ASSERT_TRUE(view_.drawing().selection().picked);
    const Vec3d point = view_.drawing().selection().picked->position;
    InputEvent wheel = at(Kind::scroll, place);
    wheel.scroll = {0, 3};
    const double before = session_.view_point(size).camera.position().norm();
    step({wheel});
    const app::ViewPoint view = session_.view_point(size);
    EXPECT_LT(view.camera.position().norm(), before);
    // Picked positions are those of the pixel's centre.
    EXPECT_LT((pixel_of(view.camera, point, size).head<2>() - place).norm(), 1.0);
    const Vec2d corner(5, 5);
    step({at(Kind::move, corner)});
    step({at(Kind::press, corner), at(Kind::release, corner)});
    EXPECT_EQ(view_.drawing().selection().object, "");
}

TEST_F(Live, ADoubleClickMakesThePointTheTarget) {
    InputEvent first = at(Kind::press, middle + Vec2d(50, 0)), second = first;
    first.time = 1;
    second.time = 1.2;
    step({first, at(Kind::release, first.position), second, at(Kind::release, first.position)});
    EXPECT_NEAR(session_.view_point(size).target.norm(), 1, 0.02);  // on the ball
}

TEST_F(Live, HoveringNamesWhatIsThere) {
    step({at(Kind::move, middle)});
    settle();
    ASSERT_TRUE(view_.drawing().picture().hovered());
    EXPECT_EQ(view_.drawing().picture().hovered()->object, "ball");
    step({at(Kind::move, {3, 3})});
    settle();
    EXPECT_FALSE(view_.drawing().picture().hovered());
}

TEST_F(Live, KeysHidePanelsShowThemselvesFitAndClose) {
    view_.state().panels.shown = true;
    step({key('H')});
    EXPECT_FALSE(view_.state().panels.shown);
    InputEvent question = at(Kind::text, middle);
    question.code = '?';
    step({question});
    EXPECT_TRUE(view_.state().panels.keys);
    step({key(app::key::escape)});
    EXPECT_FALSE(view_.state().panels.keys);
    EXPECT_FALSE(view_.wants_to_close());
    for (int i = 0; i < panel_count; ++i) {
        const bool before = view_.state().panels.is_open(Panel(i));
        step({key(app::key::f1 + i)});
        EXPECT_NE(view_.state().panels.is_open(Panel(i)), before);
    }
    const double fitted = camera_position().norm();
    session_.set_view_point(app::zoomed(session_.view_point(size), 5, Vec3d(0, 0, 0)));
    step({key('F')});
    EXPECT_NEAR(camera_position().norm(), fitted, 0.02 * fitted);
    step({key(app::key::escape)});
    EXPECT_TRUE(view_.wants_to_close());
}

TEST_F(Live, ThePanelsTakeTheirOwnClicks) {
    view_.state().panels.shown = true;
    settle();
    const Vec2d in_panel(60, 60);
    step({at(Kind::move, in_panel)});
    step();
    const Vec3d before = camera_position();
    drag(in_panel, in_panel + Vec2d(100, 5));
    EXPECT_LT((camera_position() - before).norm(), 1e-12);
    const Image with = view_.screen();
    step({key('H')});
    settle();
    EXPECT_FALSE(std::ranges::equal(with.bytes(), view_.screen().bytes()));
}

TEST_F(Live, PanelsOfANarrowWindowDoNotOverlap) {
    view_.state().panels.shown = true;
    for (const int width : {900, 640, 600, 300, 120}) {
        for (int i = 0; i < 4; ++i) view_.update({}, {width, 900}, 1, 0.02);
        const auto scene = view_.places().at("Scene"), effects = view_.places().at("Effects");
        EXPECT_FALSE(scene.intersects(effects)) << width;
        EXPECT_LE(std::max(scene.max().x(), effects.max().x()), width);
        EXPECT_EQ(scene.min().x() == effects.min().x(), width <= 600) << width;
    }
}

TEST_F(Live, NewDataUnderTheSameNameKeepLookAndCamera) {
    change_look(view_.state(), "ball", "material.roughness", {0.125});
    drag(middle, middle + Vec2d(80, 0));
    settle();
    const Vec3d camera = camera_position();
    session_.scene().show(make_sphere(1, 12), "ball");
    settle();
    EXPECT_EQ(session_.scene().get("ball").material().roughness, 0.125f);
    EXPECT_EQ(session_.scene().get("ball").F().rows(), make_sphere(1, 12).F().rows());
    EXPECT_LT((camera_position() - camera).norm(), 1e-12);
}

TEST_F(Live, TheManipulatorMovesTheObjectAlongItsAxis) {
    view_.state().panels.shown = true;
    view_.drawing().selection().object = "ball";
    session_.set_view_point({Camera::look_at(Vec3d(0, 0, 6), Vec3d(0, 0, 0)), Vec3d(0, 0, 0)});
    settle();
    // The x handle goes 90 pixels to the right of the centre.
    drag(middle + Vec2d(60, 0), middle + Vec2d(120, 0));
    const Eigen::Affine3d T = session_.scene().get("ball").T_parent_mesh();
    const double pixel = point_at(session_.view_point(size).camera, {1, 0}, size, 6).x() -
                         point_at(session_.view_point(size).camera, {0, 0}, size, 6).x();
    EXPECT_NEAR(T.translation().x(), 60 * pixel, 0.01);
    EXPECT_NEAR(T.translation().tail<2>().norm(), 0, 1e-9);
    EXPECT_LT((camera_position() - Vec3d(0, 0, 6)).norm(), 1e-12);
}

TEST_F(Live, UndoTakesPosesAndMaterialsBackAndLeavesTheProgramsOwn) {
    view_.state().panels.shown = true;
    view_.drawing().selection().object = "ball";
    session_.set_view_point({Camera::look_at(Vec3d(0, 0, 6), Vec3d(0, 0, 0)), Vec3d(0, 0, 0)});
    settle();
    const auto ball = [&] { return session_.scene().get("ball"); };
    const float roughness = ball().material().roughness;
    change_look(view_.state(), "ball", "material.roughness", {0.125});
    settle();
    // The program moves it: that is no change of a person's.
    ball().translate(Vec3d(0, 0.1, 0));
    settle();
    const Vec2d centre = pixel_of(session_.view_point(size).camera, Vec3d(0, 0.1, 0), size).head<2>();
    drag(centre + Vec2d(60, 0), centre + Vec2d(120, 0));
    settle();
    const Vec3d moved = ball().T_parent_mesh().translation();
    EXPECT_GT(moved.x(), 0.2);
    step({key('Z', true)});
    EXPECT_LT((ball().T_parent_mesh().translation() - Vec3d(0, 0.1, 0)).norm(), 1e-12);
    EXPECT_EQ(ball().material().roughness, 0.125f);
    ball().translate(Vec3d(0, 0.2, 0));
    step({key('Z', true)});
    EXPECT_EQ(ball().material().roughness, roughness);
    EXPECT_LT((ball().T_parent_mesh().translation() - Vec3d(0, 0.3, 0)).norm(), 1e-12);
    // What was undone is not made again with other data.
    session_.scene().show(make_sphere(1, 12), "ball");
    settle();
    EXPECT_EQ(ball().material().roughness, roughness);
    step({key('Y', true)});
    EXPECT_EQ(ball().material().roughness, 0.125f);
    step({key('Y', true)});
    EXPECT_LT((ball().T_parent_mesh().translation() - moved).norm(), 1e-12);
}

TEST_F(Live, EveryChannelIsShown) {
    std::vector<Image> seen;
    for (const char* channel : {"picture", "slices", "normal_world", "depth", "albedo", "object_id"}) {
        view_.drawing().channel = channel;
        settle();
        const Image screen = view_.screen();
        for (const Image& other : seen)
            EXPECT_FALSE(std::ranges::equal(other.bytes(), screen.bytes())) << channel;
        seen.push_back(screen);
    }
    // The ball's middle faces the camera: its world normal is towards it.
    view_.drawing().channel = "normal_world";
    settle();
    const Vec3d towards = camera_position().normalized();
    const Image screen = view_.screen();
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(screen.at<uint8_t>(450, 300)[c], (towards[c] / 2 + 0.5) * 255, 2);  // 8 bits, flat faces
}

TEST_F(Live, WhatCannotBeDrawnIsToldAndTheLoopGoesOn) {
    session_.settings().background.mode = BackgroundMode::image;
    step();
    ASSERT_EQ(view_.drawing().notifications().list().size(), 1u);
    EXPECT_NE(view_.drawing().notifications().list()[0].text.find("background.image"), std::string::npos);
    for (int i = 0; i < 5; ++i) step();
    EXPECT_EQ(view_.drawing().notifications().list().size(), 1u);
    session_.settings().background.mode = BackgroundMode::color;
    settle();
    InputEvent drop = at(Kind::drop, middle);
    drop.paths = {"/nowhere/at_all.ply"};
    step({drop});
    EXPECT_EQ(view_.drawing().notifications().list().size(), 2u);
}

TEST(LiveView, AnEmptySceneIsAnEmptyScreen) {
    app::Session session;
    LiveView view(session);
    view.state().panels.shown = false;
    EXPECT_TRUE(view.update({}, {64, 48}, 1, 0.01));
    const Image screen = view.screen();
    EXPECT_EQ(screen.at<uint8_t>(32, 24)[0], 64);  // the grey of a default background
    EXPECT_TRUE(view.drawing().notifications().list().empty());
    EXPECT_THROW(LiveView(session).screen(), ArgumentError);
}

TEST(History, ForgetsWhatWasUndoneWhenSomethingNewIsDone) {
    app::History history;
    Settings settings;
    history.note(settings);
    EXPECT_FALSE(history.can_undo());
    settings.image.samples = 2;
    history.note(settings);
    settings.tonemap.exposure.latch(3);  // inferred: no choice of a person's
    history.note(settings);
    settings.image.samples = 3;
    history.note(settings);
    EXPECT_EQ(history.undo().settings->image.samples, 2);
    EXPECT_EQ(history.undo().settings->image.samples, Settings().image.samples);
    EXPECT_FALSE(history.can_undo());
    EXPECT_THROW(history.undo(), ArgumentError);
    EXPECT_EQ(history.redo().settings->image.samples, 2);
    settings.image.samples = 9;
    history.note(settings);
    EXPECT_FALSE(history.can_redo());
    EXPECT_EQ(history.undo().settings->image.samples, 2);
}

// Whoever restores a state may fail: the history moves afterwards.
TEST(History, StaysWhereItIsWhileAStateIsLookedAt) {
    app::History history;
    Settings settings;
    EXPECT_THROW(history.previous(), ArgumentError);
    for (const int samples : {2, 3, 4}) {
        settings.image.samples = samples;
        history.note(settings);
    }
    EXPECT_EQ(history.previous().settings->image.samples, 3);
    EXPECT_EQ(history.previous().settings->image.samples, 3);
    EXPECT_THROW(history.next(), ArgumentError);
    history.undo();
    EXPECT_EQ(history.next().settings->image.samples, 4);
    EXPECT_EQ(history.previous().settings->image.samples, 2);
}

TEST(Slices, CutThePictureIntoSlantedParts) {
    std::vector<Image> pictures;
    for (const uint8_t grey : {10, 20, 30}) {
        Image picture(90, 60, 4, PixelType::u8);
        std::ranges::fill(picture.pixels<uint8_t>(), grey);
        pictures.push_back(picture);
    }
    const Image cut = app::slices(pictures);
    // In the middle row the borders are at a third and two thirds.
    EXPECT_EQ(cut.at<uint8_t>(15, 30)[0], 10);
    EXPECT_EQ(cut.at<uint8_t>(45, 30)[0], 20);
    EXPECT_EQ(cut.at<uint8_t>(75, 30)[0], 30);
    EXPECT_EQ(cut.at<uint8_t>(30, 30)[0], 255);  // the line
    // 30 rows lower a border has moved 30 tan(15 deg) = 8 pixels to the left.
    EXPECT_EQ(cut.at<uint8_t>(25, 59)[0], 20);
    EXPECT_THROW(app::slices({}), ArgumentError);
    EXPECT_THROW(app::slices({pictures[0], Image(2, 2, 4, PixelType::u8)}), ArgumentError);
}

}  // namespace
}  // namespace easypbr::gui::live_view_test

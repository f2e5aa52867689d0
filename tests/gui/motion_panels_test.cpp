// The panels of camera path, recorder and animations, driven by events, without a window.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <chrono>
#include <filesystem>

#include "easypbr/app/recording_target.h"
#include "easypbr/core/error.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/settings/camera_path_io.h"
#include "gui/motion_panels.h"
#include "scene/slide.h"

namespace easypbr::gui::motion_panels_test {
namespace {

namespace fs = std::filesystem;

TEST_F(MotionPanels, KeysArePlacedListedMovedAndRemoved) {
    unfold(Panel::camera_path);
    look_from({0, 1, 5});
    click("Camera path/Add key (K)");
    look_from({5, 1, 0});
    click("Camera path/Add key (K)");
    look_from({0, 1, -5});
    key('K');
    const app::PathEditor& path = view_.drawing().path().editor;
    ASSERT_EQ(path.keys().size(), 3u);
    EXPECT_LT((path.keys()[2].T_world_cam.translation() - Vec3d(0, 1, -5)).norm(), 1e-12);
    settle();
    click("Camera path/up 3");
    EXPECT_LT((path.keys()[1].T_world_cam.translation() - Vec3d(0, 1, -5)).norm(), 1e-12);
    click("Camera path/key 1");
    EXPECT_LT((position() - Vec3d(0, 1, 5)).norm(), 1e-9);
    look_from({0, 3, 4});
    click("Camera path/replace 2");
    EXPECT_LT((path.keys()[1].T_world_cam.translation() - Vec3d(0, 3, 4)).norm(), 1e-12);
    click("Camera path/remove 1");
    EXPECT_EQ(path.keys().size(), 2u);
    click("Camera path/closed");
    EXPECT_TRUE(path.options().closed);
    EXPECT_DOUBLE_EQ(path.path()->duration_s(), 2);
}

// A turn around what is shown takes the place of the keys.
TEST_F(MotionPanels, ATurntableIsAPath) {
    unfold(Panel::camera_path);
    three_keys();
    settle();
    click("Camera path/key 3");
    click("Camera path/Turntable");
    EXPECT_FALSE(view_.drawing().path().key);
    const std::optional<CameraPath>& path = view_.drawing().path().editor.path();
    ASSERT_TRUE(path);
    EXPECT_DOUBLE_EQ(path->duration_s(), 8);
    const Vec3d start = path->pose(0).translation(), opposite = path->pose(4).translation();
    EXPECT_LT((path->pose(8).translation() - start).norm(), 1e-9);
    EXPECT_NEAR(start.y(), opposite.y(), 1e-9);
    const Vec3d middle = view_.drawing().session().scene().snapshot().bounds().center();
    for (const int axis : {0, 2}) EXPECT_NEAR((start[axis] + opposite[axis]) / 2, middle[axis], 1e-6);
    EXPECT_GT((start - opposite).norm(), 1);
}

TEST_F(MotionPanels, TheChosenKeyStaysChosenWhereverItIsMoved) {
    unfold(Panel::camera_path);
    three_keys();
    settle();
    const std::optional<size_t>& chosen = view_.drawing().path().key;
    click("Camera path/key 3");
    click("Camera path/up 3");
    EXPECT_EQ(chosen, 1u);
    click("Camera path/up 3");
    EXPECT_EQ(chosen, 2u);
    click("Camera path/remove 1");
    EXPECT_EQ(chosen, 1u);
    click("Camera path/down 1");
    EXPECT_EQ(chosen, 0u);
    // The next key comes after it.
    look_from({9, 9, 9});
    key('K');
    const app::PathEditor& path = view_.drawing().path().editor;
    ASSERT_EQ(path.keys().size(), 3u);
    EXPECT_LT((path.keys()[1].T_world_cam.translation() - Vec3d(9, 9, 9)).norm(), 1e-12);
    click("Camera path/remove 2");
    EXPECT_FALSE(chosen);
}

TEST_F(MotionPanels, ThePathIsPlayedScrubbedSavedAndLoaded) {
    unfold(Panel::camera_path);
    three_keys();
    settle();
    click("Camera path/time");  // its middle
    EXPECT_NEAR(view_.drawing().path().editor.time(), 1, 0.02);
    const CameraPath before = *view_.drawing().path().editor.path();
    EXPECT_LT((position() - before.pose(view_.drawing().path().editor.time()).translation()).norm(), 1e-9);
    view_.drawing().path().editor.seek(0);
    click("Camera path/Play");
    EXPECT_TRUE(view_.drawing().path().editor.is_playing());
    for (int i = 0; i < 20 && view_.drawing().path().editor.is_playing(); ++i) step({}, 0.25);
    EXPECT_FALSE(view_.drawing().path().editor.is_playing());
    EXPECT_LT((position() - Vec3d(0, 1, -5)).norm(), 1e-9);
    view_.state().path_panel.file = (folder_ / "path.json").string();
    click("Camera path/Save");
    EXPECT_EQ(io::load_camera_path(folder_ / "path.json").keys().size(), 3u);
    click("Camera path/Clear");
    EXPECT_TRUE(view_.drawing().path().editor.keys().empty());
    click("Camera path/Load");
    EXPECT_EQ(view_.drawing().path().editor.path()->pose(0.7).matrix(), before.pose(0.7).matrix());
    view_.state().path_panel.file = (folder_ / "nothing.json").string();
    click("Camera path/Load");
    EXPECT_NE(view_.drawing().notifications().list().back().text.find("nothing.json"), std::string::npos);
    EXPECT_EQ(view_.drawing().path().editor.keys().size(), 3u);
}

// The way there is one change, not one for each frame.
TEST_F(MotionPanels, PlayingIsUndoneAtOnce) {
    three_keys();
    look_from({1, 2, 6});
    settle();
    view_.drawing().path().editor.play();
    for (int i = 0; i < 20; ++i) step({}, 0.25);
    settle();
    EXPECT_FALSE(view_.drawing().path().editor.is_playing());
    EXPECT_LT((position() - Vec3d(0, 1, -5)).norm(), 1e-9);
    view_.drawing().edits().undo();
    EXPECT_LT((position() - Vec3d(1, 2, 6)).norm(), 1e-9);
}

TEST_F(MotionPanels, TheCurveIsDrawnOverThePictureAndFaintBehindSurfaces) {
    view_.state().panels.shown = true;
    three_keys();
    look_from({0, 16, 14});
    view_.state().path_panel.shows_path = false;
    view_.touch();
    settle();
    const Image without = view_.screen();
    view_.state().path_panel.shows_path = true;
    view_.touch();
    settle();
    const Image with = view_.screen();
    // A point of the curve, where the orange is on the screen.
    const CameraPath& path = *view_.drawing().path().editor.path();
    const Camera camera = session_.view_point(size).camera;
    const auto color_at = [&](const Image& image, double time) {
        const Vec3d p = pixel_of(camera, path.pose(time).translation(), size);
        const uint8_t* c = image.at<uint8_t>(int(p.x()), int(p.y()));
        return Vec3d(c[0], c[1], c[2]);
    };
    EXPECT_LT((color_at(with, 0.6) - Vec3d(255, 140, 40)).norm(), 60);
    EXPECT_GT((color_at(without, 0.6) - Vec3d(255, 140, 40)).norm(), 150);
    // With the ball grown around the path the same curve lies behind it.
    session_.scene().get("ball").scale(Vec3d(6.5, 6.5, 6.5));
    settle();
    EXPECT_GT((color_at(view_.screen(), 0.6) - Vec3d(255, 140, 40)).norm(), 60);
}

TEST_F(MotionPanels, RecordsAPictureAndACameraPath) {
    unfold(Panel::recorder);
    three_keys();
    look_from({1, 2, 6});
    settle();
    app::RecordingForm& form = view_.drawing().recording_form();
    form.picture = (folder_ / "picture.png").string();
    form.video = (folder_ / "frame_%02d.png").string();
    form.fps = 4;
    click("Recorder/Picture");
    EXPECT_EQ(io::load_image(form.picture).width(), 48);
    const Vec3d before = position();
    click("Recorder/Camera path");
    for (int i = 0; i < 40 && view_.is_recording(); ++i) step();
    EXPECT_FALSE(view_.is_recording());
    EXPECT_FALSE(recorder_.is_recording());
    EXPECT_LT((position() - before).norm(), 1e-12);
    EXPECT_NE(view_.drawing().report().text.find("9 frames"), std::string::npos)
        << view_.drawing().report().text;
    // Frame 4 of 2 seconds at 4 frames per second is key 2, to the bit.
    look_from({5, 1, 0});
    session_.set_camera(view_.drawing().path().editor.path()->camera(1, session_.camera()));
    const Image still = session_.render({Vec2i(48, 32), {}});
    EXPECT_TRUE(std::ranges::equal(io::load_image(folder_ / "frame_04.png").bytes(),
                                   with_channels(still, 3).bytes()) ||
                std::ranges::equal(io::load_image(folder_ / "frame_04.png").bytes(), still.bytes()));
    EXPECT_FALSE(fs::exists(folder_ / "frame_09.png"));
}

TEST_F(MotionPanels, WhatWasRecordedBeforeStays) {
    unfold(Panel::recorder);
    settle();
    app::RecordingForm& form = view_.drawing().recording_form();
    form.picture = (folder_ / "picture.png").string();
    form.video = (folder_ / "frame_%02d.png").string();
    form.size = {32, 24};
    for (const char* file : {"picture.png", "picture_2.png", "picture_3.png"}) {
        click("Recorder/Picture");
        EXPECT_EQ(view_.drawing().report().text, "Wrote " + (folder_ / file).string());
        EXPECT_TRUE(fs::exists(folder_ / file));
    }
    for (const char* name : {"frame_%02d.png", "frame_%02d_2.png"}) {
        click("Recorder/Video");
        ASSERT_TRUE(view_.is_recording());
        settle();
        click("Recorder/Stop");
        EXPECT_TRUE(view_.drawing().report().text.starts_with("Wrote " + (folder_ / name).string() + ": "))
            << view_.drawing().report().text;
    }
    EXPECT_TRUE(fs::exists(folder_ / "frame_00_2.png"));
    EXPECT_EQ(form.picture, (folder_ / "picture.png").string());
    for (const char* name : {"", "/", "//"}) {
        EXPECT_EQ(app::free_picture(name), name);
        EXPECT_EQ(app::free_recording(name), name);
    }
    EXPECT_EQ(app::free_recording(folder_ / "film.mp4"), folder_ / "film.mp4");
    io::save_image(Image(1, 1, 3, PixelType::u8), folder_ / "film.png");
    fs::rename(folder_ / "film.png", folder_ / "film.mp4");
    EXPECT_EQ(app::free_recording(folder_ / "film.mp4"), folder_ / "film_2.mp4");
    fs::create_directory(folder_ / "out");
    EXPECT_EQ(app::free_recording(folder_ / "out" / ""), folder_ / "out" / "");
    io::save_image(Image(1, 1, 3, PixelType::u8), folder_ / "out" / "frame_00000.png");
    EXPECT_EQ(app::free_recording(folder_ / "out" / ""), folder_ / "out_2" / "");
    EXPECT_EQ(app::free_recording(folder_ / "out"), folder_ / "out_2");
}

TEST_F(MotionPanels, RecordsTheWindowWithItsPanelsAndWithoutBackground) {
    unfold(Panel::recorder);
    settle();
    app::RecordingForm& form = view_.drawing().recording_form();
    form.picture = (folder_ / "clear.png").string();
    click("Recorder/transparent");
    EXPECT_TRUE(form.transparent);
    click("Recorder/Picture");
    const Image clear = io::load_image(form.picture);
    EXPECT_EQ(clear.at<uint8_t>(0, 0)[3], 0);
    EXPECT_EQ(clear.at<uint8_t>(24, 16)[3], 255);
    EXPECT_NE(session_.settings().background.mode, BackgroundMode::transparent);
    click("Recorder/with panels");
    form.picture = (folder_ / "screen.png").string();
    click("Recorder/Picture");
    EXPECT_EQ(io::load_image(form.picture).width(), size.x());
}

TEST_F(MotionPanels, AVideoOfWhatHappensIsAsLongAsItTook) {
    unfold(Panel::recorder);
    view_.drawing().recording_form().video = (folder_ / "live_%03d.png").string();
    view_.drawing().recording_form().size = {32, 24};
    const auto begun = std::chrono::steady_clock::now();
    click("Recorder/Video");
    ASSERT_TRUE(view_.is_recording());
    while (std::chrono::steady_clock::now() < begun + std::chrono::milliseconds(700)) step();
    settle();
    click("Recorder/Stop");
    const double passed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    EXPECT_FALSE(recorder_.is_recording());
    int frames = 0;
    while (fs::exists(folder_ / fmt::format("live_{:03}.png", frames))) ++frames;
    EXPECT_GE(frames, 15);
    EXPECT_LE(frames, passed * 30 + 2);
}

TEST_F(MotionPanels, WhatCannotBeRecordedIsTold) {
    unfold(Panel::recorder);
    three_keys();
    settle();
    view_.drawing().recording_form().video = (folder_ / "film.xyz").string();
    click("Recorder/Camera path");
    EXPECT_FALSE(view_.is_recording());
    EXPECT_TRUE(view_.drawing().report().failed);
    EXPECT_NE(view_.drawing().report().text.find("film.xyz"), std::string::npos);
    view_.drawing().recording_form().video = "/nowhere/at/all/film_%d.png";
    click("Recorder/Video");
    EXPECT_TRUE(view_.drawing().report().failed);
    view_.drawing().recording_form().picture = "/nowhere/at/all.png";
    click("Recorder/Picture");
    EXPECT_TRUE(view_.drawing().report().failed);
    view_.drawing().recording_form().video = (folder_ / "stopped_%02d.png").string();
    click("Recorder/Camera path");
    ASSERT_TRUE(view_.is_recording());
    const Vec3d before(0, 1, -5);
    view_.stop_recording();
    EXPECT_LT((position() - before).norm(), 1e-12);
    EXPECT_TRUE(fs::exists(folder_ / "stopped_00.png"));
}

TEST_F(MotionPanels, ARecordingThatFailsEndsAndLeavesAWholeFile) {
    unfold(Panel::recorder);
    settle();
    app::RecordingForm& form = view_.drawing().recording_form();
    form.video = (folder_ / "panels_%03d.png").string();
    form.panels = true;
    view_.drawing().wishes().recording = app::LiveWishes::Recording::video;
    step();
    ASSERT_TRUE(view_.is_recording()) << view_.drawing().report().text;
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (view_.is_recording() && std::chrono::steady_clock::now() < patience)
        view_.update({}, size + Vec2i(20, 0), 1, 0.05);
    EXPECT_FALSE(view_.is_recording());
    EXPECT_FALSE(recorder_.is_recording());
    EXPECT_TRUE(view_.drawing().report().failed);
    EXPECT_NE(view_.drawing().report().text.find("resized"), std::string::npos)
        << view_.drawing().report().text;
    EXPECT_TRUE(fs::exists(folder_ / "panels_000.png"));
    // What cannot be drawn ends one too, and another one can begin.
    form = {.video = (folder_ / "empty_%03d.png").string(), .size = {32, 24}};
    for (int i = 0; i < 2; ++i) {
        view_.drawing().wishes().recording = app::LiveWishes::Recording::video;
        step();
        ASSERT_TRUE(view_.is_recording()) << view_.drawing().report().text;
        session_.settings().background.mode = BackgroundMode::image;
        while (view_.is_recording() && std::chrono::steady_clock::now() < patience) step();
        EXPECT_FALSE(recorder_.is_recording());
        EXPECT_TRUE(view_.drawing().report().failed);
        session_.settings().background.mode = BackgroundMode::color;
    }
}

TEST_F(MotionPanels, AnimationsPlayPauseAndScrub) {
    AnimationNode node;
    node.mesh = session_.scene().get("ball");
    player_.add("ball", Animations({{node}, {}, {}, {slide("slide"), slide("other")}}));
    clock_.set_fixed_step(0.5);
    clock_.tick();  // the first frame, at 0
    clock_.on_tick = [this] { player_.update(); };
    const auto x = [&] { return session_.scene().get("ball").T_parent_mesh().translation().x(); };
    unfold(Panel::animations);
    click("Animations/Play");
    clock_.tick();
    EXPECT_NEAR(x(), 0.25, 1e-12);
    settle();
    click("Animations/Pause");
    clock_.tick();
    EXPECT_NEAR(x(), 0.25, 1e-12);
    click("Animations/time");
    EXPECT_NEAR(x(), 1, 0.03);
    click("Animations/loop");
    EXPECT_FALSE(player_.loops());
    click("Animations/which");
    settle();
    click("Animations/ball: other");
    EXPECT_EQ(player_.current(), 1u);
    EXPECT_TRUE(player_.is_playing());
}

// What is typed stays within the slider's range, -2 to 4.
TEST_F(MotionPanels, ASpeedThatIsTypedStaysInItsRange) {
    AnimationNode node;
    node.mesh = session_.scene().get("ball");
    player_.add("ball", Animations({{node}, {}, {}, {slide("slide")}}));
    unfold(Panel::animations);
    const auto type = [&](const std::string& text) {
        InputEvent event;
        event.kind = Kind::key_down;
        event.key = app::key::left_control;
        event.control = true;
        step({event});
        click("Animations/speed", true);
        event.kind = Kind::key_up;
        event.control = false;
        step({event});
        for (const char letter : text) {
            event.kind = Kind::text;
            event.code = uint32_t(letter);
            step({event});
        }
        for (const Kind kind : {Kind::key_down, Kind::key_up}) {
            event.kind = kind;
            event.key = app::key::enter;
            step({event});
        }
        settle();
        return player_.speed();
    };
    EXPECT_EQ(type("0.5"), 0.5);
    EXPECT_EQ(type("1e38"), 4);
    EXPECT_EQ(type("-1e38"), -2);
}

// Frames of 48 x 32 in a window of 560 x 620: 560 x 373, with bars of 123 above and below.
TEST_F(MotionPanels, ARecordedPathKeepsItsShapeInTheWindow) {
    view_.state().panels.shown = false;
    session_.settings().background.mode = BackgroundMode::color;
    session_.settings().background.color = Vec3(0, 1, 0);
    three_keys();
    settle();
    const auto green_rows = [&] {
        const Image screen = view_.screen();
        int first = -1, count = 0;
        for (int y = 0; y < screen.height(); ++y)
            if (screen.at<uint8_t>(2, y)[1] > 100) {
                if (first < 0) first = y;
                ++count;
            }
        return std::pair(first, count);
    };
    EXPECT_EQ(green_rows(), std::pair(0, size.y()));
    view_.drawing().recording_form().video = (folder_ / "f_%03d.png").string();
    view_.drawing().wishes().recording = app::LiveWishes::Recording::path;
    step();
    step();
    step();
    ASSERT_TRUE(view_.is_recording());
    const auto [first, count] = green_rows();
    EXPECT_NEAR(first, (620 - 373.3) / 2, 1);
    EXPECT_NEAR(count, 373.3, 2);
    EXPECT_EQ(int(view_.screen().at<uint8_t>(280, 20)[1]), 0);
    view_.stop_recording();
    settle();
    EXPECT_EQ(green_rows(), std::pair(0, size.y()));
}

}  // namespace
}  // namespace easypbr::gui::motion_panels_test

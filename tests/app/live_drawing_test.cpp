// A session that a person looks at, driven by events, without panels and without a window.
#include "easypbr/app/live_drawing.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>

#include "easypbr/core/error.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app::live_drawing_test {
namespace {

using Kind = InputEvent::Kind;

const Vec2i size(120, 80);
const Vec2d middle(60, 40);

InputEvent at(Kind kind, Vec2d position) {
    InputEvent event;
    event.kind = kind;
    event.position = position;
    return event;
}

InputEvent key(int code, bool control = false) {
    InputEvent event;
    event.kind = Kind::key_down;
    event.key = code;
    event.control = control;
    return event;
}

bool same(const Image& a, const Image& b) {
    return std::ranges::equal(a.bytes(), b.bytes());
}

class LiveDrawingTest : public testing::Test {
  protected:
    LiveDrawingTest() : session_(ball_scene()) { session_.settings().image.samples = 6; }

    static Scene ball_scene() {
        Scene scene;
        scene.show(make_sphere(1, 16), "ball");
        return scene;
    }
    bool step(const std::vector<InputEvent>& events = {}) { return live_.update(events, size, 0.02); }
    void settle() {
        for (int i = 0; i < 100 && (step() || live_.is_busy()); ++i) continue;
        EXPECT_FALSE(live_.is_busy());
    }
    void drag(Vec2d from, Vec2d to) {
        step({at(Kind::move, from)});
        step({at(Kind::press, from)});
        step({at(Kind::move, to)});
        step({at(Kind::release, to)});
    }
    Vec3d camera_position() { return session_.view_point(size).camera.position(); }
    Image still() { return session_.render({size, session_.settings().image.samples}); }

    Session session_;
    LiveDrawing live_{session_};
};

TEST_F(LiveDrawingTest, EndsAtTheStillBitForBitAndThenDrawsNothing) {
    EXPECT_THROW(live_.picture().image(), ArgumentError);
    EXPECT_TRUE(step());
    EXPECT_EQ(live_.picture().statistics().frames, 1);
    settle();
    EXPECT_EQ(live_.picture().statistics().frames, 6);
    EXPECT_FALSE(step());
    const Image shown = live_.picture().image();
    EXPECT_TRUE(same(shown, still()));
}

TEST_F(LiveDrawingTest, ADragTurnsTheCameraAndUndoTurnsItBack) {
    settle();
    const Vec3d before = camera_position();
    drag(middle, middle + Vec2d(30, 0));
    settle();
    const Vec3d after = camera_position();
    EXPECT_GT((after - before).norm(), 0.5);
    EXPECT_TRUE(same(live_.picture().image(), still()));
    step({key('Z', true)});
    EXPECT_LT((camera_position() - before).norm(), 1e-9);
    step({key('Y', true)});
    EXPECT_LT((camera_position() - after).norm(), 1e-9);
}

TEST_F(LiveDrawingTest, AClickSelectsAndThePointerFindsWhatItIsOn) {
    settle();
    step({at(Kind::move, middle)});
    settle();
    ASSERT_TRUE(live_.picture().hovered());
    EXPECT_EQ(live_.picture().hovered()->object, "ball");
    step({at(Kind::press, middle), at(Kind::release, middle)});
    EXPECT_EQ(live_.selection().object, "ball");
    step({at(Kind::move, {2, 2})});
    step({at(Kind::press, {2, 2}), at(Kind::release, {2, 2})});
    EXPECT_EQ(live_.selection().object, "");
    // A panel of a client lies over the ball: nothing is hovered there, and the camera stays.
    step({at(Kind::move, middle)});
    settle();
    live_.begin_frame(size, 0.02);
    live_.leave(at(Kind::move, middle + Vec2d(1, 0)));
    EXPECT_FALSE(live_.picture().hovered());
}

// Whoever records the screen while a button is held waits for a picture that is complete.
TEST_F(LiveDrawingTest, IsDrawnToItsEndWhileSomethingMoves) {
    settle();
    step({at(Kind::press, middle)});
    step({at(Kind::move, middle + Vec2d(20, 5))});
    ASSERT_TRUE(live_.is_busy());
    EXPECT_FALSE(live_.picture().is_complete());
    live_.draw_finished({.moving = true});
    EXPECT_TRUE(live_.picture().is_complete());
    EXPECT_TRUE(same(live_.picture().image(), still()));
}

TEST_F(LiveDrawingTest, WhatCannotBeDrawnIsToldOnceAndLeavesThePicture) {
    settle();
    const Image before = live_.picture().image();
    session_.settings().background.mode = BackgroundMode::image;
    for (int i = 0; i < 4; ++i) step();
    ASSERT_EQ(live_.notifications().list().size(), 1u);
    EXPECT_NE(live_.notifications().list()[0].text.find("background.image"), std::string::npos);
    EXPECT_TRUE(live_.picture().has_failed());
    EXPECT_TRUE(same(live_.picture().image(), before));
    session_.settings().background.mode = BackgroundMode::color;
    settle();
    EXPECT_FALSE(live_.picture().has_failed());
    EXPECT_TRUE(same(live_.picture().image(), still()));
}

// A client without panels has no screen of its own to record: the form's wish for it is none.
TEST_F(LiveDrawingTest, RecordsACameraPathAndShowsItsFrames) {
    namespace fs = std::filesystem;
    const fs::path folder =
        fs::temp_directory_path() / ("easypbr_live_drawing_" + std::to_string(::getpid()));
    fs::create_directories(folder);
    for (const Vec3d& place : {Vec3d(0, 1, 5), Vec3d(5, 1, 0)}) {
        session_.set_view_point({Camera::look_at(place, Vec3d(0, 0, 0)), Vec3d(0, 0, 0)});
        step({key('K')});
    }
    ASSERT_EQ(live_.path().editor.keys().size(), 2u);
    settle();
    live_.recording_form() = {.video = (folder / "f_%02d.png").string(), .size = {48, 32}, .fps = 4};
    live_.recording_form().panels = true;
    live_.wishes().recording = LiveWishes::Recording::path;
    bool showed = false;
    step();
    ASSERT_TRUE(live_.recording().is_running()) << live_.report().text;
    for (int i = 0; i < 40 && live_.recording().is_running(); ++i) {
        step();
        showed |= live_.picture().shows_other() && live_.picture().image().width() == 48;
    }
    EXPECT_TRUE(showed);
    EXPECT_FALSE(live_.report().failed) << live_.report().text;
    EXPECT_EQ(io::load_image(folder / "f_04.png").width(), 48);
    EXPECT_FALSE(fs::exists(folder / "f_05.png"));
    settle();
    EXPECT_FALSE(live_.picture().shows_other());
    EXPECT_TRUE(same(live_.picture().image(), still()));
    fs::remove_all(folder);
}

}  // namespace
}  // namespace easypbr::app::live_drawing_test

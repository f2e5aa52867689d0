// A session that a person looks at, driven by events, without panels and without a window.
#include "easypbr/app/live_drawing.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>

#include "easypbr/app/vertex_edits.h"
#include "easypbr/core/error.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/gl/context.h"
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

TEST_F(LiveDrawingTest, NeedsNoDriverWhereTheCpuDraws) {
    Session native(ball_scene());
    native.use_device(DrawDevice::cpu);
    native.settings().image.samples = 6;
    LiveDrawing live(native);
    const gl::ContextScope scope(native.context());
    const auto settle_at = [&](Vec2d pointer) {
        live.update({at(Kind::move, pointer)}, size, 0.02);
        for (int i = 0; i < 100 && (live.update({}, size, 0.02) || live.is_busy()); ++i) continue;
    };
    settle_at(middle);
    EXPECT_TRUE(same(live.picture().image(), native.render({size, 6})));
    ASSERT_TRUE(live.picture().hovered());
    EXPECT_EQ(live.picture().hovered()->object, "ball");
    EXPECT_FALSE(gl::Context::has_driver());
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

TEST_F(LiveDrawingTest, UndoTakesBackWhatCannotBeDrawnAndNothingElse) {
    settle();
    Settings& settings = session_.settings();
    EXPECT_FALSE(live_.edits().can_undo());
    const BackgroundMode mode = settings.background.mode;
    settings.background.mode = BackgroundMode::image;
    step();
    EXPECT_TRUE(live_.edits().can_undo());
    step({key('Z', true)});
    EXPECT_EQ(settings.background.mode, mode);
    settings.tonemap.exposure = 3;
    settle();
    settings.background.mode = BackgroundMode::image;
    for (int i = 0; i < 4; ++i) step();
    ASSERT_TRUE(live_.picture().has_failed());
    step({key('Z', true)});
    EXPECT_EQ(settings.background.mode, mode);
    EXPECT_TRUE(settings.tonemap.exposure.is_pinned());
    settle();
    EXPECT_FALSE(live_.picture().has_failed());
    EXPECT_TRUE(same(live_.picture().image(), still()));
    step({key('Y', true)});
    EXPECT_EQ(settings.background.mode, BackgroundMode::image);
    step({key('Z', true)});
    EXPECT_EQ(settings.background.mode, mode);
    step({key('Z', true)});
    EXPECT_FALSE(settings.tonemap.exposure.is_pinned());
}

TEST_F(LiveDrawingTest, UndoLeavesWhatAProgramHasSet) {
    settle();
    Settings& settings = session_.settings();
    settings.background.color = {1, 0, 0};
    settle();
    live_.edits().change_settings([](Settings& all) { all.tonemap.exposure = 4; });
    settle();
    step({key('Z', true)});
    EXPECT_NE(settings.background.color, Vec3(1, 0, 0));
    EXPECT_TRUE(settings.tonemap.exposure.is_pinned());
    EXPECT_FALSE(live_.edits().can_undo());
    step({key('Y', true)});
    EXPECT_EQ(settings.background.color, Vec3(1, 0, 0));
    EXPECT_TRUE(settings.tonemap.exposure.is_pinned());
}

TEST_F(LiveDrawingTest, WhatAHandlerOfTheProgramSetsIsTheProgramsToo) {
    settle();
    Settings& settings = session_.settings();
    live_.handlers().add([&](const InputEvent& event) {
        if (event.kind == Kind::key_down && event.key == 'P') settings.tonemap.exposure = 4;
        return false;
    });
    step({key('P')});
    settle();
    ASSERT_TRUE(settings.tonemap.exposure.is_pinned());
    EXPECT_FALSE(live_.edits().can_undo());
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

/// Flat splats side by side along x at -2, -1, 0, 1, 2, each a quarter wide, their opacities from 0.95 down.
Mesh five_splats() {
    MeshData mesh;
    Array3f::Dense V = Array3f::Dense::Zero(5, 3);
    Array4f::Dense rotations = Array4f::Dense::Zero(5, 4);
    Array1f::Dense opacities(5);
    for (int i = 0; i < 5; ++i) {
        V(i, 0) = float(i - 2);
        rotations(i, 0) = 1;
        opacities(i) = 0.95f - 0.05f * float(i);
    }
    mesh.V = std::move(V);
    mesh.splats = {Array3f::Dense::Constant(5, 3, 0.25f), std::move(rotations), std::move(opacities),
                   ArrayXf::Dense::Zero(5, 3)};
    return Mesh(std::move(mesh));
}

class VertexEditsTest : public testing::Test {
  protected:
    VertexEditsTest() : session_(scene()), live_(session_) {
        session_.settings().image.samples = 1;
        session_.settings().camera.position = Vec3d(0, 0, 10);
        session_.settings().camera.target = Vec3d(0, 0, 0);
        live_.update({}, size, 0.02);
    }
    static Scene scene() {
        Scene scene;
        scene.show(five_splats(), "five");
        return scene;
    }
    std::vector<float> xs() const {
        const auto data = session_.scene().get("five").snapshot();
        EXPECT_EQ(data->splats.scales.rows(), data->V.rows());
        std::vector<float> xs;
        for (Eigen::Index i = 0; i < data->V.rows(); ++i) xs.push_back(data->V(i, 0));
        return xs;
    }
    /// As after a frame.
    void note() { live_.update({}, size, 0.02); }
    void click_middle() {
        live_.update({at(Kind::move, middle), at(Kind::press, middle), at(Kind::release, middle)}, size,
                     0.02);
    }

    Session session_;
    LiveDrawing live_;
};

using Xs = std::vector<float>;

TEST_F(VertexEditsTest, RemovesWhatWasClickedAndGivesItBack) {
    click_middle();
    ASSERT_EQ(live_.selection().object, "five");
    ASSERT_TRUE(live_.selection().picked && !live_.selection().picked->is_face);
    EXPECT_EQ(live_.selection().picked->element, 2);
    remove_vertices(live_, {VertexFilter::Shape::picked});
    note();
    EXPECT_EQ(xs(), Xs({-2, -1, 1, 2}));
    EXPECT_FALSE(live_.selection().picked);
    EXPECT_THROW(remove_vertices(live_, {VertexFilter::Shape::picked}), ArgumentError);
    remove_vertices(live_, {VertexFilter::Shape::faint, false, 0, 0.78});  // the last one has 0.75
    note();
    EXPECT_EQ(xs(), Xs({-2, -1, 1}));
    live_.update({key('Z', true)}, size, 0.02);
    EXPECT_EQ(xs(), Xs({-2, -1, 1, 2}));
    live_.update({key('Z', true)}, size, 0.02);
    EXPECT_EQ(xs(), Xs({-2, -1, 0, 1, 2}));
    live_.update({key('Y', true)}, size, 0.02);
    EXPECT_EQ(xs(), Xs({-2, -1, 1, 2}));
}

TEST_F(VertexEditsTest, RemovesByBallAndBox) {
    click_middle();
    remove_vertices(live_, {VertexFilter::Shape::ball, true, 1.5});
    note();
    EXPECT_EQ(xs(), Xs({-1, 0, 1}));
    // The box is in the world: the object has been moved by one.
    Mesh node = session_.scene().get("five");
    node.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(1, 0, 0)));
    EXPECT_THROW(remove_vertices(live_, {VertexFilter::Shape::clip_box}), ArgumentError);
    session_.settings().clip.box = {0.5, -1, -1, 3, 1, 1};
    remove_vertices(live_, {VertexFilter::Shape::clip_box, false});
    note();
    EXPECT_EQ(xs(), Xs({-1}));
    // Nothing would stay: nothing happens.
    EXPECT_THROW(remove_vertices(live_, {VertexFilter::Shape::faint, false, 0, 1}), ArgumentError);
    EXPECT_EQ(xs(), Xs({-1}));
    // Looks that are changed afterwards stay when the removal is undone.
    live_.edits().change_look("five", "style.visible", {false});
    note();
    live_.edits().undo();
    live_.edits().undo();
    EXPECT_EQ(xs(), Xs({-1, 0, 1}));
    EXPECT_EQ(session_.scene().get("five").T_parent_mesh().translation().x(), 1);
}

TEST_F(VertexEditsTest, LeavesWhatAProgramHasShownSince) {
    live_.selection() = {"five", "", {}};
    remove_vertices(live_, {VertexFilter::Shape::faint, false, 0, 0.93});
    note();
    EXPECT_EQ(xs(), Xs({-2}));
    Mesh other = five_splats();
    other.edit([](MeshData& data) {
        Array3f::Dense V = data.V;
        V.col(0).array() += 10;
        data.V = std::move(V);
    });
    session_.scene().show(other, "five");
    note();
    live_.edits().undo();
    EXPECT_EQ(xs(), Xs({8, 9, 10, 11, 12}));
}

// What cannot be undone as the program has changed the object is not undone by half, and can be later.
TEST_F(VertexEditsTest, UndoThatFailsChangesNothing) {
    Mesh five = session_.scene().get("five");
    five.edit([](MeshData& data) {
        Array1i::Dense labels(5, 1);
        for (int i = 0; i < 5; ++i) labels(i) = i;
        data.L = std::move(labels);
    });
    note();
    live_.selection() = {"five", "", {}};
    remove_vertices(live_, {VertexFilter::Shape::faint, false, 0, 0.78});  // the last one has 0.75
    note();
    const Xs left({-2, -1, 0, 1});
    ASSERT_EQ(xs(), left);
    five.set_label_map(LabelMap::generated({"a", "b", "c", "d"}));
    note();
    EXPECT_THROW(live_.edits().undo(), ArgumentError) << "the map has no label 4";
    EXPECT_EQ(xs(), left);
    EXPECT_FALSE(live_.edits().can_redo());
    five.set_label_map(std::shared_ptr<const LabelMap>());
    live_.edits().undo();
    EXPECT_EQ(xs(), Xs({-2, -1, 0, 1, 2}));
    EXPECT_TRUE(live_.edits().can_redo());
}

TEST_F(VertexEditsTest, ForgetsWhatWasBeforeOtherDataThatAreChangedToo) {
    live_.selection() = {"five", "", {}};
    remove_vertices(live_, {VertexFilter::Shape::faint, false, 0, 0.93});
    note();
    Mesh other = five_splats();
    other.edit([](MeshData& data) {
        Array3f::Dense V = data.V;
        V.col(0).array() += 10;
        data.V = std::move(V);
    });
    session_.scene().show(other, "five");
    note();
    remove_vertices(live_, {VertexFilter::Shape::faint, false, 0, 0.93});
    note();
    ASSERT_EQ(xs(), Xs({8}));
    live_.edits().undo();
    EXPECT_EQ(xs(), Xs({8, 9, 10, 11, 12}));
    live_.edits().undo();
    EXPECT_EQ(xs(), Xs({8, 9, 10, 11, 12}));
}

TEST_F(VertexEditsTest, IsForCloudsAndSplatsAlone) {
    session_.scene().show(make_sphere(1, 8), "ball");
    note();
    live_.selection() = {"ball", "", {}};
    EXPECT_FALSE(has_loose_vertices(*session_.scene().get("ball").snapshot()));
    EXPECT_THROW(remove_vertices(live_, {VertexFilter::Shape::faint}), ArgumentError);
    live_.selection() = {};
    EXPECT_THROW(remove_vertices(live_, {VertexFilter::Shape::faint}), ArgumentError);
}

}  // namespace
}  // namespace easypbr::app::live_drawing_test

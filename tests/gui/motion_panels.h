// The live view with panels of motion, driven by events, without a window.
#pragma once

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "easypbr/geometry/primitives.h"
#include "easypbr/gui/live_view.h"
#include "easypbr/scene/settings.h"

namespace easypbr::gui {

class MotionPanels : public testing::Test {
  protected:
    using InputEvent = app::InputEvent;
    using Kind = InputEvent::Kind;

    MotionPanels()
        : session_(ball_scene()),
          recorder_(session_, clock_),
          player_(clock_),
          view_(session_, recorder_, player_) {
        folder_ =
            std::filesystem::temp_directory_path() / ("easypbr_motion_panels_" + std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
        session_.settings().image.samples = 2;
        session_.settings().image.size = {48, 32};
        for (const Panel panel : {Panel::scene, Panel::object, Panel::effects, Panel::lights,
                                  Panel::environment, Panel::camera, Panel::channels, Panel::statistics})
            view_.state().panels.is_open(panel) = false;
    }
    ~MotionPanels() override { std::filesystem::remove_all(folder_); }

    static Scene ball_scene() {
        Scene scene;
        scene.show(make_sphere(1, 32), "ball");
        return scene;
    }
    void step(const std::vector<InputEvent>& events = {}, double seconds = 0.05) {
        view_.update(events, size, 1, seconds);
    }
    void settle() {
        for (int i = 0; i < 100 && (view_.is_busy() || i < 3); ++i) step();
    }
    void unfold(Panel panel) {
        view_.state().panels.unfold.insert(panel);
        view_.touch();
        settle();
    }
    void key(int code) {
        InputEvent event;
        event.kind = Kind::key_down;
        event.key = code;
        step({event});
    }
    void click(const std::string& name, bool control = false) {
        const auto place = view_.places().find(name);
        ASSERT_NE(place, view_.places().end()) << name;
        InputEvent event;
        event.control = control;
        event.position = place->second.center();
        for (const Kind kind : {Kind::move, Kind::press, Kind::release}) {
            event.kind = kind;
            step({event});
        }
        step();
        event.kind = Kind::move;
        event.position = {540, 610};
        step({event});
    }
    void look_from(const Vec3d& position) {
        session_.set_view_point({Camera::look_at(position, Vec3d(0, 0, 0)), Vec3d(0, 0, 0)});
    }
    Vec3d position() { return session_.view_point(size).camera.position(); }
    void three_keys() {
        for (const Vec3d& place : {Vec3d(0, 1, 5), Vec3d(5, 1, 0), Vec3d(0, 1, -5)}) {
            look_from(place);
            key('K');
        }
    }

    inline static const Vec2i size{560, 620};

    app::Session session_;
    app::Clock clock_;
    app::Recorder recorder_;
    app::AnimationPlayer player_;
    LiveView view_;
    std::filesystem::path folder_;
};

}  // namespace easypbr::gui

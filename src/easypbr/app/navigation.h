// Navigation: input events move a session's camera; clicks are reported.
#pragma once

#include <optional>

#include "easypbr/app/camera_control.h"
#include "easypbr/app/live_picture.h"

namespace easypbr::app {

class Navigation {
  public:
    /// Both must outlive it. Surfaces of the picture say what is zoomed to and turned about.
    Navigation(Session& session, LivePicture& picture) : session_(session), picture_(picture) {}

    /// Moves the camera for an event, as CameraControl says; with an empty scene only where a pose is set.
    /// Returns the pixel of a click: a left button that came up where it went down. Throws as
    /// Session::view_point() and pick_buffer().
    std::optional<Vec2d> handle(const InputEvent& event, Vec2i size);
    /// The pointer has moved to another pixel: what is zoomed to is looked up anew.
    void point_elsewhere() { zoom_about_.reset(); }

    /// Flies on for `seconds` while keys are held, and fits when that was asked for.
    void advance(double seconds, Vec2i size);
    /// Has the next advance() show all there is from the same direction.
    void ask_fit() { fit_ = true; }

    /// A button is held or a key flies.
    bool is_active() const { return control_.is_moving(); }
    /// The same, and the camera has moved by it.
    bool is_moving() const { return control_.is_moving() && control_.has_dragged(); }

  private:
    void zoom(Vec2d pixel, double factor, Vec2i size);
    void fit(Vec2i size);

    Session& session_;
    LivePicture& picture_;
    CameraControl control_;
    Vec2d pressed_{0, 0};
    std::optional<Vec3d> zoom_about_;  ///< while the pointer rests
    bool fit_ = false;
};

}  // namespace easypbr::app

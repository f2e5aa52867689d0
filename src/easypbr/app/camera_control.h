// CameraControl: from mouse and keyboard to a camera that moves. Knows no window and no scene.
#pragma once

#include <optional>
#include <set>

#include "easypbr/app/input.h"
#include "easypbr/app/view_point.h"

namespace easypbr::app {

/// Left drag orbits, right or middle drag pans (left with shift too), the wheel zooms to the pointer, a
/// double click asks for focus, W A S D and Q E fly (with shift four times as fast), F asks for a fit.
class CameraControl {
  public:
    /// What was asked for beyond moving the camera; the caller knows the scene.
    struct Wish {
        bool fit = false;
        std::optional<Vec2d> focus;  ///< a pixel
        std::optional<Vec2d> zoom;   ///< a pixel to zoom to, by zoom_factor
        double zoom_factor = 1;
    };

    /// Moves the view for an event. Returns what it leaves to the caller.
    Wish handle(const InputEvent& event, ViewPoint& view, Vec2i size, const Vec3d& up);

    /// Flies on for `seconds` while keys are held. Returns whether the view moved.
    bool advance(double seconds, ViewPoint& view);

    /// A button is held or a key flies: pictures should come quickly.
    bool is_moving() const { return dragging_ || flies(); }
    /// A drag has moved the camera since its button went down.
    bool has_dragged() const { return has_dragged_; }

    /// Forgets held buttons and keys.
    void release();

  private:
    bool flies() const;
    void drag(const InputEvent& event, ViewPoint& view, Vec2i size, const Vec3d& up);
    void press(const InputEvent& event, Wish& wish);

    enum class Drag { orbit, pan };
    std::optional<Drag> dragging_;
    MouseButton button_ = MouseButton::left;
    bool has_dragged_ = false;
    Vec2d last_{0, 0}, pressed_{0, 0};
    double last_press_ = -1e9;
    std::set<int> keys_;
    bool fast_ = false;
};

}  // namespace easypbr::app

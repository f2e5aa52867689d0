#include "easypbr/app/camera_control.h"

#include <cmath>

namespace easypbr::app {
namespace {

constexpr double degrees_per_height = 200;  ///< of a drag over the picture's height
constexpr double zoom_per_notch = 0.88;
constexpr double double_click_seconds = 0.35, click_radius = 5;  // pixels
constexpr double distances_per_second = 0.8;                     // flown, of the target's distance

}  // namespace

CameraControl::Wish CameraControl::handle(const InputEvent& event, ViewPoint& view, Vec2i size,
                                          const Vec3d& up) {
    using Kind = InputEvent::Kind;
    Wish wish;
    fast_ = event.shift;
    switch (event.kind) {
        case Kind::move:
            if (dragging_) drag(event, view, size, up);
            last_ = event.position;
            break;
        case Kind::press:
            press(event, wish);
            break;
        case Kind::release:
            if (event.button == button_) dragging_.reset();
            break;
        case Kind::scroll:
            wish.zoom = event.position;
            wish.zoom_factor = std::pow(zoom_per_notch, event.scroll.y());
            break;
        case Kind::key_down:
            if (event.control || event.alt) break;
            if (event.key == 'F' && !event.repeat) wish.fit = true;
            keys_.insert(event.key);
            break;
        case Kind::key_up:
            keys_.erase(event.key);
            break;
        case Kind::focus_lost:
            release();
            break;
        default:
            break;
    }
    return wish;
}

void CameraControl::press(const InputEvent& event, Wish& wish) {
    if (dragging_) return;
    const bool left = event.button == MouseButton::left;
    const bool again = left && event.time - last_press_ < double_click_seconds &&
                       (event.position - pressed_).norm() < click_radius;
    if (again) wish.focus = event.position;
    last_press_ = left && !again ? event.time : -1e9;
    pressed_ = last_ = event.position;
    button_ = event.button;
    dragging_ = left && !event.shift ? Drag::orbit : Drag::pan;
    has_dragged_ = false;
}

void CameraControl::drag(const InputEvent& event, ViewPoint& view, Vec2i size, const Vec3d& up) {
    const Vec2d by = event.position - last_;
    // A click that trembles moves nothing.
    if (!has_dragged_ && (event.position - pressed_).norm() < 2) return;
    has_dragged_ = true;
    if (*dragging_ == Drag::pan)
        view = panned(view, by, size);
    else
        view = orbited(view, up, -by.x() / size.y() * degrees_per_height,
                       by.y() / size.y() * degrees_per_height);
}

bool CameraControl::flies() const {
    for (const char code : {'W', 'A', 'S', 'D', 'Q', 'E'})
        if (keys_.contains(code)) return true;
    return false;
}

bool CameraControl::advance(double seconds, ViewPoint& view) {
    if (!flies()) return false;
    const auto axis = [&](int forward, int backward) {
        return double(keys_.contains(forward)) - double(keys_.contains(backward));
    };
    const Vec3d direction(axis('D', 'A'), axis('E', 'Q'), axis('W', 'S'));
    const double speed = distances_per_second * (fast_ ? 4 : 1) * view.distance();
    view = flown(view, direction * (speed * seconds));
    return !direction.isZero();
}

void CameraControl::release() {
    dragging_.reset();
    keys_.clear();
    fast_ = false;
}

}  // namespace easypbr::app

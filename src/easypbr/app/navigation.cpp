#include "easypbr/app/navigation.h"

#include <utility>

#include "easypbr/scene/resolve.h"

namespace easypbr::app {

std::optional<Vec2d> Navigation::handle(const InputEvent& event, Vec2i size) {
    using Kind = InputEvent::Kind;
    const bool can_move = !session_.scene().names().empty() || !session_.settings().camera.pose.empty();
    if (!can_move) return {};
    const ViewPoint before = session_.view_point(size);
    ViewPoint view = before;
    const CameraControl::Wish wish = control_.handle(event, view, size, session_.up());
    if (view.camera.T_world_cam.matrix() != before.camera.T_world_cam.matrix()) session_.set_view_point(view);
    fit_ |= wish.fit;
    if (wish.zoom) zoom(*wish.zoom, wish.zoom_factor, size);
    if (wish.focus)
        if (const auto pick = picture_.surfaces(size).at(*wish.focus))
            session_.set_view_point(focused(session_.view_point(size), pick->position));
    if (event.kind == Kind::press) pressed_ = event.position;
    const bool clicked = event.kind == Kind::release && event.button == MouseButton::left &&
                         !control_.has_dragged() && (event.position - pressed_).norm() < 3;
    return clicked ? std::optional(event.position) : std::nullopt;
}

void Navigation::advance(double seconds, Vec2i size) {
    if (control_.is_moving()) {
        ViewPoint view = session_.view_point(size);
        if (control_.advance(seconds, view)) session_.set_view_point(view);
    }
    if (std::exchange(fit_, false)) fit(size);
}

void Navigation::zoom(Vec2d pixel, double factor, Vec2i size) {
    const ViewPoint view = session_.view_point(size);
    if (!zoom_about_) {
        const auto pick = picture_.surfaces(size).at(pixel);
        zoom_about_ = pick ? pick->position : point_at(view.camera, pixel, size, view.distance());
    }
    session_.set_view_point(zoomed(view, factor, *zoom_about_));
}

void Navigation::fit(Vec2i size) {
    const SceneSnapshot scene = session_.scene().snapshot();
    if (scene.objects.empty()) return;
    const CameraSettings lens = session_.settings().camera;
    const ViewPoint view = session_.view_point(size);
    const Insets covered = session_.insets().with(session_.annotation_strip(size));
    const Camera camera =
        fit_camera(scene, view.camera.T_world_cam.linear(), lens, double(size.x()) / size.y(), covered);
    const Vec3d forward = -camera.T_world_cam.linear().col(2);
    const double depth = (scene.bounds().center() - camera.position()).dot(forward);
    session_.set_view_point({camera, camera.position() + forward * depth});
    if (camera.projection == Projection::orthographic) session_.settings().camera.ortho_height = automatic;
}

}  // namespace easypbr::app

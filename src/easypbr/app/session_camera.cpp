// Of Session: the camera of the next picture and what it frames.
#include "easypbr/app/annotation.h"
#include "easypbr/app/pinned_camera.h"
#include "easypbr/app/session.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::app {
namespace {

/// Whether the camera is still to be placed for the content, or to be made as wide as that is.
bool frames_content(const CameraSettings& camera) {
    const bool places = camera.pose.empty() && !camera.position.value();
    return places || (camera.projection == Projection::orthographic && !camera.ortho_height.value());
}

Insets strip_of(const SceneSnapshot& scene, const InferredSettings& settings, Vec2i size) {
    return annotation_strip(annotation_of(scene, settings), settings.annotation, size);
}

}  // namespace

ResolvedSettings Session::resolve_framed(const SceneSnapshot& scene, Vec2i size,
                                         std::optional<int> samples) const {
    ResolvedSettings resolved = easypbr::resolve(scene, *settings_, size, samples, insets_);
    if (!frames_content(settings_->camera)) return resolved;
    const Insets covered = insets_.with(strip_of(scene, resolved.settings, size));
    return covered == insets_ ? resolved : easypbr::resolve(scene, *settings_, size, samples, covered);
}

Insets Session::annotation_strip(std::optional<Vec2i> size) {
    const AnnotationSettings& asked = settings_->annotation;
    if (!asked.legend.value_or(false) && !asked.colorbar.value_or(false)) return {};
    check_picture_size(size_or(size));
    const SceneSnapshot scene = snapshot();
    return strip_of(scene, easypbr::resolve(scene, *settings_, size_or(size)).settings, size_or(size));
}

ResolvedSettings Session::resolve(std::optional<Vec2i> size) {
    check_picture_size(size_or(size));
    const SceneSnapshot scene = snapshot();
    ResolvedSettings resolved = resolve_framed(scene, size_or(size));
    latched_content_.follow(scene, *settings_, resolved);
    return resolved;
}

ViewPoint Session::view_point(std::optional<Vec2i> size) {
    const ResolvedSettings resolved = resolve(size);
    return {resolved.camera, resolved.settings.camera.target};
}

Vec3d Session::up() {
    const std::optional<std::string>& known = settings_->camera.up.value();
    return parse_up(known ? *known : resolve().settings.camera.up);
}

void Session::set_view_point(const ViewPoint& view) {
    pin_view_point(settings_->camera, view);
}

void Session::set_camera(const Camera& camera) {
    pin_camera(settings_->camera, camera);
}

Camera Session::camera() {
    return resolve().camera;
}

}  // namespace easypbr::app

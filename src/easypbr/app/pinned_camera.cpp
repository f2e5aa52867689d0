#include "easypbr/app/pinned_camera.h"

#include <algorithm>

#include "easypbr/scene/fields.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app {
namespace {

/// The automatic near plane of a view that is moved by hand stays within this part of the target's distance.
constexpr double near_part = 1e-3;

/// Intrinsics override the setting, which stays in its range for what is looked at without them next.
float fov_setting_of(const Camera& camera) {
    if (!camera.intrinsics) return float(camera.fov_y_deg);
    const Field& setting = field("camera.fov_y_deg");
    return float(std::clamp(camera.fov_y_deg, setting.min, setting.max));
}

}  // namespace

void pin_camera(CameraSettings& to, const Camera& camera) {
    // A pose replaces both; what they were still says how far away the target is.
    for (Auto<Vec3d>* replaced : {&to.position, &to.target}) {
        const std::optional<Vec3d> known = replaced->value();
        *replaced = automatic;
        if (known) replaced->latch(*known);
    }
    const Mat4d T = camera.T_world_cam.matrix();
    to.pose.clear();
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) to.pose.push_back(T(row, column));
    // Where the near plane may lie depends on the pose: a path may lead nearer than the first picture was.
    to.near.release();
    to.projection = camera.projection;
    to.fov_y_deg = fov_setting_of(camera);
    to.ortho_height = camera.ortho_height;
    to.intrinsics.clear();
    if (camera.intrinsics) {
        const Intrinsics& k = *camera.intrinsics;
        to.intrinsics = {k.fx, k.fy, k.cx, k.cy, double(k.width), double(k.height)};
        if (k.skew != 0) to.intrinsics.push_back(k.skew);
    }
    to.distortion.clear();
    if (camera.distortion) {
        to.distortion_model = camera.distortion->model;
        to.distortion = camera.distortion->coefficients();
    }
}

void pin_view_point(CameraSettings& to, const ViewPoint& view) {
    const Auto<double> near = to.near;
    pin_camera(to, view.camera);
    to.near = near;
    to.position.latch(view.camera.position());
    to.target.latch(view.target);
    const double nearest = near_part * view.distance();
    if (to.near.value() && !to.near.is_pinned()) to.near.latch(std::min(*to.near.value(), nearest));
}

}  // namespace easypbr::app

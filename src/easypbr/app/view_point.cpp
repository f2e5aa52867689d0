#include "easypbr/app/view_point.h"

#include <algorithm>
#include <cmath>

namespace easypbr::app {
namespace {

/// How near a turn may bring the optical axis to the up axis.
constexpr double least_angle_deg = 0.1;

bool orthographic(const Camera& camera) {
    return camera.projection == Projection::orthographic;
}

void move_by(ViewPoint& view, const Vec3d& offset) {
    view.camera.T_world_cam.translation() += offset;
    view.target += offset;
}

}  // namespace

Vec2d pixel_pitch(const Camera& camera, Vec2i size, double depth) {
    const Mat4d p = camera.projection_matrix(double(size.x()) / size.y());
    const double scale = orthographic(camera) ? 1 : depth;
    return {2 * scale / (p(0, 0) * size.x()), 2 * scale / (p(1, 1) * size.y())};
}

ViewPoint orbited(const ViewPoint& view, const Vec3d& up, double right_deg, double up_deg) {
    const Mat3d axes = view.camera.T_world_cam.linear();
    const double angle = std::acos(std::clamp(-axes.col(2).dot(up), -1.0, 1.0)) * 180 / pi;
    const double lowest = std::min(least_angle_deg, angle), highest = std::max(180 - least_angle_deg, angle);
    // Looking further down grows the angle between the optical axis and up.
    const double turn = std::clamp(angle + up_deg, lowest, highest) - angle;
    const Eigen::Quaterniond about_up(Eigen::AngleAxisd(radians(right_deg), up)),
        about_right(Eigen::AngleAxisd(-radians(turn), axes.col(0)));
    const Eigen::Quaterniond rotation = about_up * about_right;
    ViewPoint turned = view;
    Eigen::Isometry3d& pose = turned.camera.T_world_cam;
    pose.translation() = view.target + rotation * (pose.translation() - view.target);
    // By way of a quaternion, so that many turns do not add up to something that is no rotation.
    pose.linear() = (rotation * Eigen::Quaterniond(axes)).normalized().toRotationMatrix();
    return turned;
}

ViewPoint panned(const ViewPoint& view, Vec2d pixels, Vec2i size) {
    const Vec2d pitch = pixel_pitch(view.camera, size, view.distance());
    const Mat3d axes = view.camera.T_world_cam.linear();
    ViewPoint moved = view;
    move_by(moved, -axes.col(0) * (pixels.x() * pitch.x()) + axes.col(1) * (pixels.y() * pitch.y()));
    return moved;
}

ViewPoint zoomed(const ViewPoint& view, double factor, const Vec3d& about) {
    ViewPoint moved = view;
    const Vec3d offset = (1 - factor) * (about - view.camera.position());
    if (!orthographic(view.camera)) {
        moved.camera.T_world_cam.translation() += offset;
        moved.target = about + factor * (view.target - about);
        return moved;
    }
    const Vec3d backwards = view.camera.T_world_cam.linear().col(2);
    moved.camera.ortho_height *= factor;
    move_by(moved, offset - backwards * backwards.dot(offset));
    return moved;
}

ViewPoint flown(const ViewPoint& view, const Vec3d& by) {
    ViewPoint moved = view;
    const Mat3d axes = view.camera.T_world_cam.linear();
    move_by(moved, axes.col(0) * by.x() + axes.col(1) * by.y() - axes.col(2) * by.z());
    return moved;
}

ViewPoint focused(const ViewPoint& view, const Vec3d& point) {
    ViewPoint moved = view;
    move_by(moved, point - view.target);
    return moved;
}

}  // namespace easypbr::app

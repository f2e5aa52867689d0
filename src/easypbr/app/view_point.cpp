#include "easypbr/app/view_point.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "easypbr/core/error.h"

namespace easypbr::app {
namespace {

/// How near a turn may bring the optical axis to the up axis.
constexpr double least_angle_deg = 0.1;

bool orthographic(const Camera& camera) {
    return camera.projection == Projection::orthographic;
}

/// Size of the world in one pixel at a depth, along x and y of the picture.
Vec2d pixel_pitch(const Camera& camera, Vec2i size, double depth) {
    const Mat4d p = camera.projection_matrix(double(size.x()) / size.y());
    const double scale = orthographic(camera) ? 1 : depth;
    return {2 * scale / (p(0, 0) * size.x()), 2 * scale / (p(1, 1) * size.y())};
}

void move_by(ViewPoint& view, const Vec3d& offset) {
    view.camera.T_world_cam.translation() += offset;
    view.target += offset;
}

/// x/z and y/z in OpenCV's axes of what a warped camera sees at a pixel; nothing beyond a fold of its lens.
std::optional<Vec2d> slopes_at(const Camera& camera, Vec2d pixel, Vec2i size) {
    const Mat3d K = camera.opencv_K(size.x(), size.y());
    const double y = (pixel.y() - 0.5 - K(1, 2)) / K(1, 1);
    const Vec2d seen((pixel.x() - 0.5 - K(0, 2) - K(0, 1) * y) / K(0, 0), y);
    try {
        return camera.distortion ? camera.distortion->undistort(seen) : seen;
    } catch (const ArgumentError&) {
        return {};
    }
}

/// Where a warped camera sees a point of its own frame; nothing behind it and beyond a fold of its lens.
std::optional<Vec2d> warped_pixel_of(const Camera& camera, const Vec3d& local, Vec2i size) {
    if (local.z() >= 0) return {};
    const Vec2d slopes(-local.x() / local.z(), local.y() / local.z());
    const Vec2d seen = camera.distortion ? camera.distortion->distort(slopes) : slopes;
    const Mat3d K = camera.opencv_K(size.x(), size.y());
    const Vec2d pixel(K(0, 0) * seen.x() + K(0, 1) * seen.y() + K(0, 2) + 0.5,
                      K(1, 1) * seen.y() + K(1, 2) + 0.5);
    // Beyond a fold the lens shows another point there.
    const std::optional<Vec2d> shown = slopes_at(camera, pixel, size);
    constexpr double same = 1e-6;
    return shown && (*shown - slopes).norm() < same ? std::optional(pixel) : std::nullopt;
}

}  // namespace

Vec3d point_at(const Camera& camera, Vec2d pixel, Vec2i size, double depth) {
    if (camera.is_warped())
        if (const auto slopes = slopes_at(camera, pixel, size))
            return camera.T_world_cam * (depth * Vec3d(slopes->x(), -slopes->y(), -1));
    const Mat4d p = camera.projection_matrix(double(size.x()) / size.y());
    const Vec2d ndc(2 * pixel.x() / size.x() - 1, 1 - 2 * pixel.y() / size.y());
    Vec3d local(0, 0, -depth);
    for (int axis = 0; axis < 2; ++axis)
        local[axis] = orthographic(camera) ? (ndc[axis] - p(axis, 3)) / p(axis, axis)
                                           : depth * (ndc[axis] + p(axis, 2)) / p(axis, axis);
    return camera.T_world_cam * local;
}

Vec3d pixel_of(const Camera& camera, const Vec3d& point, Vec2i size) {
    const Mat4d p = camera.projection_matrix(double(size.x()) / size.y());
    const Vec3d local = camera.T_world_cam.inverse() * point;
    if (camera.is_warped())
        if (const auto pixel = warped_pixel_of(camera, local, size))
            return {pixel->x(), pixel->y(), -local.z()};
    const Eigen::Vector4d clip = p * local.homogeneous();
    return {(clip.x() / clip.w() + 1) / 2 * size.x(), (1 - clip.y() / clip.w()) / 2 * size.y(), -local.z()};
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

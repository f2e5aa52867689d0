#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easypbr/core/error.h"
#include "easypbr/core/image.h"
#include "easypbr/scene/auto_parameters.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::detail {
namespace {

void reject_contradictions(const CameraSettings& settings) {
    if (!settings.pose.empty() && (settings.position.is_pinned() || settings.target.is_pinned()))
        throw ArgumentError(
            fmt::format("settings 'camera.pose' and 'camera.{}' contradict each other: give one of them",
                        settings.position.is_pinned() ? "position" : "target"));
    if (!settings.intrinsics.empty() && settings.projection == Projection::orthographic)
        throw ArgumentError(
            "settings 'camera.intrinsics' and 'camera.projection' = orthographic contradict each other");
    if (!settings.distortion.empty() && settings.intrinsics.empty())
        throw ArgumentError("setting 'camera.distortion' needs 'camera.intrinsics'");
}

/// Looks as view_rotation() does, also straight up and down where `up` alone says nothing about the picture's
/// top.
Camera look_from(const Vec3d& position, const Vec3d& target, const CameraSettings& settings) {
    const Vec3d up = up_direction(settings);
    const Vec3d forward = (target - position).normalized();
    if (forward.cross(up).norm() >= 1e-6) return Camera::look_at(position, target, up);
    CameraSettings level = settings;
    level.elevation_deg = 0;
    const Vec3d from = view_rotation(level).col(2);
    return Camera::look_at(position, target, forward.dot(up) < 0 ? Vec3d(-from) : from);
}

/// Depth of the content's centre, or the content's radius when the centre lies behind.
double target_depth(const Content& content, const Vec3d& position, const Vec3d& forward) {
    const double depth = (content.centre() - position).dot(forward);
    return depth > 0 ? depth : content.radius();
}

void place(const Content& content, const Camera& lens, const PictureShape& picture,
           CameraSettings& settings) {
    const auto position = settings.position.value(), target = settings.target.value();
    const Mat3d R = view_rotation(settings);
    if (!position && content.empty())
        throw ArgumentError(
            "nothing to show: the scene has no vertices to place the camera for; show a mesh, or set "
            "camera.position");
    if (position && target) return;
    if (position) {
        const bool inside = (content.centre() - *position).norm() <= 1e-6 * content.radius();
        fill(settings.target, inside ? Vec3d(*position - R.col(2) * content.radius()) : content.centre());
    } else if (target) {
        const double distance = fitted_distance(content, *target, R, lens, settings.margin, picture);
        fill(settings.position, Vec3d(*target + R.col(2) * distance));
    } else {
        const Vec3d fitted =
            fitted_position(content, R, lens, settings.margin, picture, settings.ortho_height.value());
        fill(settings.position, fitted);
        fill(settings.target, Vec3d(fitted - R.col(2) * target_depth(content, fitted, -R.col(2))));
    }
}

/// Near and far only have to enclose the content: the depth buffer's relative precision does not depend on
/// them.
void set_depth_range(const Content& content, CameraSettings& settings, Camera& camera) {
    const double distance = (*settings.target - *settings.position).norm();
    double nearest = 0, farthest = distance;
    if ((!settings.near.value() || camera.projection == Projection::orthographic) && !content.empty()) {
        const Vec3d forward = -camera.T_world_cam.linear().col(2);
        const auto [least, most] = content.extent_along(forward);
        nearest = least - forward.dot(camera.position());
        farthest = most - forward.dot(camera.position());
    }
    fill(settings.near, detail::near_plane(nearest, distance));
    camera.near = *settings.near;
    camera.far = std::max(farthest + distance, 2 * camera.near);
}

/// The camera of a given pose; position and target follow from it, the target as far away as it was, if it
/// was anywhere.
void take_pose(const Content& content, CameraSettings& settings, Camera& camera) {
    const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> pose(settings.pose.data());
    camera.T_world_cam = Camera::from_opengl(pose).T_world_cam;
    const Vec3d position = camera.position(), forward = -camera.T_world_cam.linear().col(2);
    const bool known = settings.position.value() && settings.target.value();
    const double depth =
        known ? (*settings.target - *settings.position).norm() : target_depth(content, position, forward);
    settings.position = settings.target = Auto<Vec3d>(automatic);
    fill(settings.position, position);
    fill(settings.target, Vec3d(position + forward * depth));
}

}  // namespace

ViewAngles inferred_view(const SceneSnapshot& scene, const Vec3d& up) {
    constexpr double alike = 0.985;  // the cosine of 10 degrees
    Vec3d front(0, 0, 0);
    for (const SceneSnapshot::Object& object : scene.objects) {
        if (object.mesh->V.empty()) continue;
        const Vec3d own = (object.T_world_mesh.linear() * object.mesh->front).normalized();
        if (own.isZero() || (!front.isZero() && front.dot(own) < alike)) return usual_view;
        if (front.isZero()) front = own;
    }
    if (front.isZero()) return usual_view;
    const Vec3d stands = up_frame(up) * front;  // to the right of the content, above it, in front of it
    return {float(degrees(std::atan2(stands.x(), stands.z()))),
            float(degrees(std::asin(std::clamp(stands.y(), -1.0, 1.0))))};
}

Camera lens_of(const CameraSettings& settings) {
    Camera lens;
    if (!settings.intrinsics.empty()) {
        const std::vector<double>& k = settings.intrinsics;
        if (std::min(k[4], k[5]) < 1 || std::max(k[4], k[5]) > max_image_side)
            throw ArgumentError(
                fmt::format("setting 'camera.intrinsics': expected a width and height from 1 to {}, got {} "
                            "and {}",
                            max_image_side, k[4], k[5]));
        Mat3d K;
        K << k[0], 0, k[2], 0, k[1], k[3], 0, 0, 1;
        if (k.size() > 6) K(0, 1) = k[6];
        lens = Camera::from_opencv(K, Mat4d::Identity(), int(k[4]), int(k[5]));
        if (!settings.distortion.empty())
            lens.distortion = Distortion::from_coefficients(settings.distortion_model, settings.distortion);
    } else {
        lens.fov_y_deg = settings.fov_y_deg;
    }
    lens.projection = settings.projection;
    return lens;
}

Camera resolve_camera(const Content& content, CameraSettings& settings, const PictureShape& picture) {
    reject_contradictions(settings);
    Camera camera = lens_of(settings);
    if (settings.pose.empty()) {
        place(content, camera, picture, settings);
        camera.T_world_cam = look_from(*settings.position, *settings.target, settings).T_world_cam;
    } else {
        take_pose(content, settings, camera);
    }
    const double distance = (*settings.target - *settings.position).norm();
    if (!settings.ortho_height.value()) {
        const bool fits = camera.projection == Projection::orthographic && !content.empty();
        // The height at the target, so that switching the projection keeps its size.
        fill(settings.ortho_height, fits
                                        ? fitted_height(content, camera.T_world_cam, settings.margin, picture)
                                        : 2 * distance * std::tan(radians(camera.fov_y_deg) / 2));
    }
    camera.ortho_height = *settings.ortho_height;
    set_depth_range(content, settings, camera);
    return camera;
}

}  // namespace easypbr::detail

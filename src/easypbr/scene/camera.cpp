#include "easypbr/scene/camera.h"

#include <fmt/format.h>

#include <cmath>

#include "easypbr/core/error.h"
#include "easypbr/scene/pixel.h"

namespace easypbr {
namespace {

/// Between OpenGL's camera axes (y up, z back) and OpenCV's (y down, z forward); its own inverse.
const Vec3d axis_flip(1, -1, -1);

constexpr double rigid_tolerance = 1e-4;

Eigen::Isometry3d require_rigid(const Mat4d& T) {
    const Mat3d R = T.topLeftCorner<3, 3>();
    const bool rotation = T.allFinite() &&
                          (R * R.transpose() - Mat3d::Identity()).cwiseAbs().maxCoeff() <= rigid_tolerance &&
                          R.determinant() > 0;
    const bool affine =
        T.allFinite() && (T.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() <= rigid_tolerance;
    if (!rotation || !affine)
        throw ArgumentError(
            fmt::format("camera pose: expected a rotation and a translation with the last row 0 0 0 1, {}",
                        !rotation ? "got a 3x3 part that is no rotation" : "got another last row"));
    Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
    result.linear() = R;
    result.translation() = T.topRightCorner<3, 1>();
    return result;
}

/// Of length 1, whatever its own is; +y for zero.
Vec3d unit_up(const Vec3d& up) {
    if (!up.allFinite())
        throw ArgumentError(fmt::format("camera: expected an up of finite numbers, got ({}, {}, {})", up.x(),
                                        up.y(), up.z()));
    if (std::isnormal(up.squaredNorm())) return up.normalized();
    return up.isZero(0) ? Vec3d(Vec3d::UnitY()) : Vec3d((up / up.cwiseAbs().maxCoeff()).normalized());
}

/// The picture's top when looking straight down or up: for +y up it is -z when looking down, for +z up it is
/// +y. `up` is unit.
Vec3d substitute_up(const Vec3d& up, const Vec3d& forward) {
    const Vec3d top = std::abs(up.z()) > 0.9 ? Vec3d::UnitY() : Vec3d(-Vec3d::UnitZ());
    return forward.dot(up) < 0 ? top : Vec3d(-top);
}

Mat4d perspective_matrix(double x_scale, double y_scale, double x_offset, double y_offset, double near) {
    Mat4d P = Mat4d::Zero();
    P(0, 0) = x_scale;
    P(1, 1) = y_scale;
    P(0, 2) = x_offset;
    P(1, 2) = y_offset;
    P(2, 3) = near;
    P(3, 2) = -1;
    return P;
}

Mat4d orthographic_matrix(double width, double height, double near, double far) {
    Mat4d P = Mat4d::Identity();
    P(0, 0) = 2 / width;
    P(1, 1) = 2 / height;
    P(2, 2) = 1 / (far - near);
    P(2, 3) = far / (far - near);
    return P;
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

Vec3d Camera::position() const {
    return T_world_cam.translation();
}

Mat4d Camera::view() const {
    return T_world_cam.inverse().matrix();
}

Mat4d Camera::projection_matrix(double aspect) const {
    if (projection == Projection::orthographic)
        return orthographic_matrix(ortho_height * aspect, ortho_height, near, far);
    if (intrinsics) {
        const Intrinsics& k = *intrinsics;
        return perspective_matrix(2 * k.fx / k.width, 2 * k.fy / k.height, 1 - 2 * (k.cx + 0.5) / k.width,
                                  2 * (k.cy + 0.5) / k.height - 1, near);
    }
    const double scale = 1 / std::tan(radians(fov_y_deg) / 2);
    return perspective_matrix(scale / aspect, scale, 0, 0, near);
}

Camera Camera::look_at(const Vec3d& position, const Vec3d& target, const Vec3d& up) {
    const Vec3d forward = (target - position).normalized();
    // Eigen leaves a zero vector as it is.
    if (!(forward.squaredNorm() > 0.5)) {
        constexpr double largest = 1e150;  // Squares of lengths are finite.
        if (!((target - position).array().abs() < largest).all())
            throw ArgumentError(fmt::format(
                "camera: expected position and target less than {} apart, got ({}, {}, {}) and ({}, {}, {})",
                largest, position.x(), position.y(), position.z(), target.x(), target.y(), target.z()));
        throw ArgumentError(fmt::format("camera: position and target coincide at ({}, {}, {})", position.x(),
                                        position.y(), position.z()));
    }
    const Vec3d top = unit_up(up);
    Vec3d right = forward.cross(top);
    if (right.norm() < 1e-6) right = forward.cross(substitute_up(top, forward));
    right.normalize();
    Camera camera;
    camera.T_world_cam.linear() << right, right.cross(forward), -forward;
    camera.T_world_cam.translation() = position;
    return camera;
}

Camera Camera::from_opencv(const Mat3d& K, const Mat4d& T_world_cam, int width, int height) {
    if (width < 1 || height < 1)
        throw ArgumentError(
            fmt::format("camera: expected a picture of at least 1x1, got {}x{}", width, height));
    const bool shape = K.allFinite() && K(1, 0) == 0 && K(2, 0) == 0 && K(2, 1) == 0 && K(2, 2) == 1;
    if (!shape || !(K(0, 0) > 0) || !(K(1, 1) > 0))
        throw ArgumentError(
            fmt::format("camera: expected K = [fx s cx; 0 fy cy; 0 0 1] with fx, fy > 0, got [{} {} {}; {} "
                        "{} {}; {} {} {}]",
                        K(0, 0), K(0, 1), K(0, 2), K(1, 0), K(1, 1), K(1, 2), K(2, 0), K(2, 1), K(2, 2)));
    Camera camera;
    camera.T_world_cam = require_rigid(T_world_cam);
    camera.T_world_cam.linear() = camera.T_world_cam.linear() * axis_flip.asDiagonal();
    camera.intrinsics = Intrinsics{K(0, 0), K(1, 1), K(0, 2), K(1, 2), width, height, K(0, 1)};
    camera.fov_y_deg = degrees(2 * std::atan(height / (2 * K(1, 1))));
    return camera;
}

Camera Camera::from_opengl(const Mat4d& T_world_cam, double fov_y_deg) {
    if (!(fov_y_deg > 0 && fov_y_deg < 180))
        throw ArgumentError(
            fmt::format("camera: expected a vertical angle between 0 and 180 degrees, got {}", fov_y_deg));
    Camera camera;
    camera.T_world_cam = require_rigid(T_world_cam);
    camera.fov_y_deg = fov_y_deg;
    return camera;
}

Mat3d Camera::opencv_K(int width, int height) const {
    if (projection == Projection::orthographic)
        throw ArgumentError("camera: an orthographic camera has no intrinsic matrix K");
    const Mat4d P = projection_matrix(double(width) / height);
    Mat3d K = Mat3d::Identity();
    K(0, 0) = width * P(0, 0) / 2;
    K(1, 1) = height * P(1, 1) / 2;
    K(0, 2) = width * (1 - P(0, 2)) / 2 - 0.5;
    K(1, 2) = height * (1 + P(1, 2)) / 2 - 0.5;
    if (intrinsics) K(0, 1) = intrinsics->skew * width / intrinsics->width;
    return K;
}

Mat4d Camera::opencv_T_world_cam() const {
    Mat4d T = T_world_cam.matrix();
    T.topLeftCorner<3, 3>() = T_world_cam.linear() * axis_flip.asDiagonal();
    return T;
}

Vec3d point_at(const Camera& camera, Vec2d pixel, Vec2i size, double depth) {
    if (camera.is_warped())
        if (const auto slopes = slopes_at(camera, pixel, size))
            return camera.T_world_cam * (depth * Vec3d(slopes->x(), -slopes->y(), -1));
    const Mat4d p = camera.projection_matrix(double(size.x()) / size.y());
    const Vec2d ndc(2 * pixel.x() / size.x() - 1, 1 - 2 * pixel.y() / size.y());
    Vec3d local(0, 0, -depth);
    for (int axis = 0; axis < 2; ++axis)
        local[axis] = camera.projection == Projection::orthographic
                          ? (ndc[axis] - p(axis, 3)) / p(axis, axis)
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

}  // namespace easypbr

// Camera: a pinhole or orthographic camera with a pose. OpenGL axes: x right, y up, it looks along -z.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "easypbr/core/math.h"

namespace easypbr {

enum class DistortionModel { brown_conrady, fisheye };

/// Where a lens shows what a pinhole camera of the same K would see elsewhere. Points are slopes x/z and y/z
/// in OpenCV's axes (x right, y down, z forward).
struct Distortion {
    DistortionModel model = DistortionModel::brown_conrady;
    /// brown_conrady (Brown 1966, in OpenCV's rational form): k1 k2 p1 p2 k3 k4 k5 k6; fisheye (Kannala and
    /// Brandt 2006): k1 k2 k3 k4. The rest is 0.
    std::array<double, 8> k{};

    /// From 4, 5 or 8 coefficients in OpenCV's order, or 12 or 14 of which those after the eighth are 0
    /// (fisheye: 4). Throws ArgumentError for another number of them, for what is not finite, and for the
    /// thin prisms and tilted sensors that others after the eighth stand for.
    static Distortion from_coefficients(DistortionModel model, const std::vector<double>& coefficients);
    /// As from_coefficients() takes them: as few as hold all that is not 0.
    std::vector<double> coefficients() const;

    /// From the pinhole's slopes to the lens's.
    Vec2d distort(const Vec2d& slopes) const;
    /// The inverse, by Newton's method to 1e-12. Throws ArgumentError where there is none: beyond a fold of
    /// the polynomials, or more than 80 degrees off the axis, where no pinhole camera sees.
    Vec2d undistort(const Vec2d& slopes) const;
};

enum class Projection { perspective, orthographic };

/// Intrinsics in the OpenCV convention, in pixels of an image of the given size; pixel centres at integers.
struct Intrinsics {
    double fx = 0, fy = 0, cx = 0, cy = 0;
    int width = 0, height = 0;
    double skew = 0;
};

struct Camera {
    Eigen::Isometry3d T_world_cam = Eigen::Isometry3d::Identity();
    Projection projection = Projection::perspective;
    double fov_y_deg = 30;    ///< vertical field of view; perspective without intrinsics
    double ortho_height = 2;  ///< height of the view volume, world units; orthographic
    /// Distance to the near plane; the far plane is at infinity (perspective). A view that is given a camera
    /// infers its own, unless settings.camera.near says it.
    double near = 0.01;
    double far = 100;  ///< orthographic only; views infer it
    std::optional<Intrinsics>
        intrinsics;  ///< perspective; overrides fov_y_deg, scaled to the size of the image
    std::optional<Distortion> distortion;  ///< of the lens; perspective with intrinsics

    Vec3d position() const;
    Mat4d view() const;

    /// What is drawn has to be warped: skew or distortion are not in projection_matrix().
    bool is_warped() const { return distortion || (intrinsics && intrinsics->skew != 0); }

    /// Reversed-Z projection for clip depth 0 (far) to 1 (near): z_ndc = near / z for perspective.
    Mat4d projection_matrix(double aspect) const;

    /// Looks from `position` to `target`. When the direction is parallel to `up`, another up is chosen; a
    /// zero one is +y. Throws ArgumentError when position and target coincide, and for an up that is not
    /// finite.
    static Camera look_at(const Vec3d& position, const Vec3d& target, const Vec3d& up = {0, 1, 0});

    /// From OpenCV's intrinsic matrix K (pixel centres at integers, skew allowed) for a picture of width x
    /// height, and a pose whose axes are OpenCV's (x right, y down, z forward). Throws ArgumentError when K
    /// or the pose is not valid.
    static Camera from_opencv(const Mat3d& K, const Mat4d& T_world_cam, int width, int height);

    /// From a 4x4 pose with OpenGL axes. Throws ArgumentError when it is not a rotation and a translation
    /// (1e-4).
    static Camera from_opengl(const Mat4d& T_world_cam, double fov_y_deg = 30);

    /// OpenCV's K for a picture of the given size; the inverse of from_opencv.
    Mat3d opencv_K(int width, int height) const;
    /// Pose with OpenCV's axes.
    Mat4d opencv_T_world_cam() const;
};

}  // namespace easypbr

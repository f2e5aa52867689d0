// Camera paths: where the camera is at each moment, by key poses or around a centre.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "easypbr/scene/camera.h"

namespace easypbr {

/// How poses between the keys come about.
enum class PathMode {
    smooth,  ///< through all keys without a jump in velocity or acceleration (C2)
    linear   ///< positions straight from key to key, rotations the shortest way at constant speed
};

/// How a path begins and ends. All are without a jump in velocity or acceleration along the way.
enum class PathEase { none, in, out, in_out };

/// A pose that the camera takes.
struct CameraKey {
    Eigen::Isometry3d T_world_cam = Eigen::Isometry3d::Identity();  ///< OpenGL's axes
    double segment_s = 1;  ///< seconds to the next key; of the last key: to the first of a closed path
    std::optional<double> fov_y_deg;  ///< full vertical angle; see CameraPath for keys without one
    bool is_calibrated = false;       ///< fov_y_deg is that of a camera with a K of its own
    bool is_orthographic = false;     ///< of a camera without an angle of view

    /// The pose and the angle of view of a camera.
    static CameraKey at(const Camera& camera, double segment_s = 1);
};

struct CameraPathOptions {
    PathMode mode = PathMode::smooth;
    PathEase ease = PathEase::none;
    bool closed = false;  ///< after the last key back to the first, and on without a jump
};

/// Positions of the smooth mode are a cubic spline. Its rotations are a cubic spline of unit quaternions with
/// matching signs, brought to unit length: C2 wherever it does not vanish, which is checked, and the same
/// motion however the world is moved or turned, for a rotation of the world is linear in quaternions. Angles
/// of view are interpolated as logarithms of the picture's half height, which makes zooming even. A key
/// without one gets what lies between those of its neighbours by time, or that of the nearest key that has
/// one. Where no key has one, or all those with one are of calibrated cameras, the path leaves the camera its
/// own.
class CameraPath {
  public:
    /// Throws ArgumentError for less than two keys, a pose that is no rotation and translation (1e-4), a
    /// time between keys that is not above 0, an angle of view outside (0, 180), orthographic keys beside
    /// others with an angle of view, and rotations that times very unlike each other make tumble.
    explicit CameraPath(std::vector<CameraKey> keys, const CameraPathOptions& options = {});

    // Moving copies: there are always keys, or a circle.
    CameraPath(const CameraPath& other) = default;
    CameraPath& operator=(const CameraPath& other) = default;

    /// A circle around the line through `center` along `axis`, at constant speed but for `ease`, from the
    /// camera's pose on, with its height if it is orthographic; the camera turns with it. Closed when the
    /// angle is a multiple of 360 degrees. Throws ArgumentError for an axis without length, an angle of 0, or
    /// a duration that is not above 0.
    static CameraPath orbit(const Camera& start, const Vec3d& center, const Vec3d& axis = {0, 1, 0},
                            double angle_deg = 360, double duration_s = 4, PathEase ease = PathEase::none);

    /// What orbit() was given.
    struct Orbit {
        Eigen::Isometry3d T_world_cam;
        Vec3d center, axis;
        double angle_deg;
        std::optional<double> ortho_height;  ///< of an orthographic camera
    };

    double duration_s() const { return duration_s_; }
    bool is_closed() const { return options_.closed; }
    const CameraPathOptions& options() const { return options_; }
    /// With the angles of view that they got; empty for an orbit.
    const std::vector<CameraKey>& keys() const { return keys_; }
    const std::optional<Orbit>& circle() const { return orbit_; }

    /// When the keys are passed, easing included; for an orbit start and end.
    std::vector<double> key_times_s() const;

    /// The pose at a time, OpenGL's axes. Before the start and after the end of an open path the camera
    /// rests; on a closed one it goes around. Throws ArgumentError when the time is not finite.
    Eigen::Isometry3d pose(double time_s) const;
    /// The angle of view at a time; none when the keys have none.
    std::optional<double> fov_y_deg(double time_s) const;
    /// `like` at the path's pose, with the path's angle of view when it has one; an orthographic one with the
    /// height of an orbit that has one.
    Camera camera(double time_s, Camera like = {}) const;

    /// `count` times evenly from start to end; of a closed path the end, which is the start, is left out.
    std::vector<double> times(int count) const;
    /// Times of a video's frames: round(duration * fps) of a closed path, but at least 1, and one more of an
    /// open one, so that both ends are in it. Throws ArgumentError unless fps > 0.
    std::vector<double> frame_times(double fps) const;
    /// Frames per second with which the frames at times(count) show the path in its duration.
    double frame_rate(int count) const;

  private:
    CameraPath() = default;
    /// Time along the path without easing, within [0, duration].
    double eased(double time_s) const;
    void build_splines();
    /// Between the frames at times(count). Throws ArgumentError for less than one frame.
    int steps(int count) const;
    Eigen::Isometry3d linear_pose(double time) const;

    std::vector<CameraKey> keys_;
    CameraPathOptions options_;
    std::optional<Orbit> orbit_;
    double duration_s_ = 0;
    std::vector<double> times_;  ///< of the keys, and the end of a closed path, without easing
    struct Splines;
    std::shared_ptr<const Splines> splines_;  ///< of the smooth mode
};

}  // namespace easypbr

#include "easypbr/scene/camera_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easypbr/core/error.h"
#include "easypbr/scene/cubic_spline.h"

namespace easypbr {
namespace {

/// Turns by more than this between two keys get poses between them, so that the chord between their
/// quaternions stays near the sphere.
constexpr double largest_turn_deg = 90;
/// The spline of quaternions must stay this far from zero.
constexpr double least_quaternion = 0.2;
/// How much more a rotation may turn between two knots than lies between them.
constexpr double largest_swing_deg = 90;

/// Monotone from (0, 0) to (1, 1) with no acceleration at both ends; no velocity where it is eased.
double ease(PathEase kind, double x) {
    switch (kind) {
        case PathEase::none:
            return x;
        case PathEase::in:
            return x * x * x * (2 - x);
        case PathEase::out:
            return 1 - ease(PathEase::in, 1 - x);
        case PathEase::in_out:
            return x * x * x * (10 + x * (6 * x - 15));
    }
    return x;
}

/// The x whose ease() is y.
double ease_inverse(PathEase kind, double y) {
    if (kind == PathEase::none || y <= 0 || y >= 1) return std::clamp(y, 0.0, 1.0);
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (ease(kind, middle) < y ? low : high) = middle;
    }
    return (low + high) / 2;
}

Eigen::Quaterniond rotation_of(const CameraKey& key) {
    return Eigen::Quaterniond(key.T_world_cam.linear()).normalized();
}

/// q or -q, which are the same rotation: whichever is nearer to `from`.
Eigen::Quaterniond towards(const Eigen::Quaterniond& from, const Eigen::Quaterniond& q) {
    return from.dot(q) < 0 ? Eigen::Quaterniond(-q.coeffs()) : q;
}

CubicSpline::Points quaternion_rows(const std::vector<Eigen::Quaterniond>& quaternions) {
    CubicSpline::Points rows(Eigen::Index(quaternions.size()), 4);
    for (size_t i = 0; i < quaternions.size(); ++i) rows.row(Eigen::Index(i)) = quaternions[i].coeffs();
    return rows;
}

void check_key(CameraKey& key, size_t index, bool is_last, const CameraPathOptions& options) {
    try {
        key.T_world_cam =
            Camera::from_opengl(key.T_world_cam.matrix(), key.fov_y_deg.value_or(30)).T_world_cam;
    } catch (const ArgumentError& error) {
        throw ArgumentError(fmt::format("camera path: key {}: {}", index, error.what()));
    }
    key.T_world_cam.linear() = rotation_of(key).toRotationMatrix();
    if (is_last && !options.closed) return;
    if (!(key.segment_s > 0) || !std::isfinite(key.segment_s))
        throw ArgumentError(
            fmt::format("camera path: expected a time above 0 seconds from key {} to the next, got {}", index,
                        key.segment_s));
}

/// Logarithm of half the picture's height at distance 1.
double zoom_of(double fov_y_deg) {
    return std::log(std::tan(radians(fov_y_deg) / 2));
}

double angle_of_zoom(double zoom) {
    return degrees(2 * std::atan(std::exp(zoom)));
}

/// Between an orthographic key and one with an angle of view there is no projection.
void require_one_projection(const std::vector<CameraKey>& keys) {
    const auto flat = std::ranges::find(keys, true, &CameraKey::is_orthographic);
    const auto other =
        std::ranges::find_if(keys, [](const CameraKey& key) { return key.fov_y_deg.has_value(); });
    if (flat != keys.end() && other != keys.end())
        throw ArgumentError(fmt::format(
            "camera path: key {} is orthographic and key {} perspective: there is nothing between "
            "them; expected keys of one projection, or poses",
            flat - keys.begin(), other - keys.begin()));
}

/// Gives keys without an angle of view one, or takes all angles away. `times`: of the keys.
void complete_angles(std::vector<CameraKey>& keys, const std::vector<double>& times) {
    std::vector<size_t> known;
    bool keeps_own = true;
    for (size_t i = 0; i < keys.size(); ++i) {
        if (!keys[i].fov_y_deg) continue;
        known.push_back(i);
        keeps_own &= keys[i].is_calibrated;
    }
    for (size_t i = 0; i < keys.size(); ++i) {
        if (keeps_own) {
            keys[i].fov_y_deg.reset();
        } else if (!keys[i].fov_y_deg) {
            const auto next = std::ranges::lower_bound(known, i);
            const size_t after = next == known.end() ? known.back() : *next,
                         before = next == known.begin() ? after : *(next - 1);
            const double part =
                before == after ? 0 : (times[i] - times[before]) / (times[after] - times[before]);
            keys[i].fov_y_deg = angle_of_zoom((1 - part) * zoom_of(*keys[before].fov_y_deg) +
                                              part * zoom_of(*keys[after].fov_y_deg));
        }
    }
}

/// Rotations with the knots that long turns need between the keys.
struct RotationKnots {
    std::vector<double> times;
    std::vector<Eigen::Quaterniond> rotations;
    SplineEnds ends = SplineEnds::natural;
};

RotationKnots rotation_knots(const std::vector<CameraKey>& keys, const std::vector<double>& times,
                             bool closed) {
    RotationKnots knots{{times[0]}, {rotation_of(keys[0])}};
    const size_t segments = times.size() - 1;
    for (size_t i = 0; i < segments; ++i) {
        const Eigen::Quaterniond from = knots.rotations.back(),
                                 to = towards(from, rotation_of(keys[(i + 1) % keys.size()]));
        const int pieces =
            std::max(1, int(std::ceil(degrees(from.angularDistance(to)) / largest_turn_deg - 1e-9)));
        for (int piece = 1; piece <= pieces; ++piece) {
            const double part = double(piece) / pieces;
            knots.times.push_back(piece == pieces ? times[i + 1]
                                                  : times[i] + part * (times[i + 1] - times[i]));
            knots.rotations.push_back(piece == pieces ? to : from.slerp(part, to));
        }
    }
    if (!closed) return knots;
    knots.ends = knots.rotations.back().dot(knots.rotations.front()) < 0 ? SplineEnds::antiperiodic
                                                                         : SplineEnds::periodic;
    knots.rotations.pop_back();
    return knots;
}

/// Refuses rotations that swing far back and forth between two knots, and quaternions near zero, which are no
/// rotation.
void require_no_tumbling(const CubicSpline& rotations, const std::vector<double>& times) {
    constexpr int samples = 64;
    for (size_t i = 0; i + 1 < times.size(); ++i) {
        const auto at = [&](int k) -> Eigen::Vector4d {
            return rotations.at(times[i] + (times[i + 1] - times[i]) * k / samples);
        };
        double turned = 0, shortest = at(0).norm();
        for (int k = 0; k < samples; ++k) {
            const Eigen::Vector4d q = at(k), next = at(k + 1);
            shortest = std::min(shortest, next.norm());
            turned +=
                Eigen::Quaterniond(q.normalized()).angularDistance(Eigen::Quaterniond(next.normalized()));
        }
        const double direct = Eigen::Quaterniond(at(0)).angularDistance(Eigen::Quaterniond(at(samples)));
        if (shortest < least_quaternion || turned > direct + radians(largest_swing_deg))
            throw ArgumentError(fmt::format(
                "camera path: the rotation tumbles between {} and {} s, for the times between keys "
                "are too unlike each other; give the short ones more time, or choose the linear mode",
                times[i], times[i + 1]));
    }
}

}  // namespace

CameraKey CameraKey::at(const Camera& camera, double segment_s) {
    CameraKey key;
    key.T_world_cam = camera.T_world_cam;
    key.segment_s = segment_s;
    key.is_orthographic = camera.projection == Projection::orthographic;
    if (key.is_orthographic) return key;
    key.is_calibrated = camera.intrinsics.has_value();
    key.fov_y_deg = key.is_calibrated
                        ? degrees(2 * std::atan(camera.intrinsics->height / (2 * camera.intrinsics->fy)))
                        : camera.fov_y_deg;
    return key;
}

struct CameraPath::Splines {
    CubicSpline positions, rotations, zooms;
};

CameraPath::CameraPath(std::vector<CameraKey> keys, const CameraPathOptions& options)
    : keys_(std::move(keys)), options_(options), times_{0} {
    if (keys_.size() < 2)
        throw ArgumentError(fmt::format("camera path: expected at least two keys, got {}", keys_.size()));
    for (size_t i = 0; i < keys_.size(); ++i) {
        const bool is_last = i + 1 == keys_.size();
        check_key(keys_[i], i, is_last, options_);
        if (!is_last || options_.closed) times_.push_back(times_.back() + keys_[i].segment_s);
    }
    require_one_projection(keys_);
    complete_angles(keys_, times_);
    duration_s_ = times_.back();
    build_splines();
}

void CameraPath::build_splines() {
    const auto count = Eigen::Index(keys_.size());
    const SplineEnds ends = options_.closed ? SplineEnds::periodic : SplineEnds::natural;
    CubicSpline::Points positions(count, 3), zooms(count, 1);
    for (Eigen::Index i = 0; i < count; ++i) {
        const CameraKey& key = keys_[size_t(i)];
        positions.row(i) = key.T_world_cam.translation();
        zooms(i, 0) = zoom_of(key.fov_y_deg.value_or(30));
    }
    if (options_.mode == PathMode::linear) return;
    RotationKnots knots = rotation_knots(keys_, times_, options_.closed);
    splines_ = std::make_shared<const Splines>(
        Splines{CubicSpline(times_, positions, ends),
                CubicSpline(knots.times, quaternion_rows(knots.rotations), knots.ends),
                CubicSpline(times_, zooms, ends)});
    require_no_tumbling(splines_->rotations, knots.times);
}

CameraPath CameraPath::orbit(const Camera& start, const Vec3d& center, const Vec3d& axis, double angle_deg,
                             double duration_s, PathEase ease) {
    if (!axis.allFinite() || !(axis.norm() > 0) || !center.allFinite())
        throw ArgumentError("camera orbit: expected a finite centre and an axis with a length");
    if (!std::isfinite(angle_deg) || angle_deg == 0)
        throw ArgumentError(fmt::format("camera orbit: expected an angle other than 0, got {}", angle_deg));
    if (!std::isfinite(duration_s) || !(duration_s > 0))
        throw ArgumentError(
            fmt::format("camera orbit: expected a duration above 0 seconds, got {}", duration_s));
    CameraPath path;
    path.orbit_ = Orbit{start.T_world_cam, center, axis.stableNormalized(), angle_deg, {}};
    if (start.projection == Projection::orthographic) path.orbit_->ortho_height = start.ortho_height;
    path.options_.ease = ease;
    path.options_.closed = std::abs(std::remainder(angle_deg, 360.0)) < 1e-9;
    path.duration_s_ = duration_s;
    path.times_ = {0, duration_s};
    return path;
}

double CameraPath::eased(double time_s) const {
    if (!std::isfinite(time_s))
        throw ArgumentError(fmt::format("camera path: expected a finite time, got {}", time_s));
    const double part = time_s / duration_s_;
    const double along = options_.closed ? part - std::floor(part) : std::clamp(part, 0.0, 1.0);
    if (options_.ease == PathEase::none && along == part) return time_s;
    return duration_s_ * ease(options_.ease, along);
}

std::vector<double> CameraPath::key_times_s() const {
    std::vector<double> times(times_.begin(), times_.begin() + std::ptrdiff_t(orbit_ ? 2 : keys_.size()));
    if (options_.ease != PathEase::none)
        for (double& time : times) time = duration_s_ * ease_inverse(options_.ease, time / duration_s_);
    return times;
}

Eigen::Isometry3d CameraPath::linear_pose(double time) const {
    const auto after = std::upper_bound(times_.begin() + 1, times_.end() - 1, time);
    const size_t i = size_t(after - times_.begin() - 1);
    const CameraKey &from = keys_[i], &to = keys_[(i + 1) % keys_.size()];
    const double part = (time - times_[i]) / (times_[i + 1] - times_[i]);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    // Eigen's slerp goes the shorter way.
    pose.linear() = rotation_of(from).slerp(part, rotation_of(to)).normalized().toRotationMatrix();
    pose.translation() = (1 - part) * from.T_world_cam.translation() + part * to.T_world_cam.translation();
    return pose;
}

Eigen::Isometry3d CameraPath::pose(double time_s) const {
    const double time = eased(time_s);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    if (orbit_) {
        const Eigen::AngleAxisd turn(radians(orbit_->angle_deg * time / duration_s_), orbit_->axis);
        pose.linear() = (Eigen::Quaterniond(turn) * Eigen::Quaterniond(orbit_->T_world_cam.linear()))
                            .normalized()
                            .toRotationMatrix();
        pose.translation() = orbit_->center + turn * (orbit_->T_world_cam.translation() - orbit_->center);
        return pose;
    }
    if (options_.mode == PathMode::linear) return linear_pose(time);
    pose.linear() =
        Eigen::Quaterniond(Eigen::Vector4d(splines_->rotations.at(time)).normalized()).toRotationMatrix();
    pose.translation() = splines_->positions.at(time);
    return pose;
}

std::optional<double> CameraPath::fov_y_deg(double time_s) const {
    if (keys_.empty() || !keys_.front().fov_y_deg) return {};
    const double time = eased(time_s);
    if (options_.mode == PathMode::smooth) return angle_of_zoom(splines_->zooms.at(time)[0]);
    const auto after = std::upper_bound(times_.begin() + 1, times_.end() - 1, time);
    const size_t i = size_t(after - times_.begin() - 1);
    const double part = (time - times_[i]) / (times_[i + 1] - times_[i]);
    const auto zoom = [&](size_t key) { return zoom_of(*keys_[key % keys_.size()].fov_y_deg); };
    return angle_of_zoom((1 - part) * zoom(i) + part * zoom(i + 1));
}

Camera CameraPath::camera(double time_s, Camera like) const {
    like.T_world_cam = pose(time_s);
    if (const auto angle = fov_y_deg(time_s)) {
        like.fov_y_deg = *angle;
        like.intrinsics.reset();
        like.projection = Projection::perspective;
    }
    if (like.projection == Projection::orthographic && orbit_ && orbit_->ortho_height)
        like.ortho_height = *orbit_->ortho_height;
    return like;
}

int CameraPath::steps(int count) const {
    if (count < 1)
        throw ArgumentError(fmt::format("camera path: expected at least one frame, got {}", count));
    return options_.closed ? count : std::max(1, count - 1);
}

double CameraPath::frame_rate(int count) const {
    return steps(count) / duration_s_;
}

std::vector<double> CameraPath::times(int count) const {
    const int steps = this->steps(count);
    std::vector<double> times(size_t(count), 0.0);
    for (int i = 0; i < count; ++i) times[size_t(i)] = duration_s_ * i / steps;
    return times;
}

std::vector<double> CameraPath::frame_times(double fps) const {
    if (!(fps > 0) || !std::isfinite(fps))
        throw ArgumentError(fmt::format("camera path: expected above 0 frames per second, got {}", fps));
    const double frames = std::round(duration_s_ * fps);
    if (frames > 1e8)
        throw ArgumentError(fmt::format("camera path: {} seconds at {} frames per second are too many frames",
                                        duration_s_, fps));
    return times(std::max(1, int(frames)) + (options_.closed ? 0 : 1));
}

}  // namespace easypbr

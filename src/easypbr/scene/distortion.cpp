#include "easypbr/scene/camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "easypbr/core/error.h"

namespace easypbr {
namespace {

/// A pinhole picture grows with the tangent of the angle off its axis: 5.7 focal lengths to each side here.
constexpr double widest_deg = 80;

[[noreturn]] void no_inverse(const Vec2d& slopes) {
    throw ArgumentError(
        fmt::format("camera distortion: nothing is seen at ({:.4g}, {:.4g}) focal lengths off the axis: "
                    "the polynomial folds before, or the lens sees farther than {} degrees off its axis; "
                    "use a smaller picture or other coefficients",
                    slopes.x(), slopes.y(), widest_deg));
}

Vec2d brown_conrady(const std::array<double, 8>& k, const Vec2d& p) {
    const double x = p.x(), y = p.y(), r2 = x * x + y * y, r4 = r2 * r2, r6 = r4 * r2;
    const double radial = (1 + k[0] * r2 + k[1] * r4 + k[4] * r6) / (1 + k[5] * r2 + k[6] * r4 + k[7] * r6);
    return {x * radial + 2 * k[2] * x * y + k[3] * (r2 + 2 * x * x),
            y * radial + k[2] * (r2 + 2 * y * y) + 2 * k[3] * x * y};
}

/// Angle off the axis as the fisheye shows it, and its derivative.
std::pair<double, double> fisheye_angle(const std::array<double, 8>& k, double angle) {
    const double t2 = angle * angle, t4 = t2 * t2, t6 = t4 * t2, t8 = t4 * t4;
    return {angle * (1 + k[0] * t2 + k[1] * t4 + k[2] * t6 + k[3] * t8),
            1 + 3 * k[0] * t2 + 5 * k[1] * t4 + 7 * k[2] * t6 + 9 * k[3] * t8};
}

Vec2d undistort_fisheye(const std::array<double, 8>& k, const Vec2d& seen) {
    const double radius = seen.norm();
    if (radius < 1e-12) return seen;
    double angle = std::min(radius, radians(widest_deg));
    for (int i = 0; i < 50; ++i) {
        const auto [value, slope] = fisheye_angle(k, angle);
        if (!(slope > 0)) no_inverse(seen);
        const double step = (value - radius) / slope;
        angle -= step;
        if (std::abs(step) < 1e-13) break;
    }
    if (!(angle >= 0 && angle <= radians(widest_deg)) ||
        std::abs(fisheye_angle(k, angle).first - radius) > 1e-10 || !(fisheye_angle(k, angle).second > 0))
        no_inverse(seen);
    return seen * (std::tan(angle) / radius);
}

/// Derivatives of brown_conrady() by central differences: exact enough for Newton's steps to converge.
Eigen::Matrix2d jacobian(const std::array<double, 8>& k, const Vec2d& p) {
    constexpr double h = 1e-6;
    Eigen::Matrix2d J;
    for (int axis = 0; axis < 2; ++axis) {
        Vec2d d(0, 0);
        d[axis] = h;
        J.col(axis) = (brown_conrady(k, p + d) - brown_conrady(k, p - d)) / (2 * h);
    }
    return J;
}

/// The polynomial rises all the way from the axis to the point: the point is before the first fold.
bool rises_up_to(const std::array<double, 8>& k, const Vec2d& p) {
    constexpr int steps = 16;
    for (int i = 1; i <= steps; ++i)
        if (!(jacobian(k, p * (double(i) / steps)).determinant() > 0)) return false;
    return true;
}

Vec2d undistort_brown(const std::array<double, 8>& k, const Vec2d& seen) {
    Vec2d p = seen;
    for (int i = 0; i < 50; ++i) {
        const Eigen::Matrix2d J = jacobian(k, p);
        if (!(J.determinant() > 0)) no_inverse(seen);
        const Vec2d step = J.inverse() * (brown_conrady(k, p) - seen);
        p -= step;
        if (step.norm() < 1e-13) break;
    }
    if (!p.allFinite() || (brown_conrady(k, p) - seen).norm() > 1e-10 ||
        p.norm() > std::tan(radians(widest_deg)) || !rises_up_to(k, p))
        no_inverse(seen);
    return p;
}

}  // namespace

Distortion Distortion::from_coefficients(DistortionModel model, const std::vector<double>& coefficients) {
    const size_t count = coefficients.size();
    const bool is_long = count == 12 || count == 14;
    const bool fits =
        model == DistortionModel::fisheye ? count == 4 : count == 4 || count == 5 || count == 8 || is_long;
    if (!fits)
        throw ArgumentError(fmt::format(
            "camera distortion: expected {} coefficients, got {}",
            model == DistortionModel::fisheye ? "4 (k1 k2 k3 k4)" : "4, 5 or 8 (k1 k2 p1 p2 k3 k4 k5 k6)",
            count));
    if (!std::ranges::all_of(coefficients, [](double c) { return std::isfinite(c); }))
        throw ArgumentError("camera distortion: expected finite coefficients");
    Distortion distortion;
    distortion.model = model;
    const auto used = std::span(coefficients).first(std::min(count, distortion.k.size()));
    const auto rest = std::span(coefficients).subspan(used.size());
    if (std::ranges::any_of(rest, [](double c) { return c != 0; }))
        throw ArgumentError(
            "camera distortion: expected 0 for the coefficients after the eighth: there are no thin prisms "
            "(s1 to s4) and tilted sensors (tx, ty)");
    std::ranges::copy(used, distortion.k.begin());
    return distortion;
}

std::vector<double> Distortion::coefficients() const {
    const bool rational = k[5] != 0 || k[6] != 0 || k[7] != 0;
    const size_t count = model == DistortionModel::fisheye ? 4 : rational ? 8 : k[4] != 0 ? 5 : 4;
    return {k.begin(), k.begin() + long(count)};
}

Vec2d Distortion::distort(const Vec2d& slopes) const {
    if (model == DistortionModel::brown_conrady) return brown_conrady(k, slopes);
    const double radius = slopes.norm();
    return radius < 1e-12 ? slopes : Vec2d(slopes * (fisheye_angle(k, std::atan(radius)).first / radius));
}

Vec2d Distortion::undistort(const Vec2d& slopes) const {
    return model == DistortionModel::fisheye ? undistort_fisheye(k, slopes) : undistort_brown(k, slopes);
}

}  // namespace easypbr

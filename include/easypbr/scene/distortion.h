// Distortion of a lens, in OpenCV's models.
#pragma once

#include <array>
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

    /// From 4, 5 or 8 coefficients in OpenCV's order (fisheye: 4). Throws ArgumentError for another number of
    /// them and for what is not finite.
    static Distortion from_coefficients(DistortionModel model, const std::vector<double>& coefficients);
    /// As from_coefficients() takes them: as few as hold all that is not 0.
    std::vector<double> coefficients() const;

    /// From the pinhole's slopes to the lens's.
    Vec2d distort(const Vec2d& slopes) const;
    /// The inverse, by Newton's method to 1e-12. Throws ArgumentError where there is none: beyond a fold of
    /// the polynomials, or more than 80 degrees off the axis, where no pinhole camera sees.
    Vec2d undistort(const Vec2d& slopes) const;
};

}  // namespace easypbr

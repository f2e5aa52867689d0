// Where automatic near planes lie.
#pragma once

#include <algorithm>

namespace easypbr::detail {

/// Distance of a near plane before content that begins at a depth, which is negative behind the camera, with
/// a target at `distance`. Depths are reversed floats, so that a small one costs nothing.
constexpr double near_plane(double nearest, double distance) {
    return std::max(0.1 * nearest, 1e-9 * distance);
}

}  // namespace easypbr::detail

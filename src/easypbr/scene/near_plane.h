// Where automatic near planes lie.
#pragma once

#include <algorithm>

namespace easypbr::detail {

/// What an automatic near plane is of the smallest depth of the content, and of the distance to the target at
/// least.
inline constexpr double near_part_of_depth = 0.1, least_near_part = 1e-9;

/// Distance of a near plane before content that begins at a depth, which is negative behind the camera, with
/// a target at `distance`. Depths are reversed floats, so that a small one costs nothing. It says nothing of
/// how near to the camera single precision can cut what reaches behind it.
constexpr double near_plane(double nearest, double distance) {
    return std::max(near_part_of_depth * nearest, least_near_part * distance);
}

}  // namespace easypbr::detail

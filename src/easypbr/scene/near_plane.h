// Where automatic near planes lie.
#pragma once

#include <algorithm>

namespace easypbr::detail {

/// Distance of a near plane before content that begins at a depth, with a target at `distance`. Depths are
/// reversed floats, so that a small one costs nothing. Only where the content begins behind the camera does
/// it cut triangles, which GPUs do in single precision of the content's extent.
constexpr double near_plane(double nearest, double distance) {
    return nearest > 0 ? std::max(0.1 * nearest, 1e-9 * distance) : 1e-5 * distance;
}

}  // namespace easypbr::detail

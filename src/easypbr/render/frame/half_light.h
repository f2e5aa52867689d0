// Radiance in targets of halves.
#pragma once

#include <cmath>

namespace easypbr::render {

/// What radiance is divided by before it is stored as halves, whose range is 2^-14 to 65504: a power of two
/// near the radiance that an exposure shows as white.
inline float half_light_scale(float exposure) {
    return exposure > 0 ? std::ldexp(1.0f, -std::ilogb(exposure)) : 1.0f;
}

}  // namespace easypbr::render

// The sun of an environment map: a bright spot small enough to act as a directional light.
#pragma once

#include <optional>

#include "easypbr/core/image.h"
#include "easypbr/core/math.h"

namespace easypbr {

struct Sun {
    Vec3 towards{0, 1, 0};     ///< unit vector in environment space (see scene/environment.h)
    Vec3 irradiance{0, 0, 0};  ///< of a surface that faces the sun
    float angular_radius_deg = 0;
};

struct SunSplit {
    Sun sun;
    Image rest;  ///< the map without the sun
};

/// Takes the sun out of an equirectangular radiance picture (f32, 3 channels): the brightest spot, when it is
/// at least 50 times as bright as the mean and gives a twentieth as much light as all. Its spot, up to 5
/// degrees around, is left as bright as what surrounds it. A surface that sees all of the spot receives as
/// much from the rest and the sun together as it did before. Nothing when there is no sun.
std::optional<SunSplit> split_sun(const Image& equirect);

}  // namespace easypbr

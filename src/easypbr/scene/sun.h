// The sun of an environment map: a bright spot small enough to act as a directional light.
#pragma once

#include <optional>

#include "easypbr/core/image.h"
#include "easypbr/scene/environment.h"

namespace easypbr {

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

// What denoisers are given.
#pragma once

#include "easypbr/core/math.h"
#include "easypbr/render/frame/target.h"

namespace easypbr::render {

/// Light of the surfaces that a picture shows, and what they are; all in host memory, RGBA32F and whole.
struct NoisyLight {
    /// Mean radiance; a: variance of that mean's luminance. 0 where no surface is.
    const Target& light;
    /// Sums over the frames that show a surface at the pixel: world normal; a: log2 of the depth.
    const Target& surface;
    /// Likewise: linear reflectance, 0 to 1; a: the number of frames.
    const Target& color;
    /// Undefined; for what denoisers write.
    const Target& scratch;
    bool is_last = false;  ///< `surface` is not needed any more, and may be released
};

}  // namespace easypbr::render

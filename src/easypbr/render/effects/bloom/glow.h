// The light that bloom spreads, as the output passes add it to a picture.
#pragma once

#include "easypbr/core/math.h"
#include "easypbr/render/frame/target.h"

namespace easypbr::render {

/// Side of a texel of the glow, in pixels.
inline constexpr int glow_texel = 4;

struct Glow {
    const Target* light = nullptr;   ///< RGBA16F, exposed light, a texel for 4 x 4 pixels
    Vec4 parameters = Vec4::Zero();  ///< intensity, exposure, threshold, half width of the knee

    /// In pixels.
    Vec2 size() const {
        return Vec2(float(glow_texel * light->width()), float(glow_texel * light->height()));
    }
};

}  // namespace easypbr::render

// Normal maps of one direction.
#pragma once

#include <cmath>
#include <memory>

#include "easypbr/core/image.h"
#include "easypbr/core/math.h"

namespace easypbr {

/// A normal map whose normals are all tilted towards the tangent.
inline std::shared_ptr<Image> tilted_normals(double tilt) {
    auto normals = std::make_shared<Image>(2, 2, 3, PixelType::u8);
    for (int i = 0; i < 4; ++i) {
        uint8_t* texel = normals->at<uint8_t>(i % 2, i / 2);
        texel[0] = uint8_t(std::lround(127.5 * (1 + std::sin(tilt))));
        texel[1] = 128;
        texel[2] = uint8_t(std::lround(127.5 * (1 + std::cos(tilt))));
    }
    return normals;
}

}  // namespace easypbr

// An image for textures of meshes that are written.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>

#include "easypbr/core/image.h"

namespace easypbr {

/// An image of one colour.
inline std::shared_ptr<const Image> flat(uint8_t value) {
    auto image = std::make_shared<Image>(2, 2, 3, PixelType::u8);
    std::ranges::fill(image->pixels<uint8_t>(), value);
    return image;
}

}  // namespace easypbr

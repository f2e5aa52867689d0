// 256 colours for a picture of many: what a GIF holds.
#pragma once

#include <array>
#include <cstdint>

#include "easypbr/core/image.h"

namespace easypbr::io {

using Palette = std::array<uint32_t, 256>;  ///< 0xAARRGGBB

/// Colours of a u8 picture with 4 channels by median cut (Heckbert 1982) over cells of 32^3, each split where
/// its box is longest.
Palette median_cut(const Image& picture);

/// Each pixel's nearest colour of the palette after an ordered dither (Bayer 1973), which unlike the
/// diffusion of errors stays in place from one frame to the next. `rows` are `stride` bytes apart.
void map_to_palette(const Image& picture, const Palette& palette, uint8_t* rows, int stride);

}  // namespace easypbr::io

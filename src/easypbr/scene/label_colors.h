// Colours for labels that nobody gave any: well separated, and the same on every machine.
#pragma once

#include <cstdint>
#include <vector>

#include "easypbr/core/color.h"

namespace easypbr {

/// Number of different colours; then they repeat.
inline constexpr int generated_color_count = 4096;

/// The colours of labels 0, 1, 2, ...: each is the one farthest (in OKLab, Ottosson 2020) from white, black
/// and the greys of backgrounds and from all colours before it, so that any first ones are well separated and
/// a label's colour depends on nothing but its number. Neither very dark nor very light.
class GeneratedColors {
  public:
    /// Prepares the colours of 0 to `highest`, which are kept for the next ones that ask.
    explicit GeneratedColors(int32_t highest);

    /// Grey for negative labels.
    Rgb8 color_of(int32_t label) const {
        if (label < 0) return {128, 128, 128};
        return colors_[size_t(label) % generated_color_count];
    }

  private:
    std::vector<Rgb8> colors_;
};

/// L, a, b of an 8-bit sRGB colour (Ottosson 2020, "A perceptual color space for image processing").
Vec3d oklab_from_rgb8(const Rgb8& color);

}  // namespace easypbr

// Transfer functions between linear Rec.709 and sRGB (IEC 61966-2-1), and colours written as text.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "easypbr/core/math.h"

namespace easypbr {

/// sRGB as it is written into 8-bit pictures; alpha last.
using Rgb8 = std::array<uint8_t, 3>;
using Rgba8 = std::array<uint8_t, 4>;

/// sRGB-encoded value in [0, 1] of a linear value in [0, 1], by the exact piecewise curve.
inline float srgb_from_linear(float c) {
    return c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1.0f / 2.4f) - 0.055f;
}

/// Linear value in [0, 1] of an sRGB-encoded value in [0, 1].
inline float linear_from_srgb(float c) {
    return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}

/// Linear values of the 256 8-bit sRGB codes.
const float* srgb8_table();

Vec3 srgb_from_linear(const Vec3& c);
Vec3 linear_from_srgb(const Vec3& c);

/// The nearest code of an sRGB colour, clamped to [0, 1].
Rgb8 to_rgb8(const Vec3& srgb);
inline Rgba8 opaque(const Rgb8& color) {
    return {color[0], color[1], color[2], 255};
}

/// What a colour is given as, for messages.
inline constexpr const char* color_forms =
    "'#rgb', '#rrggbb', a name of CSS such as white, or 3 numbers from 0 to 1";

/// sRGB colour in [0, 1] from '#rgb', '#rrggbb', 'r,g,b' (numbers in 0..1) or a name of CSS such as 'tomato';
/// none for anything else.
std::optional<Vec3> find_color(std::string_view text);

/// The same. Throws ArgumentError for anything else.
Vec3 parse_color(std::string_view text);

/// '#rrggbb' of an sRGB colour in [0, 1].
std::string to_hex(const Vec3& srgb);

}  // namespace easypbr

// SPZ (Niantic): a header and an array for each attribute. Versions 2 and 3 are a gzip file of all; in
// version 4 each array is packed by Zstandard, behind a plain header, extensions and a table of their sizes.
// The axes are those of OpenGL: y points up.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "easypbr/core/math.h"

namespace easypbr::io {

struct SpzHeader {
    uint32_t magic, version, count;
    uint8_t degree, fractional_bits, flags, reserved;
};
static_assert(sizeof(SpzHeader) == 16);

/// The header of version 4: the same, and what follows.
struct Spz4Header {
    SpzHeader common;  ///< whose last byte is the number of arrays that are not empty
    uint32_t table;    ///< where the table of sizes begins
    uint32_t unused[3];
};
static_assert(sizeof(Spz4Header) == 32);
/// Bytes of an array.
struct Spz4Entry {
    uint64_t packed, unpacked;
};

inline constexpr uint32_t spz_magic = 0x5053474e;  ///< "NGSP"
inline constexpr uint8_t spz_has_extensions = 2;   ///< a flag
/// Splats that a thread takes at once.
inline constexpr size_t spz_grain = 1 << 14;
inline constexpr int most_spz_degree = 3, most_spz4_degree = 4;
inline const Vec3d spz_up(0, 1, 0);

/// Bytes of a splat in each array, in the order of the file.
struct SpzSizes {
    size_t position = 9, alpha = 1, color = 3, scale = 3, rotation, harmonics;

    SpzSizes(uint32_t version, int degree)
        : rotation(version >= 3 ? 4 : 3), harmonics(3 * (size_t(degree + 1) * size_t(degree + 1) - 1)) {}
    std::array<size_t, 6> each() const { return {position, alpha, color, scale, rotation, harmonics}; }
    size_t all() const { return position + alpha + color + scale + rotation + harmonics; }
};

// Codes: value = (code - zero) / step.
inline constexpr float spz_scale_step = 16, spz_scale_zero = 160;  ///< of the scale's logarithm
inline constexpr float spz_color_step = 0.15f * 255, spz_color_zero = 127.5f;
inline constexpr float spz_harmonic_step = 128, spz_harmonic_zero = 128;
/// A component of a rotation that is not the largest: 9 bits and a sign.
inline constexpr int spz_rotation_bits = 9, spz_rotation_most = (1 << spz_rotation_bits) - 1;
/// The numbers of the components w, x, y, z, where w is the last.
inline constexpr std::array<int, 4> spz_components{3, 0, 1, 2};

}  // namespace easypbr::io

// Random numbers of paths: points of Sobol's sequence, scrambled by hashes.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "easypbr/render/raytrace/ray_random.h"

namespace easypbr::render {

inline uint32_t reversed_bits(uint32_t x) {
    x = __builtin_bswap32(x);
    x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
    x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
    return (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
}

/// Owen's scrambling of a number whose bits are reversed (Burley 2020, "Practical Hash-based Owen
/// Scrambling"; the hash is that of Laine and Karras 2011 with Vegdahl's constants).
inline uint32_t scrambled_reversed(uint32_t x, uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    return x ^ x * 0x53a22864u;
}

/// Second dimension of Sobol's sequence, its bits reversed: a linear function of the bits of the index, for
/// each byte of it.
inline const std::array<std::array<uint32_t, 256>, 4>& sobol_table() {
    static const auto table = [] {
        std::array<std::array<uint32_t, 256>, 4> values{};
        uint32_t direction = 1u << 31;
        for (unsigned bit = 0; bit < 32; ++bit, direction ^= direction >> 1)
            for (unsigned byte = 0; byte < 256; ++byte)
                if (byte >> (bit % 8) & 1u) values[bit / 8][byte] ^= reversed_bits(direction);
        return values;
    }();
    return table;
}

/// Spreads the lower 16 bits to the even places.
inline uint32_t spread_bits(uint32_t x) {
    x &= 0xffffu;
    x = (x | x << 8) & 0x00ff00ffu;
    x = (x | x << 4) & 0x0f0f0f0fu;
    x = (x | x << 2) & 0x33333333u;
    return (x | x << 1) & 0x55555555u;
}

/// Numbers for the paths of a pixel. Each pair of dimensions is a (0, 2)-sequence, scrambled anew for each
/// pair and depth. It visits the pixels in Z-order. The samples of a pixel are stratified, and so are those
/// of neighbouring pixels together: the error is distributed as blue noise (Ahmed and Wonka 2020,
/// "Screen-space blue-noise diffusion of Monte Carlo sampling error via hierarchical ordering of pixels").
class PathSampler {
  public:
    /// Dimensions of a vertex, in pairs. Of the second the first number chooses the light, the other the
    /// lobe.
    enum Dimension : uint32_t {
        sky_point,
        light_and_lobe,
        lobe_point,
        emitter_point,
        roulette,
        color_channel
    };

    PathSampler() = default;
    /// The pixel is in the whole picture; `samples`: how many it gets at most.
    PathSampler(uint32_t x, uint32_t y, uint32_t sample, uint32_t samples) {
        const auto bits = uint32_t(std::bit_width(std::max(samples, 1u) - 1));
        // As large a square of pixels as 32 bits allow; the next ones have other sequences.
        const uint32_t side = (32 - std::min(bits, 16u)) / 2;
        const uint32_t inside = (1u << side) - 1;
        reversed_sample_ =
            reversed_bits((spread_bits(x & inside) | spread_bits(y & inside) << 1) << bits | sample);
        seed_ = pcg_hash((x >> side) + pcg_hash(y >> side));
    }

    /// In [0, 1)^2, of dimension `pair` of the vertex `depth`.
    Vec2 pair(uint32_t depth, uint32_t pair) const {
        const uint32_t seed = pcg_hash(seed_ ^ (depth * 16 + pair) * 0x9e3779b9u);
        const uint32_t index = reversed_bits(scrambled_reversed(reversed_sample_, seed));
        const auto& table = sobol_table();
        const uint32_t y = table[0][index & 255] ^ table[1][index >> 8 & 255] ^ table[2][index >> 16 & 255] ^
                           table[3][index >> 24];
        return {unit_number(reversed_bits(scrambled_reversed(index, pcg_hash(seed + 1)))),
                unit_number(reversed_bits(scrambled_reversed(y, pcg_hash(seed + 2))))};
    }

  private:
    uint32_t seed_ = 0, reversed_sample_ = 0;
};

}  // namespace easypbr::render

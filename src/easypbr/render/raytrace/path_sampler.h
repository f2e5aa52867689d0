// Random numbers of paths: points of Sobol's sequence, scrambled by hashes.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "easypbr/render/raytrace/ray_random.h"

namespace easypbr::render {

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
    /// The pair by which a block of lights is chosen from. The first number chooses within the block, the
    /// second one between it and those before; of block 0, which has none before it, that chooses the lobe.
    static constexpr uint32_t choice_in_block(uint32_t block) { return block << 20 | light_and_lobe; }

    /// What a pixel's column or row adds to its numbers.
    struct Axis {
        uint32_t reversed_order;  ///< in the Z-order, the bits reversed
        uint32_t square;          ///< of pixels that share a sequence
    };
    /// The order in which the pixels of a picture are visited, of `samples` for each at most.
    class Order {
      public:
        explicit Order(uint32_t samples) : bits_(uint32_t(std::bit_width(std::max(samples, 1u) - 1))) {}

        Axis column(uint32_t x) const { return axis(x, 0); }
        Axis row(uint32_t y) const { return axis(y, 1); }

      private:
        Axis axis(uint32_t at, uint32_t shift) const {
            // As large a square of pixels as 32 bits allow; the next ones have other sequences.
            const uint32_t side = (32 - std::min(bits_, 16u)) / 2;
            const uint32_t inside = at & ((1u << side) - 1);
            return {native::reversed_bits(spread_bits(inside) << shift << bits_), at >> side};
        }

        uint32_t bits_;  ///< of a sample's number
    };

    PathSampler() = default;
    PathSampler(const Axis& column, const Axis& row, uint32_t sample)
        : seed_(pcg_hash(column.square + pcg_hash(row.square))),
          reversed_sample_(column.reversed_order | row.reversed_order | native::reversed_bits(sample)) {}
    /// The pixel is in the whole picture; `samples`: how many it gets at most.
    PathSampler(uint32_t x, uint32_t y, uint32_t sample, uint32_t samples)
        : PathSampler(Order(samples).column(x), Order(samples).row(y), sample) {}

    /// In [0, 1)^2, of a pair of dimensions of the vertex `depth`.
    Vec2 pair(uint32_t depth, uint32_t pair) const {
        uint32_t x = 0, y = 0;
        native::sample_point(native::seed_of_dimension(seed_, dimension_of(depth, pair)), reversed_sample_, x,
                             y);
        return {unit_number(x), unit_number(y)};
    }

    /// For native::sample_paths().
    static uint32_t dimension_of(uint32_t depth, uint32_t pair) { return depth * 16 + pair; }
    uint32_t seed() const { return seed_; }
    uint32_t reversed_sample() const { return reversed_sample_; }

  private:
    uint32_t seed_ = 0, reversed_sample_ = 0;
};

}  // namespace easypbr::render

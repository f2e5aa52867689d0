// A tile of the screen while splats are blended into it.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "easypbr/render/primitives/splats/splat_order.h"

namespace easypbr::render {

using native::least_splat_transmittance;

/// Reversed depths along the view's axis: (a z + b) / (c z + d) at z of view space.
struct DepthAxis {
    float a = 0, b = 1, c = -1, d = 0;

    float depth_at(float z) const { return (a * z + b) / (c * z + d); }
    /// z at a depth, for all numbers or vectors of them.
    template <class Number>
    Number position_at(Number depth) const {
        return (b - depth * d) / (depth * c - a);
    }
};

/// Its pixels, row by row.
struct alignas(64) SplatTile {
    static constexpr int size = SplatTiles::tile_size;
    using Pixels = std::array<float, size_t(size) * size>;

    Pixels red, green, blue;  ///< sRGB-encoded, premultiplied
    Pixels through;           ///< the part of the light from behind that still comes through
    /// Reversed depths: splats are seen from `farthest` to before `nearest`, where is_limited; without a
    /// limit they are infinite.
    Pixels farthest, nearest;
    bool is_limited = false;
    /// Of a splat that a limit passes through the part on its side is seen; else all or nothing, by the depth
    /// where it is densest along the pixel's ray.
    bool is_soft = false;
    /// Place of the splat behind which less than half of the light comes through; no_splat: there is none.
    std::array<uint32_t, size_t(size) * size> median;
    static constexpr uint32_t no_splat = ~0u;
    /// With `sums_positions` the sum of the splats' z along the axis, weighed by what each adds to the
    /// pixel.
    Pixels positions;
    bool sums_positions = false;
    DepthAxis axis;
    int left = 0, top = 0;  ///< its first pixel

    /// Blends splats, of which `places` are those of the tile from the nearest on, behind what it holds.
    void blend(std::span<const ProjectedSplat> splats, std::span<const uint32_t> places);
    /// The same, but each pixel's splats in the order of their depths there (Radl et al. 2024,
    /// "StopThePop", whose order is that of the depths where they are densest along the pixel's ray).
    void blend_resorted(std::span<const ProjectedSplat> splats, std::span<const uint32_t> places);
    /// Nothing blended yet.
    void clear();
};

}  // namespace easypbr::render

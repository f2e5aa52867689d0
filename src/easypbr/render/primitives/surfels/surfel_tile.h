// Weighted sums of the surfels in a tile of the frame.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "easypbr/render/primitives/surfels/surfel_projection.h"
#include "easypbr/render/raster/surface_writer.h"
#include "easypbr/render/raster/whole_pixels.h"

namespace easypbr::render {

/// An item with all that its surfels need.
struct SurfelSource {
    const DrawItem* item;
    SurfelProjector projector;
};

/// Of an entry: source in the upper, surfel in the lower half.
inline size_t surfel_of(uint64_t entry) {
    return entry & 0xffffffffu;
}
inline size_t source_of(uint64_t entry) {
    return entry >> 32;
}

inline float reversed_depth(const Frame& frame, float z) {
    const float near = float(frame.camera.near), far = float(frame.camera.far);
    return frame.orthographic() ? (far - z) / (far - near) : near / z;
}

inline float axial_distance(const Frame& frame, float depth) {
    if (depth <= 0) return std::numeric_limits<float>::infinity();
    const float near = float(frame.camera.near), far = float(frame.camera.far);
    return frame.orthographic() ? far + (near - far) * depth : near / depth;
}

/// First and one past the last pixel of a row or column whose centres lie in [low, high].
inline std::pair<int, int> pixels_between(float low, float high, int begin, int end) {
    return {std::max(begin, ceil_of(low - 0.5f)), std::min(end, floor_of(high - 0.5f) + 1)};
}

/// Limits are axial distances. Sums are of whole numbers, so that the order of the surfels does not matter.
struct SurfelTile {
    static constexpr int size = 64;
    static constexpr size_t most_pixels = size_t(size) * size;
    /// Neighbours on the screen may be far apart in memory: what they read is asked for ahead of their turn.
    static constexpr size_t ahead = 12;

    enum Channel {
        red,
        green,
        blue,
        normal_x,
        normal_y,
        normal_z,
        metallic,
        roughness,
        distance,
        weight,
        opacity,  ///< of layers alone
        channels
    };

    int left = 0, top = 0, right = 0, bottom = 0;  ///< pixels of the frame; the ends are beyond
    std::array<float, most_pixels> hidden;         ///< surfels that far away are not seen
    std::array<float, most_pixels> limit;          ///< of what belongs to the surface
    std::array<uint64_t, most_pixels> nearest;
    std::array<std::array<int64_t, channels>, most_pixels> sums;  ///< undefined where they are empty
    std::array<bool, most_pixels> is_empty;                       ///< no surfel has been added

    std::vector<SurfelProjection> projections;  ///< of project()
    std::vector<uint32_t> seen;                 ///< those of them that something of may be seen

    void place(Vec2i frame, Vec2i tile);
    /// Projects the surfels of entries. `kept`: those of each source, by surfel; or none.
    void project(const std::vector<SurfelSource>& sources, std::span<const uint64_t> entries,
                 std::span<const std::vector<SurfelProjection>> kept);
    size_t index(int x, int y) const { return size_t(y - top) * size + size_t(x - left); }

    /// Calls body(x, y, index) for all pixels.
    template <class Body>
    void for_all(Body&& body) const {
        for (int y = top; y < bottom; ++y)
            for (int x = left; x < right; ++x) body(x, y, index(x, y));
    }
    /// Calls body(index, hit) for the pixels that a surfel covers.
    template <class Body>
    void for_covered(const SurfelProjection& s, Body&& body) const {
        const auto [x0, x1] = pixels_between(s.x0, s.x1, left, right);
        const auto [y0, y1] = pixels_between(s.y0, s.y1, top, bottom);
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x)
                if (const SurfelProjection::Hit hit = s.at(float(x) + 0.5f, float(y) + 0.5f); hit.r2 <= 1)
                    body(index(x, y), hit);
    }

    /// Adds a surfel, whose projection that is, to the pixels where `takes(index, hit)` says so; their limits
    /// are set.
    template <bool is_layer, class Takes>
    void add(const SurfelSource& source, size_t surfel, const SurfelProjection& s, Takes&& takes);
    /// The mean surface of a pixel that is not empty, but for its object and element.
    SurfacePixel mean(const Frame& frame, const DrawItem& item, size_t i) const;

    /// Sums are whole multiples of this, a hundred thousandth of the least weight. A pixel holds 2^33 surfels
    /// of full weight before one overflows.
    static constexpr float quantum = 1.0f / (1 << 30);
    static int64_t quantised(float value) { return int64_t(std::lrintf(value * (1 / quantum))); }
    /// What a surfel adds, but for what depends on the pixel.
    static std::array<float, channels> values_of(const SurfelSource& source, size_t surfel,
                                                 const SurfelProjection& s);
};

template <bool is_layer, class Takes>
void SurfelTile::add(const SurfelSource& source, size_t surfel, const SurfelProjection& s, Takes&& takes) {
    constexpr size_t summed = is_layer ? channels : opacity;
    std::array<float, channels> values;
    bool is_known = false;  // Most surfels of a closed surface are hidden.
    for_covered(s, [&](size_t i, const SurfelProjection::Hit& hit) {
        if (!takes(i, hit)) return;
        if (!std::exchange(is_known, true)) values = values_of(source, surfel, s);
        // Relative to the limit: the sum of small numbers keeps the distance's precision.
        values[distance] = (limit[i] - hit.z) / limit[i];
        const float w = surfel_weight(hit.r2);
        if (std::exchange(is_empty[i], false)) sums[i].fill(0);
        for (size_t c = 0; c < summed; ++c) sums[i][c] += quantised(values[c] * w);
    });
}

}  // namespace easypbr::render

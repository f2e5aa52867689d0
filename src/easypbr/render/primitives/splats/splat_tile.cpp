#include "easypbr/render/primitives/splats/splat_tile.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "easypbr/native/shaders.h"

namespace easypbr::render {
namespace {

/// The part of a normal distribution below a number of standard deviations.
float normal_cdf(float deviations) {
    return 0.5f * std::erfc(deviations * -0.70710678f);
}

/// The opacity of what a splat has between two limits, at these numbers of standard deviations along the ray.
/// Its density is a Gaussian there, and its opacity that of a medium of this density, so that both parts of a
/// splat that is cut let through together what the whole one does.
float cut_opacity(float opacity, float to_farthest, float to_nearest) {
    const float part = normal_cdf(to_farthest) - normal_cdf(to_nearest);
    return -std::expm1(part * std::log1p(-opacity));
}

/// Where a splat is densest along a pixel's ray, and what deviations of its limits are multiplied with.
struct Densest {
    float depth, narrowing;
};

/// As simd/blend_splats.h.
Densest densest(const ProjectedSplat& splat, float dx, float dy, float power, bool is_reciprocal) {
    const float first_order = splat.depth_x * dx + (splat.depth + splat.depth_y * dy);
    if (!is_reciprocal) return {first_order, 1};
    if (splat.depth * splat.sharpness >= native::flat_splat_deviations)
        return {std::clamp(first_order, native::farthest_splat_part * splat.depth, 1.0f), 1};
    const float straight = std::max(first_order, native::farthest_straight_part * splat.depth),
                depth = straight + 2 / (splat.sharpness * splat.sharpness) * std::max(power, 0.0f) / straight;
    return {std::min(depth, 1.0f), std::sqrt(straight / depth)};
}

/// Standard deviations from where a splat is densest to a limit (as simd/blend_splats.h).
float deviations_to(float limit, const Densest& at, const ProjectedSplat& splat, bool is_reciprocal) {
    const float scale =
        is_reciprocal ? splat.depth * (1 / std::clamp(limit, native::least_splat_limit, 1.0f)) : 1;
    return (at.depth - limit) * (splat.sharpness * at.narrowing) * scale;
}

}  // namespace

void SplatTile::clear() {
    red.fill(0);
    green.fill(0);
    blue.fill(0);
    through.fill(1);
    positions.fill(0);
    median.fill(no_splat);
}

void SplatTile::blend(std::span<const ProjectedSplat> splats, std::span<const uint32_t> places) {
    native::SplatPixels pixels{.left = left,
                               .top = top,
                               .red = red.data(),
                               .green = green.data(),
                               .blue = blue.data(),
                               .through = through.data(),
                               .is_soft = is_soft,
                               .median = median.data(),
                               .axis = {axis.a, axis.b, axis.c, axis.d}};
    if (is_limited) {
        pixels.farthest = farthest.data();
        pixels.nearest = nearest.data();
    }
    if (sums_positions) pixels.positions = positions.data();
    native::blend_splats(pixels, splats, places);
}

namespace {

/// A splat in one pixel.
struct InPixel {
    Densest at;
    float alpha;
    uint32_t place;
};

/// Those of a pixel, from the nearest on; of equal depth in the order of the places.
void find_in_pixel(std::span<const ProjectedSplat> splats, std::span<const uint32_t> places,
                   const Vec2& pixel, bool is_reciprocal, std::vector<InPixel>& found) {
    found.clear();
    for (const uint32_t place : places) {
        const ProjectedSplat& s = splats[place];
        const float dx = pixel.x() - s.x, dy = pixel.y() - s.y;
        if (std::abs(dx) > s.half_width || std::abs(dy) > s.half_height) continue;
        const float power = (0.5f * s.xx * dx + s.xy * dy) * dx + 0.5f * s.yy * dy * dy;
        const float alpha = std::min(s.opacity * std::exp(-power), most_splat_alpha);
        if (alpha >= least_splat_alpha)
            found.push_back({densest(s, dx, dy, power, is_reciprocal), alpha, place});
    }
    std::ranges::stable_sort(found, std::greater{}, [](const InPixel& one) { return one.at.depth; });
}

}  // namespace

void SplatTile::blend_resorted(std::span<const ProjectedSplat> splats, std::span<const uint32_t> places) {
    thread_local std::vector<InPixel> found;
    const bool is_reciprocal = axis.c != 0;
    for (size_t at = 0; at < through.size(); ++at) {
        const int x = left + int(at) % size, y = top + int(at) / size;
        const Vec2 pixel(float(x) + 0.5f, float(y) + 0.5f);
        find_in_pixel(splats, places, pixel, is_reciprocal, found);
        for (const InPixel& one : found) {
            float& light = through[at];
            if (light < least_splat_transmittance) break;
            const ProjectedSplat& splat = splats[one.place];
            float alpha = one.alpha;
            if (is_limited) {
                const float to_farthest = deviations_to(farthest[at], one.at, splat, is_reciprocal),
                            to_nearest = deviations_to(nearest[at], one.at, splat, is_reciprocal),
                            margin = is_soft ? native::splat_reach : 0;
                if (!(to_farthest >= -margin && to_nearest < margin)) continue;
                if (to_farthest < margin || to_nearest >= -margin)
                    alpha = cut_opacity(alpha, to_farthest, to_nearest);
            }
            const float part = light * alpha, rest = light - part;
            red[at] += part * splat.red;
            green[at] += part * splat.green;
            blue[at] += part * splat.blue;
            if (sums_positions) positions[at] += part * axis.position_at(one.at.depth);
            if (light >= 0.5f && rest < 0.5f) median[at] = one.place;
            light = rest;
        }
    }
}

}  // namespace easypbr::render

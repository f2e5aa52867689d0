#include "easypbr/render/primitives/splats/splat_tile.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <vector>

namespace easypbr::render {
namespace {

// Neighbouring pixels of a row at once.
constexpr int width = 4;
using Floats = float __attribute__((vector_size(4 * width)));
using Ints = int32_t __attribute__((vector_size(4 * width)));

/// After so many splats a tile is looked at whether anything comes through.
constexpr size_t splats_between_looks = 16;

Floats same_in_all(float value) {
    return value - Floats{};
}

Floats load_pixels(const float* from) {
    Floats values;
    std::memcpy(&values, from, sizeof values);
    return values;
}

void store_pixels(float* to, Floats values) {
    std::memcpy(to, &values, sizeof values);
}

Floats smaller(Floats a, Floats b) {
    return a < b ? a : b;
}

bool any_set(Ints mask) {
    const auto halves = std::bit_cast<std::array<uint64_t, 2>>(mask);
    return (halves[0] | halves[1]) != 0;
}

/// exp(-x) for x from 0 to 6, to 3e-7 of the value: a power of two times the Taylor polynomial of the rest.
Floats falling_exp(Floats x) {
    const Floats t = x * -1.44269504f;
    const Ints whole = __builtin_convertvector(t - 0.5f, Ints);
    const Floats f = (t - __builtin_convertvector(whole, Floats)) * 0.69314718f;
    const Floats power =
        1 + f * (1 + f * (1.0f / 2 + f * (1.0f / 6 + f * (1.0f / 24 + f * (1.0f / 120 + f * (1.0f / 720))))));
    return power * std::bit_cast<Floats>(Ints((whole + 127) << 23));
}

/// Standard deviations from where a splat is densest, beyond which there is nothing of it: 1/4000.
constexpr float reach = 3.5f;

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

/// To first order a large splat reaches behind the camera or beyond all: no farther than this times its mean.
constexpr float farthest_part = 0.1f;

/// First and one past the last pixel of a tile whose centres lie in [low, high] of the frame.
std::array<int, 2> tile_span(float low, float high, int first) {
    const auto clamped = [](float pixel) { return int(std::clamp(pixel, 0.0f, float(SplatTile::size))); };
    return {clamped(std::ceil(low - 0.5f) - float(first)),
            clamped(std::floor(high - 0.5f) + 1 - float(first))};
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

bool SplatTile::is_opaque() const {
    return *std::max_element(through.begin(), through.end()) < least_splat_transmittance;
}

void SplatTile::blend(std::span<const ProjectedSplat> splats, std::span<const uint32_t> places) {
    for (size_t i = 0; i < places.size(); ++i) {
        if (i % splats_between_looks == 0 && is_opaque()) return;
        if (i + 8 < places.size()) __builtin_prefetch(&splats[places[i + 8]]);
        blend(splats[places[i]], places[i]);
    }
}

void SplatTile::blend(const ProjectedSplat& splat, uint32_t place) {
    const auto [x0, x1] = tile_span(splat.x - splat.half_width, splat.x + splat.half_width, left);
    const auto [y0, y1] = tile_span(splat.y - splat.half_height, splat.y + splat.half_height, top);
    const float farthest_power = std::log(splat.opacity / least_splat_alpha);
    const Floats steps = {0, 1, 2, 3};
    for (int y = y0; y < y1; ++y) {
        const float dy = float(top + y) + 0.5f - splat.y;
        const float own = 0.5f * splat.yy * dy * dy, mixed = splat.xy * dy;
        for (int x = x0 / width * width; x < x1; x += width) {
            const size_t at = size_t(y) * size + size_t(x);
            const Floats dx = steps + (float(left + x) + 0.5f - splat.x);
            const Floats power = (0.5f * splat.xx * dx + mixed) * dx + own;
            Floats light = load_pixels(&through[at]);
            Ints seen = (power <= farthest_power) & (light >= least_splat_transmittance);
            Ints is_cut = {};
            Floats to_farthest = {}, to_nearest = {}, depth = {};
            if (is_limited || sums_positions) depth = splat.depth_x * dx + (splat.depth + splat.depth_y * dy);
            if (is_limited) {
                to_farthest = (depth - load_pixels(&farthest[at])) * splat.sharpness;
                to_nearest = (depth - load_pixels(&nearest[at])) * splat.sharpness;
                const float margin = is_soft ? reach : 0;
                seen &= (to_farthest >= -margin) & (to_nearest < margin);
                is_cut = seen & ((to_farthest < margin) | (to_nearest >= -margin));
            }
            if (!any_set(seen)) continue;
            // Beyond these bounds are only pixels that are not seen, and rounding.
            const Floats kept = smaller(power > 0 ? power : same_in_all(0), same_in_all(6));
            Floats alpha = smaller(splat.opacity * falling_exp(kept), same_in_all(most_splat_alpha));
            if (any_set(is_cut))
                for (int i = 0; i < width; ++i)
                    if (is_cut[i]) alpha[i] = cut_opacity(alpha[i], to_farthest[i], to_nearest[i]);
            const Floats part = seen ? light * alpha : same_in_all(0);
            store_pixels(&red[at], load_pixels(&red[at]) + part * splat.red);
            store_pixels(&green[at], load_pixels(&green[at]) + part * splat.green);
            store_pixels(&blue[at], load_pixels(&blue[at]) + part * splat.blue);
            if (sums_positions) {
                const Floats least = same_in_all(farthest_part * splat.depth);
                const Floats position = axis.position_at(depth > least ? depth : least);
                store_pixels(&positions[at], load_pixels(&positions[at]) + part * position);
            }
            const Floats rest = light - part;
            store_pixels(&through[at], rest);
            const Ints crosses = (light >= 0.5f) & (rest < 0.5f);
            if (!any_set(crosses)) continue;
            for (int i = 0; i < width; ++i)
                if (crosses[i]) median[at + size_t(i)] = place;
        }
    }
}

namespace {

/// A splat in one pixel.
struct InPixel {
    float depth, alpha;
    uint32_t place;
};

/// Those of a pixel, from the nearest on; of equal depth in the order of the places.
void find_in_pixel(std::span<const ProjectedSplat> splats, std::span<const uint32_t> places,
                   const Vec2& pixel, std::vector<InPixel>& found) {
    found.clear();
    for (const uint32_t place : places) {
        const ProjectedSplat& s = splats[place];
        const float dx = pixel.x() - s.x, dy = pixel.y() - s.y;
        if (std::abs(dx) > s.half_width || std::abs(dy) > s.half_height) continue;
        const float power = (0.5f * s.xx * dx + s.xy * dy) * dx + 0.5f * s.yy * dy * dy;
        const float alpha = std::min(s.opacity * std::exp(-power), most_splat_alpha);
        if (alpha >= least_splat_alpha)
            found.push_back({s.depth_x * dx + (s.depth + s.depth_y * dy), alpha, place});
    }
    std::ranges::stable_sort(found, std::greater{}, &InPixel::depth);
}

}  // namespace

void SplatTile::blend_resorted(std::span<const ProjectedSplat> splats, std::span<const uint32_t> places) {
    thread_local std::vector<InPixel> found;
    for (size_t at = 0; at < through.size(); ++at) {
        const int x = left + int(at) % size, y = top + int(at) / size;
        const Vec2 pixel(float(x) + 0.5f, float(y) + 0.5f);
        find_in_pixel(splats, places, pixel, found);
        for (const InPixel& one : found) {
            float& light = through[at];
            if (light < least_splat_transmittance) break;
            const ProjectedSplat& splat = splats[one.place];
            float alpha = one.alpha;
            if (is_limited) {
                const float to_farthest = (one.depth - farthest[at]) * splat.sharpness,
                            to_nearest = (one.depth - nearest[at]) * splat.sharpness,
                            margin = is_soft ? reach : 0;
                if (!(to_farthest >= -margin && to_nearest < margin)) continue;
                if (to_farthest < margin || to_nearest >= -margin)
                    alpha = cut_opacity(alpha, to_farthest, to_nearest);
            }
            const float part = light * alpha, rest = light - part;
            red[at] += part * splat.red;
            green[at] += part * splat.green;
            blue[at] += part * splat.blue;
            if (sums_positions)
                positions[at] += part * axis.position_at(std::max(one.depth, farthest_part * splat.depth));
            if (light >= 0.5f && rest < 0.5f) median[at] = one.place;
            light = rest;
        }
    }
}

}  // namespace easypbr::render

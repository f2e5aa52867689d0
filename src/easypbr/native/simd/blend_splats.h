// Gaussian splats blended into tiles of the screen, for one instruction set.
#pragma once

#include "easypbr/native/kernels.h"
#include "easypbr/native/simd/lanes.h"

namespace easypbr::native::EASYPBR_ISA {
namespace {

constexpr int tile_size = SplatPixels::size;
/// After so many splats a tile is looked at whether anything comes through.
constexpr size_t splats_between_looks = 16;
constexpr size_t splats_ahead = 8;

INLINE vfloat load_pixels(const float* from) {
    Floats values;
    std::memcpy(&values, from, sizeof values);
    return values;
}
INLINE void store_pixels(float* to, vfloat value) {
    std::memcpy(to, &value.v, sizeof value.v);
}

/// 0, 1, 2, ...
INLINE vfloat counted_lanes() {
    Floats steps;
    for (int i = 0; i < lanes; ++i) steps[i] = float(i);
    return steps;
}

/// exp(-x) for x from 0 to 6, to 3e-7 of the value: a power of two times the Taylor polynomial of the rest.
INLINE vfloat falling_exp(vfloat x) {
    const vfloat t = x * -1.44269504f;
    const vint whole = to_int(t - 0.5f);
    const vfloat f = (t - to_float(whole)) * 0.69314718f;
    const vfloat power =
        1.0f +
        f * (1.0f + f * (1.0f / 2 + f * (1.0f / 6 + f * (1.0f / 24 + f * (1.0f / 120 + f * (1.0f / 720))))));
    return power * as_float(((whole + 127) << 23).v);
}

/// The part of a normal distribution below a number of standard deviations, to 1e-7 (Abramowitz and Stegun
/// 1964, 26.2.17).
INLINE vfloat normal_cdf(vfloat deviations) {
    const vfloat x = min(abs(deviations), 10.0f), t = 1.0f / (1.0f + 0.2316419f * x);
    const vfloat tail =
        0.39894228f * exp(-0.5f * x * x) * t *
        (0.319381530f + t * (-0.356563782f + t * (1.781477937f + t * (-1.821255978f + t * 1.330274429f))));
    return select(deviations < 0.0f, tail, 1.0f - tail);
}

/// The opacity of what a splat has between two limits, at these numbers of standard deviations along the ray.
/// Its density is a Gaussian there, and its opacity that of a medium of this density, so that both parts of a
/// splat that is cut let through together what the whole one does.
INLINE vfloat cut_opacity(vfloat opacity, vfloat to_farthest, vfloat to_nearest) {
    const vfloat part = normal_cdf(to_farthest) - normal_cdf(to_nearest);
    return 1.0f - exp(part * log(1.0f - opacity));
}

/// What deviations of reversed depths from the limits of a tile's pixels are multiplied with.
struct LimitScales {
    alignas(sizeof(Floats)) float farthest[tile_size * tile_size], nearest[tile_size * tile_size];
};

/// A splat's density is a Gaussian of the distance, not of the depth, its reciprocal in a perspective view.
/// With a standard deviation that grows with the distance, as that of a flat splat does where its rays are
/// longer, a limit is (depth - limit) mean / limit of the deviation at the mean away.
INLINE void find_limit_scales(const SplatPixels& tile, LimitScales& scales) {
    const bool is_reciprocal = tile.axis[2] != 0;
    for (size_t at = 0; at < tile_size * tile_size; at += lanes) {
        const vfloat farthest = clamp(load_pixels(tile.farthest + at), least_splat_limit, 1.0f),
                     nearest = clamp(load_pixels(tile.nearest + at), least_splat_limit, 1.0f);
        store_pixels(scales.farthest + at, is_reciprocal ? 1.0f / farthest : vfloat(1.0f));
        store_pixels(scales.nearest + at, is_reciprocal ? 1.0f / nearest : vfloat(1.0f));
    }
}

/// Where a splat is densest along the rays of pixels (see ScreenSplat), from the near plane on, and what
/// deviations of its limits are multiplied with.
struct Densest {
    vfloat depth, narrowing;
};
INLINE bool is_flat(const ScreenSplat& splat) {
    return splat.depth * splat.sharpness >= flat_splat_deviations;
}
/// Whether the depths of a splat are not those of first order in all pixels.
INLINE bool bends(const SplatPixels& tile, const ScreenSplat& splat) {
    if (tile.axis[2] == 0) return false;
    const float change = __builtin_fabsf(splat.depth_x) * splat.half_width +
                         __builtin_fabsf(splat.depth_y) * splat.half_height;
    return !(is_flat(splat) && change <= (1 - farthest_splat_part) * splat.depth &&
             splat.depth + change <= 1);
}
template <bool is_bent>
INLINE Densest densest(const ScreenSplat& splat, vfloat dx, float dy, vfloat power) {
    const vfloat first_order = splat.depth_x * dx + (splat.depth + splat.depth_y * dy);
    if (!is_bent) return {first_order, 1.0f};
    if (is_flat(splat)) return {clamp(first_order, farthest_splat_part * splat.depth, 1.0f), 1.0f};
    const vfloat straight = max(first_order, farthest_straight_part * splat.depth),
                 depth = straight + 2 / (splat.sharpness * splat.sharpness) * max(power, 0.0f) / straight;
    return {min(depth, 1.0f), sqrt(straight / depth)};
}

/// First and one past the last pixel of a tile whose centres lie in [low, high] of the frame.
struct PixelSpan {
    int first, end;
};
INLINE int to_pixel(float pixel) {
    return int(min(max(pixel, 0.0f), float(tile_size)));
}
INLINE PixelSpan span_of(float centre, float half, int first) {
    const float low = centre - half - 0.5f, high = centre + half - 0.5f;
    return {to_pixel(__builtin_ceilf(low) - float(first)),
            to_pixel(__builtin_floorf(high) + 1 - float(first))};
}

INLINE bool is_opaque(const SplatPixels& tile) {
    vbool seen = false;
    for (int i = 0; i < tile_size * tile_size; i += lanes)
        seen = seen || load_pixels(tile.through + i) >= least_splat_transmittance;
    return !any_lane(seen);
}

/// Of a part of a row where a splat may be seen.
template <bool is_limited, bool sums_positions, bool is_bent>
INLINE void blend_pixels(const SplatPixels& tile, const LimitScales& scales, const ScreenSplat& splat,
                         uint32_t place, vfloat dx, float dy, vfloat farthest_power, size_t at) {
    const vfloat power = (vfloat(0.5f * splat.xx) * dx + splat.xy * dy) * dx + 0.5f * splat.yy * dy * dy;
    const vfloat light = load_pixels(tile.through + at);
    vbool seen = power <= farthest_power && light >= least_splat_transmittance;
    if (is_bent && !any_lane(seen)) return;
    vbool is_cut = false;
    vfloat to_farthest = 0.0f, to_nearest = 0.0f;
    Densest at_ray{0.0f, 1.0f};
    if (is_limited || sums_positions) at_ray = densest<is_bent>(splat, dx, dy, power);
    if (is_limited) {
        const float mean = tile.axis[2] != 0 ? splat.depth : 1;
        const vfloat sharpness = is_bent ? splat.sharpness * at_ray.narrowing : vfloat(splat.sharpness);
        to_farthest = (at_ray.depth - load_pixels(tile.farthest + at)) * sharpness *
                      (mean * load_pixels(scales.farthest + at));
        to_nearest = (at_ray.depth - load_pixels(tile.nearest + at)) * sharpness *
                     (mean * load_pixels(scales.nearest + at));
        const float margin = tile.is_soft ? splat_reach : 0;
        seen = seen && to_farthest >= -margin && to_nearest < margin;
        is_cut = seen && (to_farthest < margin || to_nearest >= -margin);
    }
    if (!any_lane(seen)) return;
    // Beyond these bounds are only pixels that are not seen, and rounding.
    vfloat alpha = min(splat.opacity * falling_exp(clamp(power, 0.0f, 6.0f)), most_splat_alpha);
    if (is_limited && any_lane(is_cut))
        alpha = select(is_cut, cut_opacity(alpha, to_farthest, to_nearest), alpha);
    const vfloat part = select(seen, light * alpha, vfloat(0.0f)), rest = light - part;
    store_pixels(tile.red + at, load_pixels(tile.red + at) + part * splat.red);
    store_pixels(tile.green + at, load_pixels(tile.green + at) + part * splat.green);
    store_pixels(tile.blue + at, load_pixels(tile.blue + at) + part * splat.blue);
    store_pixels(tile.through + at, rest);
    if (sums_positions) {
        const float* axis = tile.axis;
        const vfloat position = (axis[1] - at_ray.depth * axis[3]) / (at_ray.depth * axis[2] - axis[0]);
        store_pixels(tile.positions + at, load_pixels(tile.positions + at) + part * position);
    }
    const vbool crosses = light >= 0.5f && rest < 0.5f;
    if (!any_lane(crosses)) return;
    for (int i = 0; i < lanes; ++i)
        if (crosses.v[i]) tile.median[at + size_t(i)] = place;
}

template <bool is_limited, bool sums_positions, bool is_bent>
void blend_one(const SplatPixels& tile, const LimitScales& scales, const ScreenSplat& splat, uint32_t place) {
    const PixelSpan columns = span_of(splat.x, splat.half_width, tile.left),
                    rows = span_of(splat.y, splat.half_height, tile.top);
    const vfloat farthest_power = log(vfloat(splat.opacity / least_splat_alpha)), steps = counted_lanes();
    for (int y = rows.first; y < rows.end; ++y) {
        const float dy = float(tile.top + y) + 0.5f - splat.y;
        for (int x = columns.first / lanes * lanes; x < columns.end; x += lanes)
            blend_pixels<is_limited, sums_positions, is_bent>(
                tile, scales, splat, place, steps + (float(tile.left + x) + 0.5f - splat.x), dy,
                farthest_power, size_t(y) * tile_size + size_t(x));
    }
}

template <bool is_limited, bool sums_positions>
void blend_all(const SplatPixels& tile, const ScreenSplat* splats, const uint32_t* places, size_t count) {
    LimitScales scales;
    if (is_limited) find_limit_scales(tile, scales);
    for (size_t i = 0; i < count; ++i) {
        if (i % splats_between_looks == 0 && is_opaque(tile)) return;
        if (i + splats_ahead < count) __builtin_prefetch(&splats[places[i + splats_ahead]]);
        const ScreenSplat& splat = splats[places[i]];
        if ((is_limited || sums_positions) && bends(tile, splat))
            blend_one<is_limited, sums_positions, true>(tile, scales, splat, places[i]);
        else
            blend_one<is_limited, sums_positions, false>(tile, scales, splat, places[i]);
    }
}

void blend_splats(const SplatPixels& tile, const ScreenSplat* splats, const uint32_t* places, size_t count) {
    if (tile.farthest)
        tile.positions ? blend_all<true, true>(tile, splats, places, count)
                       : blend_all<true, false>(tile, splats, places, count);
    else
        tile.positions ? blend_all<false, true>(tile, splats, places, count)
                       : blend_all<false, false>(tile, splats, places, count);
}

}  // namespace
}  // namespace easypbr::native::EASYPBR_ISA

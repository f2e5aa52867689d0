// Sums of noisy light, and means of the surfaces that send it.
#pragma once

#include "easypbr/native/simd/camera_places.h"

namespace easypbr::native::EASYPBR_ISA {

using LaneBytes = uint8_t __attribute__((vector_size(lanes)));
using LaneShorts = uint16_t __attribute__((vector_size(2 * lanes)));
using HalfLongs = uint64_t __attribute__((vector_size(8 * half_lanes)));

/// The halves of 64 bits each.
INLINE void load_halves(const uint64_t* from, vuint& low, vuint& high) {
    for (int k = 0; k < lanes; k += half_lanes) {
        const auto bits = load<HalfLongs>(from + k);
        const HalfInts lower = __builtin_convertvector(bits, HalfInts),
                       upper = __builtin_convertvector(bits >> 32, HalfInts);
        std::memcpy(reinterpret_cast<char*>(&low.v) + 4 * k, &lower, sizeof lower);
        std::memcpy(reinterpret_cast<char*>(&high.v) + 4 * k, &upper, sizeof upper);
    }
}

/// Adds to lanes of a sum.
INLINE void add_lanes(float* sum, vbool where, vfloat value) {
    const vfloat before = load<Floats>(sum);
    store_lanes(sum, 0, select(where, before + value, before));
}

/// Moves means of steps of 1 / 65535 by a part of the way to a value.
INLINE void move_steps(uint16_t* mean, vbool where, vfloat to, vfloat part) {
    const Ints before = __builtin_convertvector(load<LaneShorts>(mean), Ints);
    const vfloat from = to_float(vint(before)),
                 moved = round(from + (clamp(to, 0.0f, 1.0f) * 65535.0f - from) * part);
    const vint steps = select(where, vint(truncated(moved.v)), vint(before));
    const LaneShorts after = __builtin_convertvector(steps.v, LaneShorts);
    std::memcpy(mean, &after, sizeof after);
}

/// About what part of the light surfaces send back, diffuse and at normal incidence; of those that fade less
/// of it, as their radiance does.
INLINE vec3 sent_back(const vec3& base, vfloat metallic, vfloat coverage) {
    const vfloat dielectric = 0.04f * (1.0f - metallic), part = clamp(coverage, 0.0f, 1.0f);
    return {min(base.x + dielectric, 1.0f) * part, min(base.y + dielectric, 1.0f) * part,
            min(base.z + dielectric, 1.0f) * part};
}

/// `first`: of the lanes in the row; `place`: in the tile.
INLINE bool add_noisy_lanes(const NoisyRow& row, int first, int place, NoisyTile& tile, BesideNoisy& beside) {
    // A surface that has faded further is as good as not there.
    constexpr float least_coverage = 1.0f / 64;
    const vuint material = load<Uints>(row.material + first);
    const vint kind = to_int(material >> 24);
    const vec4 sample = load_row<FloatPixel>(reinterpret_cast<const std::byte*>(row.sample + 4 * first));
    const vfloat depth = load<Floats>(row.depth + first),
                 open = row.open ? vfloat(load<Floats>(row.open + first)) : vfloat(1.0f);
    const vbool lit = kind < row.end_of_lit;
    const vbool is_noisy = depth > 0.0f && ((lit && sample.w >= least_coverage) || kind == row.catcher);
    const vbool of_coverage = !lit && vbool(Ints(splat(row.over_nothing ? -1 : 0)));
    const vint kinds = select(of_coverage, vint(2), vint(1)),
               before = __builtin_convertvector(load<LaneBytes>(tile.noisy + place), Ints);
    const vbool taken = is_noisy && (before == 0 || before == kinds);
    const LaneBytes noisy = __builtin_convertvector(select(taken, kinds, before).v, LaneBytes);
    std::memcpy(tile.noisy + place, &noisy, sizeof noisy);
    const vint counted = select(taken, kinds, vint(0));
    std::memcpy(beside.taken + first, &counted.v, sizeof counted.v);

    const vfloat light[3] = {select(of_coverage, sample.w, sample.x), select(of_coverage, sample.w, sample.y),
                             select(of_coverage, sample.w, sample.z)};
    const vfloat bright = 0.2126f * light[0] + 0.7152f * light[1] + 0.0722f * light[2];
    for (int c = 0; c < 3; ++c) add_lanes(tile.light[c] + place, taken, light[c]);
    add_lanes(tile.squares + place, taken, bright * bright);
    add_lanes(tile.hue_squares + NoisyTile::hue_place(place), taken,
              light[0] * light[0] + light[2] * light[2]);
    add_lanes(tile.alpha + place, taken && !of_coverage, open * sample.w);

    // What overlays hide of noisy light is taken back.
    const vfloat hidden = open - 1.0f;
    const vbool is_whole = open == 1.0f;
    const auto left = [&](vfloat of_light) __attribute__((always_inline)) {
        return select(is_whole, vfloat(0.0f), hidden * of_light);
    };
    const vfloat own[4] = {sample.x, sample.y, sample.z, sample.w};
    vbool any = false;
    for (int c = 0; c < 4; ++c) {
        const vfloat of_noisy = c < 3 ? select(of_coverage, open * own[c], left(own[c]))
                                      : select(of_coverage, left(bright), vfloat(0.0f));
        const vfloat value = select(taken, of_noisy, open * own[c]);
        store_lanes(beside.radiance[c], size_t(first), value);
        any = any || value != 0.0f;
    }
    if (any_lane(taken)) {
        const vuint frames = vuint(load<Uints>(tile.frames + place)) + select(taken, vuint(1u), vuint(0u));
        std::memcpy(tile.frames + place, &frames.v, sizeof frames.v);
        const vfloat part = vfloat(1.0f) / max(to_float(frames), 1.0f);
        vuint red_green, blue;
        load_halves(row.albedo + first, red_green, blue);
        const vec3 base(to_float(red_green & 0xffffu) / 65535.0f, to_float(red_green >> 16) / 65535.0f,
                        to_float(blue & 0xffffu) / 65535.0f);
        // Shadows that are seen through layers cover without sending light.
        const vfloat coverage = row.layered ? min(sample.w, to_float(blue >> 16) / 65535.0f) : sample.w;
        const vec3 part_of_light = sent_back(base, to_float(material & 0xffu) / 255.0f, coverage);
        const vec3 normal = decoded_normal(load<Uints>(row.normal + first));
        for (int c = 0; c < 3; ++c) {
            move_steps(tile.normal[c] + place, taken, (normal[c] + 1.0f) * 0.5f, part);
            move_steps(tile.reflectance[c] + place, taken, select(lit, part_of_light[c], vfloat(1.0f)), part);
        }
        const vfloat mean = load<Floats>(tile.depth + place),
                     of_frame = row.orthographic ? depth : log2(max(depth, 1e-37f));
        add_lanes(tile.depth + place, taken, (of_frame - mean) * part);
    }
    return any_lane(any);
}

inline bool add_noisy_row(const NoisyRow& row, int y, NoisyTile& tile, BesideNoisy& beside) {
    bool any = false;
    for (int first = 0; first < NoisyRow::pixels; first += lanes)
        any |= add_noisy_lanes(row, first, y * NoisyRow::pixels + first, tile, beside);
    return any;
}

}  // namespace easypbr::native::EASYPBR_ISA

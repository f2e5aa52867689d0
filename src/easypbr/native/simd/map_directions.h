// Directions and their places in equirectangular maps, as render::equirect_uv() has them.
#pragma once

#include "easypbr/native/simd/texels.h"

namespace easypbr::native::EASYPBR_ISA {

/// Arc tangent of y / x in the right quadrant, to 5e-7; 0 at the origin (Abramowitz and Stegun 1964, 4.4.49).
INLINE vfloat exact_atan(vfloat y, vfloat x) {
    const vfloat ax = abs(x), ay = abs(y), most = max(ax, ay), least = min(ax, ay);
    const vfloat t = select(most > 0.0f, least / most, vfloat(0.0f)), t2 = t * t;
    constexpr float factors[] = {-0.0161657367f, 0.0429096138f, -0.0752896400f, 0.1065626393f,
                                 -0.1420889944f, 0.1999355085f, -0.3333314528f, 1.0f};
    vfloat angle = 0.0028662257f;
    for (const float factor : factors) angle = angle * t2 + factor;
    angle *= t;
    angle = select(ay > ax, 1.57079633f - angle, angle);
    angle = select(x < 0.0f, 3.14159265f - angle, angle);
    return select(y < 0.0f, -angle, angle);
}

INLINE vec3 rotated(const float (&rotation)[3][3], const vec3& v) {
    const auto row = [&](int r) __attribute__((always_inline)) {
        return rotation[0][r] * v.x + rotation[1][r] * v.y + rotation[2][r] * v.z;
    };
    return {row(0), row(1), row(2)};
}

inline void find_map_places(const float (&rotation)[3][3], const float* const (&directions)[3], int count,
                            float* u, float* v) {
    constexpr float per_turn = 0.159154943f, per_half = 0.318309886f;
    for (int first = 0; first < count; first += lanes) {
        const vec3 d =
            rotated(rotation, {load<Floats>(directions[0] + first), load<Floats>(directions[1] + first),
                               load<Floats>(directions[2] + first)});
        store_lanes(u, size_t(first), 0.5f + exact_atan(d.x, -d.z) * per_turn);
        store_lanes(v, size_t(first), exact_atan(sqrt(d.x * d.x + d.z * d.z), d.y) * per_half);
    }
}

inline void find_map_directions(const float (&rotation)[3][3], const float* u, const float* cosines,
                                const float* sines, int count, float* const (&directions)[3]) {
    for (int first = 0; first < count; first += lanes) {
        const vfloat phi = 6.28318531f * (vfloat(load<Floats>(u + first)) - 0.5f),
                     level = load<Floats>(sines + first);
        vfloat sine, cosine;
        sin_cos(phi, sine, cosine);
        const vec3 d = rotated(rotation, {level * sine, load<Floats>(cosines + first), -(level * cosine)});
        for (int c = 0; c < 3; ++c) store_lanes(directions[c], size_t(first), d[c]);
    }
}

}  // namespace easypbr::native::EASYPBR_ISA

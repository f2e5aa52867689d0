// GLSL's functions that pack several values into 32 bits.
#pragma once

#include "easypbr/native/simd/samplers.h"

namespace easypbr::native::EASYPBR_ISA {

INLINE vuint packed_unorm(vfloat c, float most) {
    return vuint(round(clamp(c, 0.0f, 1.0f) * most));
}
INLINE vuint packUnorm2x16(const vec2& v) {
    return packed_unorm(v.x, 65535.0f) | packed_unorm(v.y, 65535.0f) << 16u;
}
INLINE vec2 unpackUnorm2x16(vuint bits) {
    return {to_float(bits & 0xffffu) * (1.0f / 65535.0f), to_float(bits >> 16) * (1.0f / 65535.0f)};
}
INLINE vuint packUnorm4x8(const vec4& v) {
    return packed_unorm(v.x, 255.0f) | packed_unorm(v.y, 255.0f) << 8u | packed_unorm(v.z, 255.0f) << 16u |
           packed_unorm(v.w, 255.0f) << 24u;
}
INLINE vec4 unpackUnorm4x8(vuint bits) {
    return from_bytes(to_int(bits));
}
INLINE vuint packHalf2x16(const vec2& v) {
    Uints bits;
    for (int k = 0; k < lanes; ++k) {
        const Shorts4 halves = to_halves(Floats4{v.x.v[k], v.y.v[k], 0.0f, 0.0f});
        bits[k] = uint32_t(halves[0]) | uint32_t(halves[1]) << 16;
    }
    return bits;
}
INLINE vec2 unpackHalf2x16(vuint bits) {
    vec2 v;
    for (int k = 0; k < lanes; ++k) {
        const Floats4 values = from_halves(Shorts4{uint16_t(bits.v[k]), uint16_t(bits.v[k] >> 16), 0, 0});
        v.x.v[k] = values[0];
        v.y.v[k] = values[1];
    }
    return v;
}

INLINE uvec4 texelFetch(const Rgba32ui& s, const ivec2& p, int) {
    const vec4 bits = fetch_pixels<FloatPixel>(s, p.x, p.y);
    return {floatBitsToUint(bits.x), floatBitsToUint(bits.y), floatBitsToUint(bits.z),
            floatBitsToUint(bits.w)};
}

}  // namespace easypbr::native::EASYPBR_ISA

// Single texels of pictures in host memory, of all formats: GLSL's texelFetch().
#pragma once

#include "easypbr/native/simd/vectors.h"

namespace easypbr::native::EASYPBR_ISA {

using Floats4 = float __attribute__((vector_size(16)));
using Floats8 = float __attribute__((vector_size(32)));
using Ints4 = int32_t __attribute__((vector_size(16)));
using Ints8 = int32_t __attribute__((vector_size(32)));
using Shorts4 = uint16_t __attribute__((vector_size(8)));
using Shorts8 = uint16_t __attribute__((vector_size(16)));
using Bytes4 = uint8_t __attribute__((vector_size(4)));
using Bytes8 = uint8_t __attribute__((vector_size(8)));

template <class T>
INLINE T load(const void* from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

/// Four channels of each lane, from one pixel per lane.
INLINE vec4 channels_of(const Floats4* pixels) {
    vec4 c;
    for (int k = 0; k < lanes; ++k) {
        c.x.v[k] = pixels[k][0];
        c.y.v[k] = pixels[k][1];
        c.z.v[k] = pixels[k][2];
        c.w.v[k] = pixels[k][3];
    }
    return c;
}
#if defined(__AVX2__)
/// The same for 8 lanes: a transposition.
INLINE void transpose8(const Floats4* p, Floats8* to) {
    const __m256 a = _mm256_set_m128(p[4], p[0]), b = _mm256_set_m128(p[5], p[1]),
                 c = _mm256_set_m128(p[6], p[2]), d = _mm256_set_m128(p[7], p[3]);
    const __m256 ab_low = _mm256_unpacklo_ps(a, b), ab_high = _mm256_unpackhi_ps(a, b),
                 cd_low = _mm256_unpacklo_ps(c, d), cd_high = _mm256_unpackhi_ps(c, d);
    to[0] = Floats8(_mm256_shuffle_ps(ab_low, cd_low, 0x44));
    to[1] = Floats8(_mm256_shuffle_ps(ab_low, cd_low, 0xee));
    to[2] = Floats8(_mm256_shuffle_ps(ab_high, cd_high, 0x44));
    to[3] = Floats8(_mm256_shuffle_ps(ab_high, cd_high, 0xee));
}
#endif
INLINE vec4 planar(const Floats4* pixels) {
#if defined(__AVX512F__)
    Floats8 low[4], high[4];
    transpose8(pixels, low);
    transpose8(pixels + 8, high);
    const auto both = [&](int i) {
        return vfloat(Floats(_mm512_insertf32x8(_mm512_castps256_ps512(low[i]), high[i], 1)));
    };
    return {both(0), both(1), both(2), both(3)};
#elif defined(__AVX2__)
    Floats8 c[4];
    transpose8(pixels, c);
    return {vfloat(c[0]), vfloat(c[1]), vfloat(c[2]), vfloat(c[3])};
#else
    return channels_of(pixels);
#endif
}

INLINE uint32_t bits_of(float v) {
    return load<uint32_t>(&v);
}
INLINE float as_scalar(uint32_t bits) {
    return load<float>(&bits);
}
// Halves that are numbers: exact.
INLINE Floats8 from_halves(Shorts8 h) {
#if defined(__F16C__)
    return Floats8(_mm256_cvtph_ps(__m128i(h)));
#else
    const Ints8 bits = __builtin_convertvector(h, Ints8);
    return Floats8((bits & 0x7fff) << 13 | (bits & 0x8000) << 16) * 0x1p112f;
#endif
}
INLINE uint16_t to_half(float v) {
    const uint32_t bits = bits_of(v), sign = bits >> 16 & 0x8000u;
    uint32_t size = bits & 0x7fffffffu;
    if (size > 0x7f800000u) return uint16_t(sign | 0x7e00u | (size >> 13 & 0x3ffu));
    if (size >= 0x477ff000u) return uint16_t(sign | 0x7c00u);
    // Adding a half shifts a denormal one's bits to the end of the mantissa, and rounds.
    if (size < 0x38800000u) return uint16_t(sign | (bits_of(as_scalar(size) + 0.5f) - 0x3f000000u));
    size += 0xc8000fffu + (size >> 13 & 1u);
    return uint16_t(sign | size >> 13);
}
INLINE Floats4 from_halves(Shorts4 h) {
    const Ints4 bits = __builtin_convertvector(h, Ints4);
    return Floats4((bits & 0x7fff) << 13 | (bits & 0x8000) << 16) * 0x1p112f;
}
/// Rounded to the nearest; those beyond the largest half are infinite.
INLINE Shorts4 to_halves(Floats4 v) {
#if defined(__F16C__)
    return __builtin_shufflevector(Shorts8(_mm_cvtps_ph(__m128(v), 0)), Shorts8{}, 0, 1, 2, 3);
#else
    Shorts4 halves;
    for (int i = 0; i < 4; ++i) halves[i] = to_half(v[i]);
    return halves;
#endif
}
INLINE Floats4 low_half(Floats8 v) {
    return Floats4{v[0], v[1], v[2], v[3]};
}
INLINE Floats4 high_half(Floats8 v) {
    return Floats4{v[4], v[5], v[6], v[7]};
}

INLINE vint gather(const int32_t* from, vint index) {
    Ints r;
    for (int k = 0; k < lanes; ++k) r[k] = from[index.v[k]];
    return r;
}

/// Where lanes fetch from a view, by row and column; what lies outside of what is held is zero.
struct Place {
    vint index;
    vbool inside;
    bool all_inside, side_by_side;
};
INLINE Place place_of(const View& s, vint x, vint y) {
    x = clamp(x, 0, s.width - 1) - s.x;
    y = clamp(y, 0, s.height - 1) - s.y;
    const vbool inside = x >= 0 && x < s.held_width && y >= 0 && y < s.held_height;
    const vint index = y * s.held_width + x;
    const Ints steps = index.v - splat(index.v[0]);
    return {select(inside, index, vint(0)), inside, !any_lane(!inside),
            !any_lane(vbool(Ints(steps != lane_numbers().v)))};
}

/// One value of 32 bits per pixel.
INLINE vint fetch_bits(const View& s, vint x, vint y) {
    const Place p = place_of(s, x, y);
    const auto* data = reinterpret_cast<const int32_t*>(s.data);
    if (p.all_inside && p.side_by_side) return load<Ints>(data + p.index.v[0]);
    if (p.all_inside) return gather(data, p.index);
    if (!any_lane(p.inside)) return 0;
    return select(p.inside, gather(data, p.index), vint(0));
}
/// One pixel per lane, by a function of its index.
template <class Load>
INLINE vec4 fetch_pixels(const View& s, vint x, vint y, Load&& load_pixel) {
    const Place p = place_of(s, x, y);
    if (!any_lane(p.inside)) return vec4(vfloat(0.0f));
    Floats4 pixels[lanes];
    if (p.all_inside && p.side_by_side) {
        const int first = p.index.v[0];
        for (int k = 0; k < lanes; ++k) pixels[k] = load_pixel(first + k);
    } else {
        for (int k = 0; k < lanes; ++k) pixels[k] = load_pixel(p.index.v[k]);
    }
    const vec4 c = planar(pixels);
    return p.all_inside ? c : select(p.inside, c, vec4(vfloat(0.0f)));
}

INLINE vec4 fetch(const R32f& s, vint x, vint y) {
    return {vfloat(Floats(fetch_bits(s, x, y).v)), 0.0f, 0.0f, 1.0f};
}
INLINE vec4 fetch(const R16& s, vint x, vint y) {
    const Place p = place_of(s, x, y);
    if (!any_lane(p.inside)) return vec4(0.0f, 0.0f, 0.0f, 1.0f);
    Ints r;
    for (int k = 0; k < lanes; ++k) r[k] = load<uint16_t>(s.data + 2 * size_t(p.index.v[k]));
    return {to_float(select(p.inside, vint(r), vint(0))) * (1.0f / 65535.0f), 0.0f, 0.0f, 1.0f};
}
INLINE vec4 fetch(const Rg16& s, vint x, vint y) {
    const vint bits = fetch_bits(s, x, y);
    return {to_float(bits & 0xffff) * (1.0f / 65535.0f), to_float(vuint(bits) >> 16) * (1.0f / 65535.0f),
            0.0f, 1.0f};
}
/// Integers have one channel.
struct upixel {
    vuint x;
};
INLINE upixel texelFetch(const R32ui& s, const ivec2& p, int) {
    return {vuint(fetch_bits(s, p.x, p.y))};
}
INLINE vec4 fetch(const Rg8& s, vint x, vint y) {
    const Place p = place_of(s, x, y);
    if (!any_lane(p.inside)) return vec4(0.0f, 0.0f, 0.0f, 1.0f);
    Ints r;
    for (int k = 0; k < lanes; ++k) r[k] = load<uint16_t>(s.data + 2 * size_t(p.index.v[k]));
    const vint bits = select(p.inside, vint(r), vint(0));
    return {to_float(bits & 255) * (1.0f / 255.0f), to_float(bits >> 8) * (1.0f / 255.0f), 0.0f, 1.0f};
}
INLINE vec4 from_bytes(vint bits) {
    constexpr float scale = 1.0f / 255.0f;
    return {to_float(bits & 255) * scale, to_float(bits >> 8 & 255) * scale,
            to_float(bits >> 16 & 255) * scale, to_float(vuint(bits) >> 24) * scale};
}
INLINE vec4 fetch(const Rgba8& s, vint x, vint y) {
    return from_bytes(fetch_bits(s, x, y));
}
INLINE vec4 fetch(const Rgba16& s, vint x, vint y) {
    const vec4 c = fetch_pixels(
        s, x, y, [&](int i) __attribute__((always_inline)) {
            return __builtin_convertvector(
                __builtin_convertvector(load<Shorts4>(s.data + 8 * size_t(i)), Ints4), Floats4);
        });
    return c * (1.0f / 65535.0f);
}
INLINE vec4 fetch(const EncodedLinear& s, vint x, vint y) {
    return s.pixel_bytes == 8 ? fetch(Rgba16{s}, x, y) : fetch(Rgba8{s}, x, y);
}
INLINE vec4 fetch(const Rgba16f& s, vint x, vint y) {
    return fetch_pixels(
        s, x, y, [&](int i) __attribute__((always_inline)) {
            return from_halves(load<Shorts4>(s.data + 8 * size_t(i)));
        });
}
INLINE vec4 fetch(const Rgba16fLinear& s, vint x, vint y) {
    return fetch(Rgba16f{s}, x, y);
}
INLINE vec4 fetch(const Rgba32f& s, vint x, vint y) {
    return fetch_pixels(
        s, x,
        y, [&](int i) __attribute__((always_inline)) { return load<Floats4>(s.data + 16 * size_t(i)); });
}
INLINE vec4 fetch(const Rgba32fLinear& s, vint x, vint y) {
    return fetch(Rgba32f{s}, x, y);
}
INLINE vec4 fetch(const R16fLinear& s, vint x, vint y) {
    const Place p = place_of(s, x, y);
    Floats4 pixels[lanes];
    for (int k = 0; k < lanes; ++k) {
        const auto half = load<uint16_t>(s.data + 2 * size_t(p.index.v[k]));
        pixels[k] = from_halves(Shorts4{half, 0, 0, 0});
    }
    return planar(pixels);
}

template <class Sampler>
INLINE vec4 texelFetch(const Sampler& s, const ivec2& p, int) {
    return fetch(s, p.x, p.y);
}

}  // namespace easypbr::native::EASYPBR_ISA

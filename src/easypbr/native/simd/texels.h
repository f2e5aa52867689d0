// Single texels of pictures in host memory, of all formats: GLSL's texelFetch().
#pragma once

#include "easypbr/native/simd/vectors.h"

namespace easypbr::native::EASYPBR_ISA {

using Floats4 = float __attribute__((vector_size(16)));
using Floats8 = float __attribute__((vector_size(32)));
using Ints4 = int32_t __attribute__((vector_size(16)));
using Ints8 = int32_t __attribute__((vector_size(32)));
using Shorts = uint16_t __attribute__((vector_size(2 * lanes)));
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

// GCC 12 converts vectors of 8 bytes element by element.
INLINE Ints8 widened(Bytes8 v) {
#if defined(__AVX2__)
    return Ints8(_mm256_cvtepu8_epi32(_mm_cvtsi64_si128(load<int64_t>(&v))));
#elif defined(__SSE4_1__)
    const __m128i bytes = _mm_cvtsi64_si128(load<int64_t>(&v));
    const Ints4 first = Ints4(_mm_cvtepu8_epi32(bytes)),
                last = Ints4(_mm_cvtepu8_epi32(_mm_srli_si128(bytes, 4)));
    return __builtin_shufflevector(first, last, 0, 1, 2, 3, 4, 5, 6, 7);
#else
    return __builtin_convertvector(v, Ints8);
#endif
}
INLINE Ints8 widened(Shorts8 v) {
#if defined(__AVX2__)
    return Ints8(_mm256_cvtepu16_epi32(__m128i(v)));
#else
    return __builtin_convertvector(v, Ints8);
#endif
}

/// Four channels of a pixel for each lane, as pictures hold them.
struct PixelRow {
    Floats v[4];
};

#if defined(__AVX2__)
/// Four channels of 8 pixels, or the pixels of four channels of which each register has half of one and half
/// of that four further: a transposition of each half.
INLINE void transpose8(const __m256 (&from)[4], Floats8* to) {
    const __m256 ab_low = _mm256_unpacklo_ps(from[0], from[1]),
                 ab_high = _mm256_unpackhi_ps(from[0], from[1]),
                 cd_low = _mm256_unpacklo_ps(from[2], from[3]),
                 cd_high = _mm256_unpackhi_ps(from[2], from[3]);
    to[0] = Floats8(_mm256_shuffle_ps(ab_low, cd_low, 0x44));
    to[1] = Floats8(_mm256_shuffle_ps(ab_low, cd_low, 0xee));
    to[2] = Floats8(_mm256_shuffle_ps(ab_high, cd_high, 0x44));
    to[3] = Floats8(_mm256_shuffle_ps(ab_high, cd_high, 0xee));
}
INLINE void transpose8(const Floats4* p, Floats8* to) {
    transpose8({_mm256_set_m128(p[4], p[0]), _mm256_set_m128(p[5], p[1]), _mm256_set_m128(p[6], p[2]),
                _mm256_set_m128(p[7], p[3])},
               to);
}
#endif

#if defined(__AVX2__) && !defined(__AVX512F__)
// Shuffles across the halves of a register need an index, and of two registers a blend.
INLINE PixelRow interleaved(const vec4& c) {
    Floats8 p[4];  // pixels k and k + 4 each
    transpose8({c.x.v, c.y.v, c.z.v, c.w.v}, p);
    return {{_mm256_permute2f128_ps(p[0], p[1], 0x20), _mm256_permute2f128_ps(p[2], p[3], 0x20),
             _mm256_permute2f128_ps(p[0], p[1], 0x31), _mm256_permute2f128_ps(p[2], p[3], 0x31)}};
}
INLINE vec4 planar(const PixelRow& row) {
    Floats8 c[4];
    transpose8(
        {_mm256_permute2f128_ps(row.v[0], row.v[2], 0x20), _mm256_permute2f128_ps(row.v[0], row.v[2], 0x31),
         _mm256_permute2f128_ps(row.v[1], row.v[3], 0x20), _mm256_permute2f128_ps(row.v[1], row.v[3], 0x31)},
        c);
    return {vfloat(c[0]), vfloat(c[1]), vfloat(c[2]), vfloat(c[3])};
}
#else
// Values of two vectors by turns, the first halves and the last ones; and every second value of both.
#if defined(__AVX512F__)
#define ZIPPED_FIRST 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23
#define ZIPPED_LAST 8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31
#define EVEN 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30
#define ODD 1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31
#else
#define ZIPPED_FIRST 0, 4, 1, 5
#define ZIPPED_LAST 2, 6, 3, 7
#define EVEN 0, 2, 4, 6
#define ODD 1, 3, 5, 7
#endif
INLINE PixelRow interleaved(const vec4& c) {
    const Floats xz0 = __builtin_shufflevector(c.x.v, c.z.v, ZIPPED_FIRST),
                 xz1 = __builtin_shufflevector(c.x.v, c.z.v, ZIPPED_LAST),
                 yw0 = __builtin_shufflevector(c.y.v, c.w.v, ZIPPED_FIRST),
                 yw1 = __builtin_shufflevector(c.y.v, c.w.v, ZIPPED_LAST);
    return {{__builtin_shufflevector(xz0, yw0, ZIPPED_FIRST), __builtin_shufflevector(xz0, yw0, ZIPPED_LAST),
             __builtin_shufflevector(xz1, yw1, ZIPPED_FIRST),
             __builtin_shufflevector(xz1, yw1, ZIPPED_LAST)}};
}
INLINE vec4 planar(const PixelRow& row) {
    const Floats xz0 = __builtin_shufflevector(row.v[0], row.v[1], EVEN),
                 xz1 = __builtin_shufflevector(row.v[2], row.v[3], EVEN),
                 yw0 = __builtin_shufflevector(row.v[0], row.v[1], ODD),
                 yw1 = __builtin_shufflevector(row.v[2], row.v[3], ODD);
    return {vfloat(__builtin_shufflevector(xz0, xz1, EVEN)), vfloat(__builtin_shufflevector(yw0, yw1, EVEN)),
            vfloat(__builtin_shufflevector(xz0, xz1, ODD)), vfloat(__builtin_shufflevector(yw0, yw1, ODD))};
}
#undef ODD
#undef EVEN
#undef ZIPPED_LAST
#undef ZIPPED_FIRST

#endif

/// Four channels of each lane, from one pixel per lane.
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
    return planar(load<PixelRow>(pixels));
#endif
}

INLINE uint32_t bits_of(float v) {
    return load<uint32_t>(&v);
}
INLINE float as_scalar(uint32_t bits) {
    return load<float>(&bits);
}
/// Floats from the bits of halves that are numbers: exact, and without subnormal floats on the way.
template <class Values, class Bits>
INLINE Values widened_halves(Bits bits) {
    const Bits size = bits & 0x7fff, subnormal = size < 0x400;
    const Bits normal_bits = (size << 13) + (112 << 23),
               subnormal_bits = Bits(__builtin_convertvector(size, Values) * 0x1p-24f);
    return Values((subnormal & subnormal_bits) | (~subnormal & normal_bits) | (bits & 0x8000) << 16);
}
INLINE Floats8 from_halves(Shorts8 h) {
#if defined(__F16C__)
    return Floats8(_mm256_cvtph_ps(__m128i(h)));
#else
    return widened_halves<Floats8>(__builtin_convertvector(h, Ints8));
#endif
}
#if defined(__AVX512F__)
INLINE Floats from_halves(Shorts h) {
    return Floats(_mm512_cvtph_ps(__m256i(h)));
}
#endif
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
    return widened_halves<Floats4>(__builtin_convertvector(h, Ints4));
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
#if defined(__AVX512F__)
INLINE Shorts to_halves(Floats v) {
    return Shorts(_mm512_cvtps_ph(v, 0));
}
#elif defined(__AVX2__)
INLINE Shorts to_halves(Floats v) {
    return Shorts(_mm256_cvtps_ph(v, 0));
}
#endif
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
    bool all_inside;
};
INLINE Place place_of(const View& s, vint x, vint y) {
    x = clamp(x, 0, s.width - 1) - s.x;
    y = clamp(y, 0, s.height - 1) - s.y;
    const vbool inside = x >= 0 && x < s.held_width && y >= 0 && y < s.held_height;
    const vint index = y * s.held_width + x;
    return {select(inside, index, vint(0)), inside, !any_lane(!inside)};
}

/// The index of the first lane's pixel where all lanes are side by side in what is held; else -1. Most
/// fetches of passes over pictures are.
INLINE int row_at(const View& s, vint x, vint y) {
    // Idle lanes may hold any numbers.
    const int64_t column = int64_t(x.v[0]) - s.x, row = int64_t(y.v[0]) - s.y;
    const Ints unlike = (x.v ^ (splat(x.v[0]) + lane_numbers().v)) | (y.v ^ splat(y.v[0]));
    if (any_lane(vbool(Ints(unlike != 0)))) return -1;
    const bool held = column >= 0 && column + lanes <= s.held_width && row >= 0 && row < s.held_height;
    return held ? int(row * s.held_width + column) : -1;
}

/// One value of 32 bits per pixel.
INLINE vint fetch_bits(const View& s, vint x, vint y) {
    const auto* data = reinterpret_cast<const int32_t*>(s.data);
    if (const int row = row_at(s, x, y); row >= 0) return load<Ints>(data + row);
    const Place p = place_of(s, x, y);
    if (p.all_inside) return gather(data, p.index);
    if (!any_lane(p.inside)) return 0;
    return select(p.inside, gather(data, p.index), vint(0));
}

// Pixels of four channels: one of them, or a channel for each lane.
struct FloatPixel {
    static constexpr size_t bytes = 16;
    static INLINE Floats4 read(const std::byte* p) { return load<Floats4>(p); }
    static INLINE Floats read_channels(const std::byte* p) { return load<Floats>(p); }
    static INLINE void write(std::byte* p, Floats4 v) { std::memcpy(p, &v, sizeof v); }
    static INLINE void write_channels(std::byte* p, Floats v) { std::memcpy(p, &v, sizeof v); }
};
struct HalfPixel {
    static constexpr size_t bytes = 8;
    static INLINE Floats4 read(const std::byte* p) { return from_halves(load<Shorts4>(p)); }
    static INLINE Floats read_channels(const std::byte* p) { return from_halves(load<Shorts>(p)); }
    static INLINE void write(std::byte* p, Floats4 v) {
        const Shorts4 halves = to_halves(v);
        std::memcpy(p, &halves, sizeof halves);
    }
    static INLINE void write_channels(std::byte* p, Floats v) {
        const Shorts halves = to_halves(v);
        std::memcpy(p, &halves, sizeof halves);
    }
};
/// From 0 to 65535.
struct ShortPixel {
    static constexpr size_t bytes = 8;
    static INLINE Floats4 read(const std::byte* p) {
        return __builtin_convertvector(__builtin_convertvector(load<Shorts4>(p), Ints4), Floats4);
    }
    static INLINE Floats read_channels(const std::byte* p) {
        return __builtin_convertvector(__builtin_convertvector(load<Shorts>(p), Ints), Floats);
    }
};

// A pixel for each lane, side by side. Not by loops: GCC 12 would keep their values in memory.
template <class Pixel>
INLINE void store_row(std::byte* to, const PixelRow& row) {
    constexpr size_t step = Pixel::bytes * lanes / 4;
    Pixel::write_channels(to, row.v[0]);
    Pixel::write_channels(to + step, row.v[1]);
    Pixel::write_channels(to + 2 * step, row.v[2]);
    Pixel::write_channels(to + 3 * step, row.v[3]);
}
template <class Pixel>
INLINE vec4 load_row(const std::byte* from) {
    constexpr size_t step = Pixel::bytes * lanes / 4;
    return planar({{Pixel::read_channels(from), Pixel::read_channels(from + step),
                    Pixel::read_channels(from + 2 * step), Pixel::read_channels(from + 3 * step)}});
}
/// One pixel per lane.
template <class Pixel>
INLINE vec4 fetch_pixels(const View& s, vint x, vint y) {
    if (const int row = row_at(s, x, y); row >= 0)
        return load_row<Pixel>(s.data + Pixel::bytes * size_t(row));
    const Place p = place_of(s, x, y);
    if (!any_lane(p.inside)) return vec4(vfloat(0.0f));
    Floats4 pixels[lanes];
    for (int k = 0; k < lanes; ++k) pixels[k] = Pixel::read(s.data + Pixel::bytes * size_t(p.index.v[k]));
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
    return fetch_pixels<ShortPixel>(s, x, y) * (1.0f / 65535.0f);
}
INLINE vec4 fetch(const EncodedLinear& s, vint x, vint y) {
    return s.pixel_bytes == 8 ? fetch(Rgba16{s}, x, y) : fetch(Rgba8{s}, x, y);
}
INLINE vec4 fetch(const Rgba16f& s, vint x, vint y) {
    return fetch_pixels<HalfPixel>(s, x, y);
}
INLINE vec4 fetch(const Rgba16fLinear& s, vint x, vint y) {
    return fetch(Rgba16f{s}, x, y);
}
INLINE vec4 fetch(const Rgba32f& s, vint x, vint y) {
    return fetch_pixels<FloatPixel>(s, x, y);
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

// The shaders for one instruction set. Includes nothing that defines functions of other libraries: the linker
// might keep this file's copy of them for processors that cannot run it.
#include "easypbr/native/kernels.h"

#include "easypbr/native/simd/resolve_triangles.h"

namespace easypbr::native {

#include "native/shader_uniforms.h"

namespace EASYPBR_ISA {

INLINE vfloat load_lanes(const float* from, size_t at) {
    return vfloat(load<Floats>(from + at));
}
INLINE void store_lanes(float* to, size_t at, vfloat value) {
    std::memcpy(to + at, &value.v, sizeof value.v);
}

struct Fragment : TextureReader {
    vec4 gl_FragCoord;
    vfloat gl_FragDepth;  ///< native passes ignore it
    vbool gl_FrontFacing;
    vbool written;  ///< false where the pixel was discarded
};

#include "native/shaders.h"

}  // namespace EASYPBR_ISA
}  // namespace easypbr::native

#include "easypbr/native/simd/shade_hits.h"

namespace easypbr::native::EASYPBR_ISA {
namespace {

/// Four channels of all lanes, pixel by pixel.
INLINE void interleave(const vec4& c, Floats4* pixels) {
#if defined(__AVX2__) && !defined(__AVX512F__)
    const __m256 xy_low = _mm256_unpacklo_ps(c.x.v, c.y.v), xy_high = _mm256_unpackhi_ps(c.x.v, c.y.v),
                 zw_low = _mm256_unpacklo_ps(c.z.v, c.w.v), zw_high = _mm256_unpackhi_ps(c.z.v, c.w.v);
    const __m256 p04 = _mm256_shuffle_ps(xy_low, zw_low, 0x44), p15 = _mm256_shuffle_ps(xy_low, zw_low, 0xee),
                 p26 = _mm256_shuffle_ps(xy_high, zw_high, 0x44),
                 p37 = _mm256_shuffle_ps(xy_high, zw_high, 0xee);
    const __m256 pairs[4] = {p04, p15, p26, p37};
    for (int i = 0; i < 4; ++i) {
        pixels[i] = Floats4(_mm256_castps256_ps128(pairs[i]));
        pixels[4 + i] = Floats4(_mm256_extractf128_ps(pairs[i], 1));
    }
#else
    for (int k = 0; k < lanes; ++k) pixels[k] = Floats4{c.x.v[k], c.y.v[k], c.z.v[k], c.w.v[k]};
#endif
}

INLINE void store_float(std::byte* to, const vec4& color, vbool active, bool all_active, Store store) {
    Floats4 pixels[lanes];
    interleave(color, pixels);
    for (int k = 0; k < lanes; ++k) {
        if (!all_active && !active.v[k]) continue;
        std::byte* p = to + 16 * k;
        Floats4 value = pixels[k];
        if (store != Store::replace) {
            const auto before = load<Floats4>(p);
            if (store == Store::multiply)
                value *= before;
            else if (store == Store::under)
                value = before + value * (1.0f - before[3]);
            else
                value += before;
            if (store == Store::add_light) value[3] = before[3];
        }
        std::memcpy(p, &value, sizeof value);
    }
}

INLINE vint rounded(vfloat c, float most) {
    return to_int(clamp(c, 0.0f, 1.0f) * most + 0.5f);
}

INLINE void store_bytes(std::byte* to, const vec4& color, vbool active, bool all_active) {
    const vint bits = rounded(color.x, 255) | rounded(color.y, 255) << 8 | rounded(color.z, 255) << 16 |
                      rounded(color.w, 255) << 24;
    if (all_active) {
        std::memcpy(to, &bits.v, sizeof bits.v);
        return;
    }
    for (int k = 0; k < lanes; ++k) {
        const int32_t pixel = bits.v[k];
        if (active.v[k]) std::memcpy(to + 4 * k, &pixel, sizeof pixel);
    }
}

INLINE void store_shorts(std::byte* to, const vec4& color, vbool active) {
    const vint channels[4] = {rounded(color.x, 65535), rounded(color.y, 65535), rounded(color.z, 65535),
                              rounded(color.w, 65535)};
    for (int k = 0; k < lanes; ++k) {
        if (!active.v[k]) continue;
        uint16_t pixel[4];
        for (int i = 0; i < 4; ++i) pixel[i] = uint16_t(channels[i].v[k]);
        std::memcpy(to + 8 * k, pixel, sizeof pixel);
    }
}

INLINE void store_short(std::byte* to, vfloat value, vbool active) {
    const vint bits = rounded(value, 65535);
    for (int k = 0; k < lanes; ++k) {
        const auto pixel = uint16_t(bits.v[k]);
        if (active.v[k]) std::memcpy(to + 2 * k, &pixel, sizeof pixel);
    }
}

INLINE void store_pixels(const Region& region, int x, int y, const vec4& color, vbool active) {
    const size_t at = size_t(y - region.y) * size_t(region.width) + size_t(x - region.x);
    const bool all_active = !any_lane(!active);
    if (region.pixels == Pixels::rgba32f)
        store_float(region.data + 16 * at, color, active, all_active, region.store);
    else if (region.pixels == Pixels::rgba8)
        store_bytes(region.data + 4 * at, color, active, all_active);
    else if (region.pixels == Pixels::r16)
        store_short(region.data + 2 * at, color.x, active);
    else
        store_shorts(region.data + 8 * at, color, active);
}

INLINE vfloat depth_at(const Region& region, vint x, int y) {
    if (region.depth_channels == 1) return fetch(region.depth, x, y).x;
    const Place p = place_of(region.depth, x, y);
    if (!any_lane(p.inside)) return 0.0f;
    const auto* data = reinterpret_cast<const int32_t*>(region.depth.data);
    return select(p.inside, as_float(gather(data, p.index * region.depth_channels).v), vfloat(0.0f));
}

/// Where there is room under what a picture of floats holds.
INLINE vbool is_open(const Region& region, vint x, int y) {
    const vint at =
        (vint(y - region.y) * region.width + (clamp(x, region.x0, region.x1 - 1) - region.x)) * 4 + 3;
    return vfloat(as_float(gather(reinterpret_cast<const int32_t*>(region.data), at).v)) < 1.0f;
}

template <class Shader>
INLINE vec4 output_of(const Shader& s) {
    if constexpr (requires { s.o_light; })
        return s.o_light;
    else if constexpr (requires { s.o_visibility; })
        return {s.o_visibility, 0.0f, 0.0f, 1.0f};
    else if constexpr (requires { s.o_surface; })
        return s.o_surface;
    else if constexpr (requires { s.o_radiance; })
        return s.o_radiance;
    else if constexpr (requires { s.o_sum; })
        return s.o_sum;
    else
        return s.o_color;
}

template <class Shader, class Uniforms>
__attribute__((flatten)) void shade_rows(const void* uniforms, const Region& region, int y0, int y1) {
    Shader s;
    static_cast<Uniforms&>(s) = *static_cast<const Uniforms*>(uniforms);
    const vint number = lane_numbers();
    const bool zeros = region.where == Where::covered && region.store == Store::replace;
    for (int y = y0; y < y1; ++y)
        for (int x = region.x0; x < region.x1; x += lanes) {
            const vint column = number + x;
            const vbool inside = column < region.x1;
            vbool active = inside;
            if (region.where != Where::everywhere) {
                const vfloat depth = depth_at(region, column, y);
                active = inside && (region.where == Where::covered ? depth != 0.0f : depth == 0.0f);
            }
            if (region.store == Store::under) active = active && is_open(region, column, y);
            const bool any = any_lane(active);
            s.written = active;
            if (any) {
                s.gl_FragCoord = vec4(to_float(column) + 0.5f, float(y) + 0.5f, 0.0f, 1.0f);
                s.main();
            }
            const vec4 nothing(vfloat(0.0f));
            if (zeros)
                store_pixels(region, x, y, any ? select(s.written, output_of(s), nothing) : nothing, inside);
            else if (any && any_lane(s.written))
                store_pixels(region, x, y, output_of(s), s.written);
        }
}

template <class Shader, class Uniforms, class Arrays>
__attribute__((flatten)) void shade_stream(const void* uniforms, const void* stream, int count) {
    static_assert(stream_alignment % lanes == 0);
    Shader s;
    static_cast<Uniforms&>(s) = *static_cast<const Uniforms*>(uniforms);
    const Arrays& arrays = *static_cast<const Arrays*>(stream);
    for (size_t at = 0; at < size_t(count); at += lanes) {
        s.load(arrays, at);
        s.main();
        s.store(arrays, at);
    }
}

}  // namespace

// A constant is local to its file unless it is declared extern.
extern const Kernels kernels;
#define EASYPBR_ROWS(name) shade_rows<name, name##_uniforms>,
#define EASYPBR_ARRAYS(name) shade_stream<name, name##_uniforms, name##_stream>,
const Kernels kernels{resolve_triangles,
                      alpha_of_triangles,
                      shade_hits,
                      {EASYPBR_SHADERS(EASYPBR_ROWS)},
                      {EASYPBR_STREAMS(EASYPBR_ARRAYS)}};
#undef EASYPBR_ARRAYS
#undef EASYPBR_ROWS

}  // namespace easypbr::native::EASYPBR_ISA

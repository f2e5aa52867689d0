// The shaders for one instruction set. Includes nothing that defines functions of other libraries: the linker
// might keep this file's copy of them for processors that cannot run it.
#include "easypbr/native/kernels.h"

#include "easypbr/native/simd/packing.h"
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
    vfloat gl_FragDepth;  ///< of lines; other native passes ignore it
    vbool gl_FrontFacing;
    vbool written;  ///< false where the pixel was discarded
};

#include "native/shaders.h"

}  // namespace EASYPBR_ISA
}  // namespace easypbr::native

#include "easypbr/native/simd/blend_splats.h"
#include "easypbr/native/simd/camera_places.h"
#include "easypbr/native/simd/cluster_setup.h"
#include "easypbr/native/simd/ellipse_setup.h"
#include "easypbr/native/simd/line_strokes.h"
#include "easypbr/native/simd/map_directions.h"
#include "easypbr/native/simd/noisy_rows.h"
#include "easypbr/native/simd/point_setup.h"
#include "easypbr/native/simd/sample_emitters.h"
#include "easypbr/native/simd/sample_paths.h"
#include "easypbr/native/simd/shade_hits.h"

namespace easypbr::native::EASYPBR_ISA {
namespace {

/// What a pixel becomes.
INLINE Floats4 blended(Floats4 value, Floats4 before, const Region& region) {
    switch (region.store) {
        case Store::multiply:
            return value * before;
        case Store::under:
            return before + value * (1.0f - before[3]);
        case Store::over:
            return value + before * (1.0f - value[3]);
        case Store::mix:
            return value * (1.0f - region.kept) + before * region.kept;
        case Store::add_light:
            return Floats4{value[0] + before[0], value[1] + before[1], value[2] + before[2], before[3]};
        default:
            return value + before;
    }
}

template <class Pixel>
INLINE void store_blended(std::byte* to, const vec4& color, vbool active, bool all_active,
                          const Region& region) {
    const PixelRow row = interleaved(color);
    if (all_active && region.store == Store::replace) {
        store_row<Pixel>(to, row);
        return;
    }
    Floats4 pixels[lanes];
    std::memcpy(pixels, row.v, sizeof pixels);
    for (int k = 0; k < lanes; ++k) {
        if (!all_active && !active.v[k]) continue;
        std::byte* p = to + Pixel::bytes * size_t(k);
        const bool replaces = region.store == Store::replace;
        Pixel::write(p, replaces ? pixels[k] : blended(pixels[k], Pixel::read(p), region));
    }
}

INLINE vint rounded(vfloat c, float most) {
    return to_int(clamp(c, 0.0f, 1.0f) * most + 0.5f);
}

/// A value of each lane: Ints or Shorts.
template <class Values>
INLINE void store_values(std::byte* to, Values values, vbool active, bool all_active) {
    if (all_active) {
        std::memcpy(to, &values, sizeof values);
        return;
    }
    constexpr size_t bytes = sizeof values / lanes;
    for (int k = 0; k < lanes; ++k) {
        const auto value = values[k];
        if (active.v[k]) std::memcpy(to + bytes * size_t(k), &value, bytes);
    }
}
/// Single floats can be replaced or added to.
INLINE vfloat summed(const std::byte* to, vfloat value, vbool active, bool all_active, Store store) {
    if (store != Store::add) return value;
    float before[lanes] = {};
    for (int k = 0; k < lanes; ++k)
        if (all_active || active.v[k]) std::memcpy(before + k, to + sizeof(float) * size_t(k), sizeof(float));
    return value + load_lanes(before, 0);
}
INLINE Shorts low_bits(vint v) {
    return __builtin_convertvector(v.v, Shorts);
}

INLINE vint bytes_of(const vec4& c) {
    return rounded(c.x, 255) | rounded(c.y, 255) << 8 | rounded(c.z, 255) << 16 | rounded(c.w, 255) << 24;
}

INLINE void store_shorts(std::byte* to, const vec4& color, vbool active, bool all_active) {
    const auto bits = [](vfloat c) __attribute__((always_inline)) {
        return as_float(rounded(c, 65535).v);
    };
    const PixelRow row = interleaved({bits(color.x), bits(color.y), bits(color.z), bits(color.w)});
    Shorts channels[4];
    for (int i = 0; i < 4; ++i) channels[i] = low_bits(Ints(row.v[i]));
    if (all_active) {
        std::memcpy(to, channels, sizeof channels);
        return;
    }
    uint64_t pixels[lanes];
    std::memcpy(pixels, channels, sizeof pixels);
    for (int k = 0; k < lanes; ++k)
        if (active.v[k]) std::memcpy(to + 8 * k, &pixels[k], sizeof pixels[k]);
}

INLINE void store_pixels(const Output& output, size_t at, const vec4& c, vbool active, const Region& region) {
    const bool all = !any_lane(!active);
    std::byte* data = output.data;
    switch (output.pixels) {
        case Pixels::rgba32f:
            return store_blended<FloatPixel>(data + 16 * at, c, active, all, region);
        case Pixels::rgba16f:
            return store_blended<HalfPixel>(data + 8 * at, c, active, all, region);
        case Pixels::rgba8:
            return store_values(data + 4 * at, bytes_of(c).v, active, all);
        case Pixels::rg8:
            return store_values(data + 2 * at, low_bits(rounded(c.x, 255) | rounded(c.y, 255) << 8), active,
                                all);
        case Pixels::rg16:
            return store_values(data + 4 * at, (rounded(c.x, 65535) | rounded(c.y, 65535) << 16).v, active,
                                all);
        case Pixels::r16:
            return store_values(data + 2 * at, low_bits(rounded(c.x, 65535)), active, all);
        case Pixels::r32f:
            data += 4 * at;
            return store_values(data, summed(data, c.x, active, all, region.store).v, active, all);
        case Pixels::r16f:
            return store_values(data + 2 * at, to_halves(c.x.v), active, all);
        case Pixels::rgba16:
            return store_shorts(data + 8 * at, c, active, all);
    }
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
    return vfloat(as_float(gather(reinterpret_cast<const int32_t*>(region.outputs[0].data), at).v)) < 1.0f;
}

/// Writes the outputs of a shader where `written`; elsewhere nothing, or with `zeros` zeros.
template <class Shader>
INLINE void store_outputs(const Shader& s, const Region& region, int x, int y, vbool written, bool any,
                          const vbool* zeros) {
    const size_t at = size_t(y - region.y) * size_t(region.width) + size_t(x - region.x);
    const vec4 nothing(vfloat(0.0f));
    vec4 pixels[Shader::output_count];
    if (any) s.outputs(pixels);
    for (int i = 0; i < Shader::output_count; ++i) {
        if (!region.outputs[i].data) continue;
        if (zeros)
            store_pixels(region.outputs[i], at, any ? select(written, pixels[i], nothing) : nothing, *zeros,
                         region);
        else
            store_pixels(region.outputs[i], at, pixels[i], written, region);
    }
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
            if (zeros || (any && any_lane(s.written)))
                store_outputs(s, region, x, y, s.written, any, zeros ? &inside : nullptr);
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

/// Puts what has been gathered over the region, where `given` is above 0.
INLINE void put_over(const LinePixels& pixels, const float* given, const Region& region, int y0, int y1) {
    for (int y = y0; y < y1; ++y)
        for (int x = region.x0; x < region.x1; x += lanes) {
            const size_t at = pixels.at(x, y);
            const vbool seen = load_lanes(given, at) > 0.0f && lane_numbers() + x < region.x1;
            if (any_lane(seen))
                store_pixels(region.outputs[0],
                             size_t(y - region.y) * size_t(region.width) + size_t(x - region.x),
                             pixels.color_at(at), seen, region);
        }
}

__attribute__((flatten)) void draw_lines(const LineStroke* strokes, int count, const Region& region, int y0,
                                         int y1, float* work) {
    LineBand band(region, y0, y1, work);
    const bool many = count > 1;
    overlay_lines s;
    for (int i = 0; i < count; ++i) {
        static_cast<overlay_lines_uniforms&>(s) =
            *static_cast<const overlay_lines_uniforms*>(strokes[i].uniforms);
        if (s.is_depth_only) {
            draw_stroke(s, strokes[i], region, y0, y1, nullptr);
            continue;
        }
        if (i == 0) band.clear(band.rank, y1 - y0);
        if (i == 0 && many) band.clear(band.others.depth, y1 - y0);
        draw_stroke(s, strokes[i], region, y0, y1, &band);
        if (many) join_stroke(s, band, region, y0, y1);
    }
    if (count == 0 || s.is_depth_only) return;
    if (many)
        put_over(band.others, band.others.depth, region, y0, y1);
    else
        put_over(band.stroke, band.rank, region, y0, y1);
}

}  // namespace

// A constant is local to its file unless it is declared extern.
extern const Kernels kernels;
#define EASYPBR_ROWS(name) shade_rows<name, name##_uniforms>,
#define EASYPBR_ARRAYS(name) shade_stream<name, name##_uniforms, name##_stream>,
const Kernels kernels{resolve_triangles,
                      alpha_of_triangles,
                      casters_of_triangles,
                      shade_hits,
                      draw_lines,
                      blend_splats,
                      project_cluster,
                      set_up_cluster,
                      set_up_points,
                      set_up_ellipses,
                      add_noisy_row,
                      find_map_places,
                      find_map_directions,
                      find_places,
                      sample_paths,
                      sample_emitters,
                      chances_of_emitters,
                      {EASYPBR_SHADERS(EASYPBR_ROWS)},
                      {EASYPBR_STREAMS(EASYPBR_ARRAYS)}};
#undef EASYPBR_ARRAYS
#undef EASYPBR_ROWS

}  // namespace easypbr::native::EASYPBR_ISA

// GLSL's texture functions for pictures in host memory: nearest, linear, trilinear, cubes.
#pragma once

#include "easypbr/native/simd/reductions.h"
#include "easypbr/native/simd/texels.h"

namespace easypbr::native::EASYPBR_ISA {

// Nearest.
template <class Sampler>
INLINE vec4 nearest(const Sampler& s, const vec2& uv) {
    return fetch(s, to_int(floor(uv.x * float(s.width))), to_int(floor(uv.y * float(s.height))));
}
#define NEAREST(Sampler)                                              \
    INLINE vec4 textureLod(const Sampler& s, const vec2& uv, float) { \
        return nearest(s, uv);                                        \
    }
NEAREST(R32f)
NEAREST(R16)
NEAREST(Rg16)
NEAREST(Rgba8)
NEAREST(Rgba16)
NEAREST(Rgba16f)
NEAREST(Rgba32f)
#undef NEAREST

/// One channel of the four texels around a point, from the lower left one on against the clock.
template <class Sampler>
INLINE vec4 textureGather(const Sampler& s, const vec2& uv, int channel) {
    const vint x = to_int(floor(uv.x * float(s.width) - 0.5f)),
               y = to_int(floor(uv.y * float(s.height) - 0.5f));
    const auto texel = [&](vint column, vint row) __attribute__((always_inline)) {
        const vec4 c = fetch(s, column, row);
        return channel == 0 ? c.x : channel == 1 ? c.y : channel == 2 ? c.z : c.w;
    };
    return {texel(x, y + 1), texel(x + 1, y + 1), texel(x + 1, y), texel(x, y)};
}

// Linear. The coordinate is clamped instead of the texels, so that pairs of texels lie side by side.
struct Footprint {
    vint x, y;
    vfloat right, below;  ///< weights of the texels to the right and below
};
INLINE Footprint footprint(int width, int height, const vec2& uv) {
    const vfloat x = clamp(uv.x * float(width) - 0.5f, 0.0f, float(width - 1)),
                 y = clamp(uv.y * float(height) - 0.5f, 0.0f, float(height - 1));
    const vfloat left = min(floor(x), float(width - 2)), top = min(floor(y), float(height - 2));
    return {to_int(left), to_int(top), x - left, y - top};
}
INLINE Floats4 bilinear(Floats8 top, Floats8 bottom, float right, float below) {
    const Floats8 v = top + (bottom - top) * below;
    const Floats4 l = low_half(v), r = high_half(v);
    return l + (r - l) * right;
}
INLINE Floats8 from_bytes8(const std::byte* p) {
    return __builtin_convertvector(widened(load<Bytes8>(p)), Floats8);
}
/// Texel by texel: of any picture.
template <class Sampler>
INLINE vec4 linear_by_texels(const Sampler& s, const vec2& uv) {
    const vfloat x = uv.x * float(s.width) - 0.5f, y = uv.y * float(s.height) - 0.5f;
    const vfloat left = floor(x), top = floor(y);
    const vint column = to_int(left), row = to_int(top);
    const vec4 above = mix(fetch(s, column, row), fetch(s, column + 1, row), x - left),
               below = mix(fetch(s, column, row + 1), fetch(s, column + 1, row + 1), x - left);
    return mix(above, below, y - top);
}
INLINE vec4 textureLod(const R16fLinear& s, const vec2& uv, float) {
    return linear_by_texels(s, uv);
}
/// `load_pair` loads two pixels side by side.
template <class Sampler, class Load>
INLINE vec4 linear(const Sampler& s, const vec2& uv, size_t pixel_bytes, Load&& load_pair) {
    if (s.width < 2 || s.height < 2) return linear_by_texels(s, uv);
    const Footprint f = footprint(s.width, s.height, uv);
    const vint at = f.y * s.width + f.x;
    Floats4 pixels[lanes];
    for (int k = 0; k < lanes; ++k) {
        const std::byte* p = s.data + pixel_bytes * size_t(at.v[k]);
        pixels[k] =
            bilinear(load_pair(p), load_pair(p + pixel_bytes * size_t(s.width)), f.right.v[k], f.below.v[k]);
    }
    return planar(pixels);
}
INLINE Floats8 from_shorts8(const std::byte* p) {
    return __builtin_convertvector(widened(load<Shorts8>(p)), Floats8);
}
INLINE vec4 textureLod(const EncodedLinear& s, const vec2& uv, float) {
    if (s.pixel_bytes == 8) return linear(s, uv, 8, from_shorts8) * (1.0f / 65535.0f);
    return linear(s, uv, 4, from_bytes8) * (1.0f / 255.0f);
}
INLINE Floats8 from_halves8(const std::byte* p) {
    return from_halves(load<Shorts8>(p));
}
INLINE vec4 textureLod(const Rgba16fLinear& s, const vec2& uv, float) {
    return linear(s, uv, 8, from_halves8);
}
INLINE vec4 textureLod(const Rgba32fLinear& s, const vec2& uv, float) {
    return linear(s, uv, 16, load<Floats8>);
}
/// Where the bilinear filter reads along one axis of `count` texels: the one before, and the next one's
/// weight.
struct ScalarStep {
    int first;
    float part;
};
INLINE ScalarStep scalar_step(float u, int count) {
    float x = u * float(count) - 0.5f;
    x = x > 0 ? x : 0.0f;  // also what is not a number
    x = x < float(count - 1) ? x : float(count - 1);
    const int first = int(x) < count - 2 ? int(x) : count > 1 ? count - 2 : 0;
    return {first, x - float(first)};
}
INLINE Floats4 level_tap(const MipPicture& s, int level, float u, float v) {
    const int width = s.width >> level > 1 ? s.width >> level : 1,
              height = s.height >> level > 1 ? s.height >> level : 1;
    const ScalarStep x = scalar_step(u, width), y = scalar_step(v, height);
    const float* top = s.data[level] + 4 * (size_t(y.first) * size_t(width) + size_t(x.first));
    const size_t right = width > 1 ? 4 : 0, below = height > 1 ? 4 * size_t(width) : 0;
    const Floats4 a = load<Floats4>(top), b = load<Floats4>(top + right), c = load<Floats4>(top + below),
                  d = load<Floats4>(top + below + right);
    const Floats4 upper = a + (b - a) * x.part, lower = c + (d - c) * x.part;
    return upper + (lower - upper) * y.part;
}
/// Trilinear, pixel by pixel: few are asked for.
INLINE vec4 textureLod(const MipPicture& s, const vec2& uv, vfloat level) {
    const vfloat l = clamp(level, 0.0f, float(s.levels - 1));
    Floats4 pixels[lanes];
    for (int k = 0; k < lanes; ++k) {
        const int larger = int(l.v[k]);
        const float part = l.v[k] - float(larger);
        pixels[k] = level_tap(s, larger, uv.x.v[k], uv.y.v[k]);
        if (part > 0) pixels[k] += (level_tap(s, larger + 1, uv.x.v[k], uv.y.v[k]) - pixels[k]) * part;
    }
    return planar(pixels);
}
INLINE Floats4 bilinear_halves(const uint16_t* top, const uint16_t* bottom, float right, float below) {
    return bilinear(from_halves(load<Shorts8>(top)), from_halves(load<Shorts8>(bottom)), right, below);
}
INLINE vec4 textureLod(const Rg16fLinear& s, const vec2& uv, float) {
    const Footprint f = footprint(s.width, s.height, uv);
    const vint at = f.y * s.width + f.x;
    const auto* data = reinterpret_cast<const uint16_t*>(s.data);
    Floats4 pixels[lanes];
    for (int k = 0; k < lanes; ++k) {
        const uint16_t* p = data + 2 * size_t(at.v[k]);
        const Floats4 top = from_halves(load<Shorts4>(p)),
                      bottom = from_halves(load<Shorts4>(p + 2 * size_t(s.width)));
        const Floats4 v = top + (bottom - top) * f.below.v[k];
        pixels[k] = v + (Floats4{v[2], v[3], v[2], v[3]} - v) * f.right.v[k];
    }
    return planar(pixels);
}

/// The filter of the level that is nearest to `level`; u repeats.
INLINE vec4 textureLod(const Panorama& s, const vec2& uv, float level) {
    const int l = level <= 0                     ? 0
                  : level >= float(s.levels - 1) ? s.levels - 1
                                                 : int(__builtin_floorf(level + 0.5f));
    const int width = s.width[l], height = s.height[l];
    vfloat x = uv.x * float(width) - 0.5f;
    x = x - floor(x * (1.0f / float(width))) * float(width);
    x = clamp(x, 0.0f, float(width) - 0.001f);
    const vfloat y = clamp(uv.y * float(height) - 0.5f, 0.0f, float(height - 1));
    const vfloat left = min(floor(x), float(width - 1)), top = max(min(floor(y), float(height - 2)), 0.0f);
    const vfloat right = x - left, below = y - top;
    const vint at = to_int(top) * (width + 1) + to_int(left);
    const uint16_t* data = s.data + 4 * s.offsets[l];
    const size_t row = height > 1 ? 4 * size_t(width + 1) : 0;
    Floats4 pixels[lanes];
    for (int k = 0; k < lanes; ++k) {
        const uint16_t* p = data + 4 * size_t(at.v[k]);
        pixels[k] = bilinear_halves(p, p + row, right.v[k], below.v[k]);
    }
    return planar(pixels);
}

INLINE vfloat wrapped(vfloat u, Texture::Wrap wrap) {
    if (wrap == Texture::Wrap::clamp) return u;
    if (wrap == Texture::Wrap::repeat) return u - floor(u);
    const vfloat half = u * 0.5f, turn = (half - floor(half)) * 2.0f;
    return select(turn > 1.0f, 2.0f - turn, turn);
}
/// Between `count` texels: the one before a coordinate, and the weight of the next.
struct Step {
    vint first;
    vfloat part;
};
INLINE Step step_of(vfloat u, vint count, Texture::Wrap wrap) {
    const vint last = count - 1;
    vfloat x = u * to_float(count) - 0.5f;
    if (wrap == Texture::Wrap::repeat) {
        const vfloat before = floor(x);
        const vint first = to_int(before);
        return {clamp(select(first < 0, last, first), 0, last), x - before};
    }
    // Mirrored, the neighbour beyond a border is the border's texel.
    x = clamp(x, 0.0f, to_float(last));
    const vfloat before = floor(x);
    return {to_int(before), x - before};
}
/// Where the bilinear filter reads: the pairs of texels above and below.
struct TexturePlace {
    vint top, bottom;
    vfloat right, below;
};
INLINE TexturePlace place_of(const Texture& s, vfloat u, vfloat v, vint level) {
    const vint width = max(vint(s.width) >> level, 1), height = max(vint(s.height) >> level, 1);
    const Step x = step_of(u, width, s.wrap_u), y = step_of(v, height, s.wrap_v);
    const vint next = y.first + 1, beyond = s.wrap_v == Texture::Wrap::repeat ? vint(0) : height - 1;
    const vint first = gather(s.offsets, level) + x.first, row = width + 1;
    return {first + y.first * row, first + select(next < height, next, beyond) * row, x.part, y.part};
}
template <class Load>
INLINE Floats4 texel_of(const Texture& s, const TexturePlace& p, int k, size_t bytes, Load&& load_pair) {
    return bilinear(load_pair(s.texels + bytes * size_t(p.top.v[k])),
                    load_pair(s.texels + bytes * size_t(p.bottom.v[k])), p.right.v[k], p.below.v[k]);
}
/// The bilinear filter of the largest level.
INLINE vec4 textureLod(const Texture& s, const vec2& uv, float) {
    const TexturePlace place = place_of(s, wrapped(uv.x, s.wrap_u), wrapped(uv.y, s.wrap_v), 0);
    Floats4 pixels[lanes];
    for (int k = 0; k < lanes; ++k)
        pixels[k] =
            s.is_16_bit ? texel_of(s, place, k, 8, from_shorts8) : texel_of(s, place, k, 4, from_bytes8);
    return planar(pixels) * (s.is_16_bit ? 1.0f / 65535.0f : 1.0f / 255.0f);
}
/// What the trilinear filter reads.
struct TextureFootprint {
    TexturePlace fine, coarse;
    vfloat part;  ///< weight of the coarse level
    bool is_between;
};
/// `dx` and `dy` are what uv changes by from pixel to pixel; the level is that of the larger.
INLINE TextureFootprint footprint_of(const Texture& s, const vec2& uv, const vec2& dx, const vec2& dy,
                                     float bias) {
    const vfloat u = wrapped(uv.x, s.wrap_u), v = wrapped(uv.y, s.wrap_v);
    const float width = float(s.width), height = float(s.height);
    const vec2 across(dx.x * width, dx.y * height), down(dy.x * width, dy.y * height);
    const vfloat texels = max(max(dot(across, across), dot(down, down)), 1e-12f);
    const vfloat level = clamp(0.5f * log2(texels) + bias, 0.0f, float(s.levels - 1));
    const vfloat larger = floor(level);
    const vint first = to_int(larger);
    TextureFootprint f;
    f.part = level - larger;
    f.is_between = any_lane(f.part > 0.0f);
    f.fine = place_of(s, u, v, first);
    if (f.is_between) f.coarse = place_of(s, u, v, min(first + 1, s.levels - 1));
    return f;
}
template <class Load>
INLINE vec4 filtered(const Texture& s, const TextureFootprint& f, size_t bytes, Load&& load_pair) {
    Floats4 pixels[lanes];
    for (int k = 0; k < lanes; ++k) pixels[k] = texel_of(s, f.fine, k, bytes, load_pair);
    if (f.is_between)
        for (int k = 0; k < lanes; ++k)
            pixels[k] += (texel_of(s, f.coarse, k, bytes, load_pair) - pixels[k]) * f.part.v[k];
    return planar(pixels);
}
/// Of the largest level.
INLINE vec4 nearest(const Texture& s, vfloat u, vfloat v) {
    // Clamped before they are whole numbers: places of values may be farther off than these reach.
    const vint x = to_int(clamp(u * float(s.width), 0.0f, float(s.width - 1))),
               y = to_int(clamp(v * float(s.height), 0.0f, float(s.height - 1)));
    const vint at = y * (s.width + 1) + x;
    Floats4 pixels[lanes];
    for (int k = 0; k < lanes; ++k)
        pixels[k] = s.is_16_bit ? low_half(from_shorts8(s.texels + 8 * size_t(at.v[k])))
                                : low_half(from_bytes8(s.texels + 4 * size_t(at.v[k])));
    return planar(pixels) * (s.is_16_bit ? 1.0f / 65535.0f : 1.0f / 255.0f);
}
/// Fetches what a footprint covers into the cache.
INLINE void prefetch(const Texture& s, const TextureFootprint& f) {
    const size_t bytes = s.is_16_bit ? 8 : 4;
    const auto fetch_place = [&](const TexturePlace& p) __attribute__((always_inline)) {
        for (int k = 0; k < lanes; ++k) {
            __builtin_prefetch(s.texels + bytes * size_t(p.top.v[k]));
            __builtin_prefetch(s.texels + bytes * size_t(p.bottom.v[k]));
        }
    };
    fetch_place(f.fine);
    if (f.is_between) fetch_place(f.coarse);
}
/// Reads textures, several with the same coordinates one after the other: while the first is filtered, the
/// texels of the others are fetched.
class TextureReader {
  public:
    INLINE vec4 textureGrad(const Texture& s, const vec2& uv, const vec2& dx, const vec2& dy, float bias) {
        if (s.nearest) return nearest(s, wrapped(uv.x, s.wrap_u), wrapped(uv.y, s.wrap_v));
        if (!serves(s, uv, dx, dy)) {
            footprint_ = footprint_of(s, uv, dx, dy, bias);
            of_ = &s;
            uv_ = uv;
            dx_ = dx;
            dy_ = dy;
            prefetch(s, footprint_);
            for (int i = 0; i < alike_count_; ++i)
                if (has_same_texels(*alike_[i], s)) prefetch(*alike_[i], footprint_);
        } else if (alike_count_ < most_alike && !is_known(s)) {
            alike_[alike_count_++] = &s;
        }
        if (s.is_16_bit) return filtered(s, footprint_, 8, from_shorts8) * (1.0f / 65535.0f);
        return filtered(s, footprint_, 4, from_bytes8) * (1.0f / 255.0f);
    }

  private:
    static constexpr int most_alike = 8;

    INLINE static bool has_same_texels(const Texture& a, const Texture& b) {
        return a.width == b.width && a.height == b.height && a.wrap_u == b.wrap_u && a.wrap_v == b.wrap_v;
    }
    INLINE bool serves(const Texture& s, const vec2& uv, const vec2& dx, const vec2& dy) const {
        if (!of_ || !has_same_texels(s, *of_)) return false;
        return !any_lane(!(uv == uv_ && dx == dx_ && dy == dy_));
    }
    INLINE bool is_known(const Texture& s) const {
        for (int i = 0; i < alike_count_; ++i)
            if (alike_[i] == &s) return true;
        return false;
    }

    TextureFootprint footprint_;
    const Texture* of_ = nullptr;
    vec2 uv_, dx_, dy_;
    const Texture* alike_[most_alike];  ///< read with the footprint of another
    int alike_count_ = 0;
};

inline constexpr int block_bits = 4;
static_assert(Layers::block_size == 1 << block_bits);

/// Nearest, clamped to the borders; z is the layer.
INLINE vfloat layer_texel(const Layers& s, vint x, vint y, vint layer) {
    const vint index = (layer * s.size + clamp(y, 0, s.size - 1)) * s.size + clamp(x, 0, s.size - 1);
    return as_float(gather(reinterpret_cast<const int32_t*>(s.data), index).v);
}
INLINE vec4 textureLod(const Layers& s, const vec3& place, float) {
    const float size = float(s.size);
    return {
        layer_texel(s, to_int(floor(place.x * size)), to_int(floor(place.y * size)), to_int(place.z + 0.5f)),
        0.0f, 0.0f, 1.0f};
}
/// As that of pictures; away from the borders a lane's texels are two pairs, which are read as such.
INLINE vec4 textureGather(const Layers& s, const vec3& place) {
    const float size = float(s.size);
    const vint x = to_int(floor(place.x * size - 0.5f)), y = to_int(floor(place.y * size - 0.5f)),
               layer = to_int(place.z + 0.5f);
    const int last = s.size - 2;
    if (!any_lane(x < 0 || x > last || y < 0 || y > last)) {
        const vint index = (layer * s.size + y) * s.size + x;
        Floats4 pairs[lanes];
        for (int k = 0; k < lanes; ++k) {
            const float* const row = s.data + index.v[k];
            std::memcpy(&pairs[k], row, 8);
            std::memcpy(reinterpret_cast<std::byte*>(&pairs[k]) + 8, row + s.size, 8);
        }
        const vec4 c = planar(pairs);
        return {c.z, c.w, c.y, c.x};
    }
    return {layer_texel(s, x, y + 1, layer), layer_texel(s, x + 1, y + 1, layer),
            layer_texel(s, x + 1, y, layer), layer_texel(s, x, y, layer)};
}

/// See shaders/common_lanes.glsl. Of the blocks around all places that need them, and a texel to each side,
/// where all look at one layer; wide elsewhere. They differ with the lanes that are shaded together: what is
/// computed with them must not.
INLINE vec2 layer_bounds(const Layers& s, const vec3& place, const vec2& distance, vbool needed) {
    const vec2 unknown(-1e38f, 1e38f);
    const float size = float(s.size);
    const vint layer = to_int(place.z + 0.5f);
    const int first = largest_of(select(needed, layer, vint(-1)));
    if (!s.least || first < 0 || any_lane(needed && layer != first)) return unknown;
    const auto block = [&](vfloat at) __attribute__((always_inline)) {
        return clamp(to_int(floor(at * size)), 0, s.size - 1) >> block_bits;
    };
    const float texel = 1.0f / size;
    const int blocks = Layers::blocks_of(s.size);
    const vint outside = blocks;
    const int left = least_of(select(needed, block(place.x - distance.x - texel), outside)),
              right = largest_of(select(needed, block(place.x + distance.x + texel), vint(-1))),
              top = least_of(select(needed, block(place.y - distance.y - texel), outside)),
              bottom = largest_of(select(needed, block(place.y + distance.y + texel), vint(-1)));
    // What is read past the last block is there (ShadowMaps::note_bounds()).
    vfloat least = 1e38f, largest = -1e38f;
    for (int y = top; y <= bottom; ++y) {
        const size_t row = (size_t(first) * size_t(blocks) + size_t(y)) * size_t(blocks);
        for (int x = left; x <= right; x += lanes) {
            const vbool within = lane_numbers() + x <= right;
            least = min(least, select(within, vfloat(load<Floats>(s.least + row + x)), vfloat(1e38f)));
            largest = max(largest, select(within, vfloat(load<Floats>(s.largest + row + x)), vfloat(-1e38f)));
        }
    }
    return {-largest_of(-least), largest_of(largest)};
}

/// The first layer is 0; the texel must be inside.
INLINE vec4 texelFetch(const Layers4& s, const ivec3& p, int) {
    const vint index = (p.z * s.size + p.y) * s.size + p.x;
    Floats4 pixels[lanes];
    for (int k = 0; k < lanes; ++k) pixels[k] = load<Floats4>(s.data + 4 * size_t(index.v[k]));
    return planar(pixels);
}

struct CubePlace {
    vint face;
    vfloat s, t;  ///< within the face, in [0, 1]
};
/// OpenGL 4.5, table 8.19.
INLINE CubePlace cube_place(const vec3& d) {
    const vfloat ax = abs(d.x), ay = abs(d.y), az = abs(d.z);
    const vbool is_z = az >= ax && az >= ay, is_y = !is_z && ay >= ax;
    const vfloat major = select(is_z, d.z, select(is_y, d.y, d.x));
    const vbool negative = major < 0.0f;
    const vfloat s =
        select(is_z, select(negative, -d.x, d.x), select(is_y, d.x, select(negative, d.z, -d.z)));
    const vfloat t = select(is_y, select(negative, -d.z, d.z), -d.y);
    const vfloat scale = 0.5f / abs(major);
    const vint face = select(is_z, 4, select(is_y, vint(2), vint(0))) + select(negative, 1, 0);
    return {face, s * scale + 0.5f, t * scale + 0.5f};
}
/// Of the border's texel on: a face of n texels is n + 2 wide.
struct CubeTaps {
    vint index, row;
    vfloat right, below;
};
INLINE CubeTaps cube_taps(const CubePlace& c, vfloat n, vint offset) {
    const vfloat x = clamp(c.s * n + 0.5f, 0.0f, n + 0.5f), y = clamp(c.t * n + 0.5f, 0.0f, n + 0.5f);
    const vfloat left = floor(x), top = floor(y);
    const vint row = to_int(n) + 2;
    return {offset + (c.face * row + to_int(top)) * row + to_int(left), row, x - left, y - top};
}
INLINE Floats4 cube_tap(const Cube& s, const CubeTaps& taps, int k) {
    const uint16_t* p = s.data + 4 * size_t(taps.index.v[k]);
    return bilinear_halves(p, p + 4 * size_t(taps.row.v[k]), taps.right.v[k], taps.below.v[k]);
}
/// Between two levels.
INLINE vec4 textureLod(const Cube& s, const vec3& d, vfloat level) {
    const CubePlace place = cube_place(d);
    Floats4 pixels[lanes];
    if (s.levels == 1) {
        const CubeTaps taps = cube_taps(place, float(s.size), s.offsets[0]);
        for (int k = 0; k < lanes; ++k) pixels[k] = cube_tap(s, taps, k);
        return planar(pixels);
    }
    level = clamp(level, 0.0f, float(s.levels - 1));
    const vfloat larger = min(floor(level), float(s.levels - 2)), part = level - larger;
    const vint l = to_int(larger);
    const vfloat n = float(s.size) * as_float((127 - l.v) << 23);
    const CubeTaps first = cube_taps(place, n, gather(s.offsets, l)),
                   second = cube_taps(place, n * 0.5f, gather(s.offsets + 1, l));
    for (int k = 0; k < lanes; ++k) {
        const Floats4 a = cube_tap(s, first, k), b = cube_tap(s, second, k);
        pixels[k] = a + (b - a) * part.v[k];
    }
    return planar(pixels);
}

}  // namespace easypbr::native::EASYPBR_ISA

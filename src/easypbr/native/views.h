// Pictures in host memory as native shaders see them. Plain data: shaders are compiled for several
// instruction sets, and code in this header would be too.
#pragma once

#include <cstddef>
#include <cstdint>

namespace easypbr::native {

/// A picture of which a rectangle is held, row by row; zeros beyond it.
struct View {
    const std::byte* data = nullptr;
    int width = 0, height = 0;  ///< of the picture
    int x = 0, y = 0;           ///< first pixel that is held
    int held_width = 0, held_height = 0;
    int pixel_bytes = 0;  ///< for EncodedLinear
};

// How a sampler reads: by the format, then by the filter. Nearest unless the name says more.
struct R32f : View {};
struct R32ui : View {};
struct Rg8 : View {};
struct R16 : View {};
struct Rg16 : View {};
struct Rgba8 : View {};
struct Rgba16 : View {};
struct Rgba16f : View {};
struct Rgba32f : View {};
struct Rgba32ui : View {};
// Held whole.
struct R16fLinear : View {};
/// Four channels of 8 or of 16 bits, by View::pixel_bytes.
struct EncodedLinear : View {};
struct Rg16fLinear : View {};
struct Rgba16fLinear : View {};
struct Rgba32fLinear : View {};

/// Faces of halves, four channels a texel, with a border of one texel from the neighbouring faces: bilinear
/// filtering is seamless. Levels are from the largest on, six faces each.
struct Cube {
    static constexpr int most_levels = 16;

    const uint16_t* data = nullptr;
    int size = 0;  ///< of a face of the largest level, without its border
    int levels = 0;
    int offsets[most_levels] = {};  ///< of levels, in texels
};

/// An equirectangular picture of halves, four channels a texel, with the first column once more after the
/// last.
struct Panorama {
    static constexpr int most_levels = 16;

    const uint16_t* data = nullptr;
    int levels = 0;
    int width[most_levels] = {}, height[most_levels] = {};
    size_t offsets[most_levels] = {};  ///< of levels, in texels
};

/// A picture of four floats a pixel with its mip levels, each half as large as the one before it, rounded
/// down.
struct MipPicture {
    static constexpr int most_levels = 16;

    const float* data[most_levels] = {};  ///< of levels, row by row
    int width = 0, height = 0;            ///< of the largest level
    int levels = 0;
};

/// Square pictures of one float a texel, one after the other.
struct Layers {
    static constexpr int block_size = 16;
    static constexpr int blocks_of(int size) { return (size + block_size - 1) / block_size; }

    const float* data = nullptr;
    int size = 0;
    /// The least and the largest value of each block of block_size by block_size texels, row by row of
    /// blocks, layer by layer; null where they are not known.
    const float *least = nullptr, *largest = nullptr;
};

/// The same of four floats a texel.
struct Layers4 {
    const float* data = nullptr;
    int size = 0;
};

/// An image of a material with all its mip levels, one after the other: four channels of 8 bits, or of 16
/// bits for colours, which are linear then. Rows run from the top, each with a texel more, so that the one to
/// the right of another is always beside it: the first once more where the image repeats, else the last. Each
/// level is half as large as the one before it, down to one texel.
struct Texture {
    static constexpr int most_levels = 16;
    enum class Wrap { repeat, mirror, clamp };

    const std::byte* texels = nullptr;
    bool is_16_bit = false;
    int width = 0, height = 0, levels = 0;
    int offsets[most_levels] = {};  ///< of levels, in texels
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    bool nearest = false;  ///< no filter, the largest level alone
};

/// The type of each sampler, by the name of the uniform.
namespace samplers {
using u_albedo = Rgba16;
using u_normal = Rg16;
using u_material = Rgba8;
using u_depth_target = R32f;
using u_part = R32f;
using u_shadow_share = R32f;
using u_dfg = Rg16fLinear;
using u_ltc = Rgba32f;
using u_emission = Rgba32f;
using u_ambient_occlusion = R16;
using u_surface = Rgba32f;
using u_light = Rgba32f;
using u_estimate = Rgba32f;
using u_estimated_hue = Rgba32f;
using u_guides = Rgba32f;
using u_visibility = R16;
using u_shadow_maps = Layers;
using u_tint_absorption = Layers4;
using u_tint_moment = Layers4;
using u_prefiltered = Cube;
using u_irradiance = Cube;
using u_sky_visibility = Rgba16f;
using u_indirect_diffuse = Rgba16f;
using u_indirect_specular = Rgba16f;
using u_equirect = Panorama;
using u_source = Rgba32f;
using u_level = Rgba16fLinear;
using u_rise_rise = Rgba32f;
using u_fall_rise = Rgba32f;
using u_rise_fall = Rgba32f;
using u_fall_fall = Rgba32f;
using u_half_light = Rgba16f;
using u_confusion = R32f;
using u_behind = Rgba16fLinear;
using u_before = Rgba16fLinear;
using u_behind_picture = MipPicture;
using u_behind_depth = R32f;
using u_exit_depth = R32f;
using u_exit_normal = Rg16;
using u_finer = Rgba32fLinear;
using u_hidden = R16fLinear;
using u_weight = R16fLinear;
using u_edges = Rg8;
using u_last_depth = R32f;
using u_next_depth = R32f;
using u_nearest_line = R32f;
using u_table = Texture;
using u_id = R32ui;
using u_id_depth = R32f;
using u_radiance = Rgba32f;
using u_overlay = Rgba16f;
using u_shade = R16;
using u_nearest = R32f;
using u_opaque = R32f;
using u_glow = Rgba16fLinear;
using u_background_image = Rgba32fLinear;
using u_color = EncodedLinear;
using u_base_color_texture = Texture;
using u_metallic_texture = Texture;
using u_roughness_texture = Texture;
using u_normal_texture = Texture;
using u_occlusion_texture = Texture;
using u_emissive_texture = Texture;
using u_opacity_texture = Texture;
using u_clearcoat_texture = Texture;
using u_clearcoat_roughness_texture = Texture;
using u_clearcoat_normal_texture = Texture;
using u_sheen_color_texture = Texture;
using u_sheen_roughness_texture = Texture;
using u_specular_texture = Texture;
using u_specular_color_texture = Texture;
using u_transmission_texture = Texture;
using u_thickness_texture = Texture;
using u_iridescence_texture = Texture;
using u_iridescence_thickness_texture = Texture;
using u_anisotropy_texture = Texture;
using u_sheen_albedo = R16fLinear;
using u_extension0 = Rgba32ui;
using u_extension1 = Rgba32ui;
}  // namespace samplers

/// Values that are the same for all pixels, as GLSL names their types.
namespace uni {

#define EASYPBR_INLINE inline __attribute__((always_inline))

struct vec2 {
    float x, y;
    EASYPBR_INLINE constexpr vec2() : x(0), y(0) {}
    EASYPBR_INLINE constexpr vec2(float a, float b) : x(a), y(b) {}
    EASYPBR_INLINE float operator[](int i) const { return i == 0 ? x : y; }
    EASYPBR_INLINE constexpr vec2 xy() const { return *this; }
};
struct vec3 {
    float x, y, z;
    EASYPBR_INLINE constexpr vec3() : x(0), y(0), z(0) {}
    EASYPBR_INLINE constexpr vec3(float a, float b, float c) : x(a), y(b), z(c) {}
    EASYPBR_INLINE constexpr explicit vec3(float a) : x(a), y(a), z(a) {}
    EASYPBR_INLINE constexpr vec2 xy() const { return {x, y}; }
    EASYPBR_INLINE constexpr vec3 xyz() const { return *this; }
    EASYPBR_INLINE constexpr vec3 yzx() const { return {y, z, x}; }
};
struct vec4 {
    float x, y, z, w;
    EASYPBR_INLINE constexpr vec2 xy() const { return {x, y}; }
    EASYPBR_INLINE constexpr vec2 zw() const { return {z, w}; }
    EASYPBR_INLINE constexpr vec3 xyz() const { return {x, y, z}; }
};

}  // namespace uni

/// By columns.
struct mat3 {
    float m[9];
    EASYPBR_INLINE constexpr mat3() : m{} {}
    EASYPBR_INLINE constexpr mat3(float a, float b, float c, float d, float e, float f, float g, float h,
                                  float i)
        : m{a, b, c, d, e, f, g, h, i} {}
};

}  // namespace easypbr::native

// Material: glTF 2.0's metallic-roughness model with the material extensions that the Khronos group ratified.
#pragma once

#include <limits>
#include <memory>
#include <string>

#include "easypbr/core/image.h"
#include "easypbr/core/math.h"
#include "easypbr/scene/array.h"
#include "easypbr/scene/auto.h"

namespace easypbr {

enum class Wrap { repeat, mirror, clamp };
enum class Filter { linear, nearest };
enum class AlphaMode { opaque, mask, blend };

/// An image with the way it is laid on a surface. uv (0, 0) is the lower left corner of the image (OBJ, PLY;
/// the glTF loader flips v). Empty when `image` is null.
struct Texture {
    std::shared_ptr<const Image> image;
    std::string path;  ///< where the image came from, for messages and saving; may be empty
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    Filter filter = Filter::linear;
    Mat3 uv_transform = Mat3::Identity();  ///< applied to (u, v, 1)
    int channel = 0;  ///< the channel read by a one-channel use (metallic, roughness, occlusion, ...)

    explicit operator bool() const { return image != nullptr; }
};

/// GLSL with a function `void surface(inout Surface s)` that changes what a surface is made of; see
/// shaders/geometry_shader.glsl for what it finds in `s`. Empty when both are.
struct SurfaceShader {
    std::string text;
    std::string path = {};  ///< of a file that is read before each picture, in place of a text

    explicit operator bool() const { return !text.empty() || !path.empty(); }
    bool operator==(const SurfaceShader&) const = default;
};

/// Factors multiply their textures. Colours are linear Rec.709. Ranges, and what each number and texture
/// means, stand in scene/material_table.h.
struct Material {
    std::string name;
    Vec3 base_color{0.6f, 0.6f, 0.6f};
    float opacity = 1;
    float metallic = 0;      ///< 0 dielectric .. 1 metal
    float roughness = 0.5f;  ///< perceptual, 0 .. 1; alpha = roughness^2
    Vec3 emissive{0, 0, 0};  ///< radiance added to the picture, strength included
    float normal_scale = 1;
    float occlusion_strength = 1;
    /// Automatic: blend where the opacity or a vertex' alpha is below 1, mask where there is an opacity
    /// texture alone, else opaque.
    Auto<AlphaMode> alpha_mode;
    float alpha_cutoff = 0.5f;
    bool double_sided = true;
    bool unlit = false;  ///< base colour is shown as it is

    // KHR_materials_clearcoat: a clear layer of varnish (index of refraction 1.5) on top.
    float clearcoat = 0;
    float clearcoat_roughness = 0;
    float clearcoat_normal_scale = 1;

    // KHR_materials_sheen: fibres that stand off a cloth.
    Vec3 sheen_color{0, 0, 0};
    float sheen_roughness = 0;

    // KHR_materials_specular, KHR_materials_ior: the reflection of a dielectric.
    float ior = 1.5f;  ///< index of refraction; 0: reflects all
    float specular = 1;
    Vec3 specular_color{1, 1, 1};

    // KHR_materials_transmission, KHR_materials_volume: light goes through.
    float transmission = 0;
    float thickness = 0;  ///< of the volume below the surface, mesh units; 0: thin-walled
    Vec3 attenuation_color{1, 1, 1};
    float attenuation_distance = std::numeric_limits<float>::infinity();  ///< world units

    // KHR_materials_iridescence: a thin film.
    float iridescence = 0;
    float iridescence_ior = 1.3f;
    float iridescence_thickness_min = 100;  ///< nanometres, where its texture is 0
    float iridescence_thickness_max = 400;  ///< nanometres, where its texture is 1 or absent

    // KHR_materials_anisotropy: reflections are drawn out along a direction.
    float anisotropy = 0;
    float anisotropy_rotation_deg = 0;  ///< counter-clockwise from the tangent

    Texture base_color_texture;  ///< sRGB; its alpha multiplies opacity
    Texture metallic_texture;
    Texture roughness_texture;
    Texture normal_texture;  ///< tangent space, +Y up (OpenGL, glTF)
    Texture occlusion_texture;
    Texture emissive_texture;  ///< sRGB
    Texture opacity_texture;   ///< used by alpha modes mask and blend

    Texture clearcoat_texture;
    Texture clearcoat_roughness_texture;
    Texture clearcoat_normal_texture;
    Texture sheen_color_texture;  ///< sRGB
    Texture sheen_roughness_texture;
    Texture specular_texture;
    Texture specular_color_texture;  ///< sRGB
    Texture transmission_texture;
    Texture thickness_texture;
    Texture iridescence_texture;
    Texture iridescence_thickness_texture;
    Texture anisotropy_texture;  ///< rg: direction, as in a normal map; b: strength

    SurfaceShader shader;  ///< of faces

    bool has_textures() const;

    /// Whether the shading needs more than glTF's core model.
    bool is_extended() const;
    /// Whether light goes through the surface itself (not: around it, as with opacity).
    bool transmits() const { return transmission > 0; }

    /// What alpha_mode stands for on a mesh some of whose vertices are, or are not, transparent.
    AlphaMode alpha_mode_for(bool transparent_vertices) const;

    /// Part of white light that goes straight through, factors alone: for shadows. 0 for opaque and masked
    /// materials, 1 - opacity for blended ones, and what a surface transmits, tinted by its base colour and
    /// its volume.
    Vec3 transmittance(AlphaMode mode) const;
};

/// Whether colours (n x 3 or n x 4) have an alpha below 1. All 0 counts as none: some programs write it and
/// mean nothing by it.
bool has_transparent_colors(const ArrayXf& C);

}  // namespace easypbr

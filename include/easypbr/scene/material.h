// Material: glTF 2.0's metallic-roughness model with the material extensions that the Khronos group ratified.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "easypbr/core/image.h"
#include "easypbr/core/math.h"
#include "easypbr/scene/array.h"
#include "easypbr/scene/auto.h"

namespace easypbr {

enum class Wrap { repeat, mirror, clamp };
enum class Filter { linear, nearest };
enum class AlphaMode { opaque, mask, blend };

/// An image with its sampler and UV transform. uv (0, 0) is the lower left corner of the image (OBJ, PLY;
/// the glTF loader flips v). Empty when `image` is null; an image without pixels is refused.
struct Texture {
    std::shared_ptr<const Image> image;
    /// Where the image came from, for messages and saving; may be empty. Absolute where the library read it.
    std::string path;
    /// Of the file at `path` when the image was read; none: not known. Files of meshes name the file while it
    /// is in this state.
    std::optional<FileState> file_state = {};
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    Filter filter = Filter::linear;
    Mat3 uv_transform = Mat3::Identity();  ///< applied to (u, v, 1)
    int channel = 0;  ///< the channel read by a one-channel use (metallic, roughness, occlusion, ...)

    explicit operator bool() const { return image != nullptr; }
    /// Whether it is the same image object, used in the same way.
    bool operator==(const Texture&) const = default;
};

/// GLSL with a function `void surface(inout Surface s)` that modifies the surface before lighting; see
/// shaders/geometry_shader.glsl for the members of `s`. Empty when both are.
struct SurfaceShader {
    std::string text;
    std::string path = {};  ///< of a file that is read before each image, in place of `text`

    explicit operator bool() const { return !text.empty() || !path.empty(); }
    bool operator==(const SurfaceShader&) const = default;
};

/// Factors multiply their textures. Colours are linear Rec.709.
struct Material {
    std::string name;
    Vec3 base_color{0.6f, 0.6f, 0.6f};  ///< this default is white beside others, see color_factor()
    float opacity = 1;                  ///< 0 transparent to 1 opaque
    float metallic = 0;                 ///< 0 dielectric to 1 metal
    float roughness = 0.5f;             ///< perceptual, 0 to 1; alpha = roughness^2
    Vec3 emissive{0, 0, 0};             ///< emitted radiance, strength included
    float normal_scale = 1;             ///< of the normal texture
    float occlusion_strength = 1;       ///< of the occlusion texture, 0 to 1
    /// Automatic: blend where the opacity or the alpha of a vertex is below 1, mask where there is an opacity
    /// texture alone, else opaque.
    Auto<AlphaMode> alpha_mode;
    float alpha_cutoff = 0.5f;  ///< alpha mode mask: fragments below are discarded
    bool double_sided = true;   ///< no back-face culling
    bool unlit = false;         ///< the base colour is the radiance (KHR_materials_unlit); see DrawStyle::lit

    // KHR_materials_clearcoat: a dielectric layer (index of refraction 1.5) over the base.
    float clearcoat = 0;               ///< strength, 0 to 1
    float clearcoat_roughness = 0;     ///< perceptual, 0 to 1
    float clearcoat_normal_scale = 1;  ///< of the clearcoat normal texture

    // KHR_materials_sheen: back-scattering of cloth fibres.
    Vec3 sheen_color{0, 0, 0};  ///< black: no sheen
    float sheen_roughness = 0;  ///< 0 to 1

    // KHR_materials_specular, KHR_materials_ior: the specular reflection of dielectrics.
    static constexpr float default_ior = 1.5f;
    static constexpr float default_f0 = 0.04f;  ///< reflectance of default_ior at normal incidence
    float ior = default_ior;                    ///< index of refraction, 1 to 100; 0: reflectance 1
    float specular = 1;                         ///< strength, 0 to 1
    Vec3 specular_color{1, 1, 1};               ///< at normal incidence

    // KHR_materials_transmission, KHR_materials_volume: refraction and absorption.
    float transmission = 0;           ///< fraction of light transmitted, 0 to 1
    float thickness = 0;              ///< of the volume below the surface, mesh units; 0: thin-walled
    Vec3 attenuation_color{1, 1, 1};  ///< of white light after attenuation_distance
    float attenuation_distance = std::numeric_limits<float>::infinity();  ///< world units, above 0

    // KHR_materials_dispersion: the index of refraction of volumes grows from red to blue.
    float dispersion = 0;  ///< 20 / Abbe number, 0 to 40

    // KHR_materials_iridescence: thin-film interference.
    float iridescence = 0;                  ///< strength, 0 to 1
    float iridescence_ior = 1.3f;           ///< index of refraction of the thin film, 1 to 100
    float iridescence_thickness_min = 100;  ///< nanometres, where its texture is 0
    float iridescence_thickness_max = 400;  ///< nanometres, where its texture is 1 or absent

    // KHR_materials_anisotropy: roughness that differs along and across a direction.
    float anisotropy = 0;               ///< strength, 0 to 1
    float anisotropy_rotation_deg = 0;  ///< degrees, counter-clockwise from the tangent

    // Texels are 0 to 1; f32 is clamped, with a warning for colours. Integers of colours are sRGB-encoded,
    // f32 colours are linear. Other textures hold numbers, whatever their type.
    Texture base_color_texture;  ///< colour; its alpha multiplies opacity; times color_factor()
    Texture metallic_texture;
    Texture roughness_texture;
    Texture normal_texture;  ///< tangent space, +Y up (OpenGL, glTF)
    Texture occlusion_texture;
    Texture emissive_texture;  ///< colour; the factor makes it brighter than 1
    Texture opacity_texture;   ///< used by alpha modes mask and blend

    Texture clearcoat_texture;
    Texture clearcoat_roughness_texture;
    Texture clearcoat_normal_texture;
    Texture sheen_color_texture;  ///< colour
    Texture sheen_roughness_texture;
    Texture specular_texture;
    Texture specular_color_texture;  ///< colour
    Texture transmission_texture;
    Texture thickness_texture;
    Texture iridescence_texture;
    Texture iridescence_thickness_texture;
    Texture anisotropy_texture;  ///< rg: direction, as in a normal map; b: strength

    SurfaceShader shader;  ///< of faces

    /// A file says its base colour beside colours of vertices or a base colour texture: no default.
    bool base_color_given = false;

    /// Whether its base colour is the default.
    bool has_default_color() const;
    /// What colours of vertices and the base colour texture are multiplied by, linear: the base colour, and
    /// white in place of the default where there are colours, or a base colour texture on faces with texture
    /// coordinates.
    Vec3 color_factor(bool with_colors, bool with_coordinates) const;
    /// Whether all values are equal and all textures, as Texture::operator== has it.
    bool operator==(const Material&) const = default;

    bool has_textures() const;

    /// Whether a material extension is in use, beyond the metallic-roughness core of glTF.
    bool is_extended() const;

    /// Whether it specifies an index of refraction: glTF's default does not.
    bool names_ior() const { return ior != default_ior; }
    /// Reflectance of its dielectric part at normal incidence; `unnamed` where it specifies no index.
    float dielectric_f0(float unnamed) const;
    /// The index of red (0), green (1) or blue (2) in a volume (Khronos, KHR_materials_dispersion).
    float ior_of_channel(int channel) const;
    /// Whether the surface transmits light (KHR_materials_transmission), as opposed to alpha coverage.
    bool transmits() const { return transmission > 0; }

    /// The alpha mode on a mesh with or without transparent vertices: resolves an automatic one.
    AlphaMode alpha_mode_for(bool transparent_vertices) const;

    /// Straight-line transmittance for shadows, from the factors alone: 1 - opacity for alpha mode blend,
    /// plus the transmission tinted by the base colour and the absorption of the volume. 0 for opaque and
    /// masked materials without transmission.
    Vec3 transmittance(AlphaMode mode) const;
};

/// Whether colours (n x 3 or n x 4) have an alpha below 1. An alpha of 0 everywhere counts as none, because
/// some programs write it without meaning.
bool has_transparent_colors(const ArrayXf& C);

}  // namespace easypbr

// The one table of what a material is made of: numbers, colours and textures with ranges and documentation.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "easypbr/scene/material.h"

namespace easypbr {

struct MaterialSettings;
class NamedFile;

struct MaterialNumber {
    const char* name;  ///< of the member, and of the attribute in Python
    float Material::*value;
    float min, max;
    const char* doc;
};

struct MaterialColor {
    const char* name;
    Vec3 Material::*value;
    float max;  ///< of each channel; the least is 0
    const char* doc;
};

/// How a texture's texels are meant.
enum class TexelUse {
    color,   ///< sRGB
    vector,  ///< linear; a direction in tangent space
    number   ///< linear; the one channel that Texture::channel names
};

struct MaterialTexture {
    const char* name;  ///< without "_texture"
    Texture Material::*texture;
    TexelUse use;
    const char* doc;
    /// File that replaces the texture in every material, "material.NAME_texture"; null: there is no such
    /// setting. Those of glTF's core model have one, those of its extensions have none.
    NamedFile MaterialSettings::*setting = nullptr;
    const char* setting_doc = nullptr;
};

std::span<const MaterialNumber> material_numbers();
std::span<const MaterialColor> material_colors();
/// In the order of the rows of u_uv_transform in shaders/geometry_mesh.frag, those with a setting first.
std::span<const MaterialTexture> material_textures();
/// Those with a setting.
std::span<const MaterialTexture> replaceable_textures();

/// Throws ArgumentError that names the material, the value and its range, when one is outside of it,
/// and for a texture whose image is empty.
void validate(const Material& material);

/// Brings values from a file into their ranges; one sentence about each that was changed.
std::vector<std::string> clamp_to_ranges(Material& material);

}  // namespace easypbr

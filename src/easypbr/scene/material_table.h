// The one table of what a material is made of: numbers, colours and textures with ranges and documentation.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "easypbr/scene/material.h"

namespace easypbr {

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

struct MaterialTexture {
    const char* name;  ///< without "_texture"
    Texture Material::*texture;
    bool color;  ///< sRGB, else data
    const char* doc;
};

std::span<const MaterialNumber> material_numbers();
std::span<const MaterialColor> material_colors();
std::span<const MaterialTexture> material_textures();

/// Throws ArgumentError that names the material, the value and its range, when one is outside of it.
void validate(const Material& material);

/// Brings values from a file into their ranges; one sentence about each that was changed.
std::vector<std::string> clamp_to_ranges(Material& material);

}  // namespace easypbr

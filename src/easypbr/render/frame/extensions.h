// Which of glTF's material extensions a frame has to shade.
#pragma once

#include <string>
#include <vector>

#include "easypbr/scene/material.h"

namespace easypbr::render {

/// A set of bits; 0 for surfaces of glTF's core model.
using ExtensionSet = unsigned;

enum ExtensionBit : ExtensionSet {
    dielectric_bit = 1,  ///< KHR_materials_ior, _specular
    clearcoat_bit = 2,
    sheen_bit = 4,
    transmission_bit = 8,  ///< KHR_materials_transmission, _volume
    iridescence_bit = 16,
    anisotropy_bit = 32
};

ExtensionSet extensions_of(const Material& material);

/// Macros of shaders that light extended surfaces; none for an empty set.
void add_extension_defines(ExtensionSet extensions, std::vector<std::string>& defines);

}  // namespace easypbr::render

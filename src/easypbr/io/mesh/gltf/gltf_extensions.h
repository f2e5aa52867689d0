// The Khronos group's material extensions of glTF: names, and numbers to and from JSON. Their textures are
// read and written beside those of the core model.
#pragma once

#include "easypbr/io/mesh/gltf/gltf_document.h"
#include "easypbr/scene/material.h"

namespace easypbr::io {

inline constexpr const char* khr_unlit = "KHR_materials_unlit";
inline constexpr const char* khr_emissive_strength = "KHR_materials_emissive_strength";
inline constexpr const char* khr_clearcoat = "KHR_materials_clearcoat";
inline constexpr const char* khr_sheen = "KHR_materials_sheen";
inline constexpr const char* khr_specular = "KHR_materials_specular";
inline constexpr const char* khr_ior = "KHR_materials_ior";
inline constexpr const char* khr_transmission = "KHR_materials_transmission";
inline constexpr const char* khr_volume = "KHR_materials_volume";
inline constexpr const char* khr_dispersion = "KHR_materials_dispersion";
inline constexpr const char* khr_iridescence = "KHR_materials_iridescence";
inline constexpr const char* khr_anisotropy = "KHR_materials_anisotropy";
inline constexpr const char* ext_texture_webp = "EXT_texture_webp";

/// Reads the numbers of all extensions that a material has; those it has not keep their defaults.
void read_gltf_extensions(const GltfDocument& document, const Json& json, Material& out);

}  // namespace easypbr::io

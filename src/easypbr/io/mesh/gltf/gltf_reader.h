// glTF 2.0 and GLB (Khronos glTF 2.0 specification).
#pragma once

#include <filesystem>
#include <span>

namespace easypbr::io {

struct LoadedScene;

/// Reads the file's default scene: a mesh named after the file without vertices of its own, whose children
/// are the scene's nodes. Understood: KHR_materials_emissive_strength, KHR_texture_transform,
/// KHR_materials_unlit, KHR_lights_punctual, KHR_mesh_quantization; another extension is an error where
/// the file requires it, else a warning. Skins and morph targets are at rest until an animation is applied.
/// Throws FileError and FormatError as load_scene() does.
LoadedScene load_gltf(const std::filesystem::path& path);

/// The same from memory; files that it names are looked for beside `path`.
LoadedScene decode_gltf(std::span<const std::byte> bytes, const std::filesystem::path& path);

}  // namespace easypbr::io

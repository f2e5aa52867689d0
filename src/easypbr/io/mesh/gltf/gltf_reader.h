// glTF 2.0 and GLB (Khronos glTF 2.0 specification).
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace easypbr::io {

struct LoadedScene;

/// Reads the file's default scene: a mesh named after the file without vertices of its own, whose children
/// are the scene's nodes. Which extensions are read stands in docs/formats.md; another one is an error where
/// the file requires it, else a warning. Until an animation is applied skins follow their joints at rest, and
/// morph targets have the weights of the file. `variant`: as LoadOptions::variant. Throws
/// FileError, FormatError and NameError as load_scene() does.
LoadedScene load_gltf(const std::filesystem::path& path, const std::string& variant = {});

/// The same from memory; files that it names are looked for beside `path`.
LoadedScene decode_gltf(std::span<const std::byte> bytes, const std::filesystem::path& path,
                        const std::string& variant = {});

}  // namespace easypbr::io

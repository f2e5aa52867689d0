// Meshes as binary glTF 2.0.
#pragma once

#include <filesystem>
#include <string>

#include "easypbr/scene/mesh_data.h"

namespace easypbr::io {

/// Writes the hierarchy with poses, parts as primitives, materials and textures (embedded as PNG). Colours
/// become linear floats. Metallic and roughness textures that are two images are merged into one, an opacity
/// texture becomes the base colour's alpha. Nodes that share their arrays have one mesh, and equal materials
/// are one. Labels, intensities and scalars of vertices are attributes of their own (gltf_values.h). Styles,
/// T, B and values of faces are not part of the format. Throws FileError; ArgumentError for a mesh without
/// any vertices. Never leaves half a file.
void save_glb(const Mesh& mesh, const std::filesystem::path& path);

/// The bytes of such a file.
std::string encode_glb(const Mesh& mesh);

}  // namespace easypbr::io

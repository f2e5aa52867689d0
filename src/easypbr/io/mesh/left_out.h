// What formats have no place for: names for a warning.
#pragma once

#include <string>
#include <vector>

#include "easypbr/io/mesh/mesh_io.h"

namespace easypbr::io {

/// Whether a mesh has a voxel size that the format has a place for: GLB, and NPZ for a mesh without faces.
bool keeps_voxel_size(const MeshData& mesh, const std::string& extension);

/// What left_out() calls the voxel size.
inline constexpr const char* left_out_voxel_size = "the voxel size";

/// What of a mesh is left out, beside faces, splats, and left_out_of_gltf(). Formats without materials have
/// with_material_colors().
std::vector<std::string> left_out(const MeshData& mesh, const std::string& extension);

/// What of a scene is left out beside its mesh: no format that is written has it.
std::vector<std::string> left_out(const LoadedScene& scene);

/// The mesh with the base colours and opacities of its materials in the colours of its vertices, and without
/// them in its materials. The mesh as it is where a colour is multiplied by a texture, or where faces of
/// several colours share a vertex. White and the default, where nothing else is, are no colours.
MeshData with_material_colors(const MeshData& mesh);

}  // namespace easypbr::io

// Copies of a node's mesh (EXT_mesh_gpu_instancing).
#pragma once

#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/io/mesh/gltf/gltf_document.h"

namespace easypbr::io {

inline constexpr const char* ext_mesh_gpu_instancing = "EXT_mesh_gpu_instancing";

/// Poses in the node's frame of the copies that a node, `json`, asks for; nothing without the extension.
/// Throws FormatError for attributes of different lengths or not finite, and for more copies than reading may
/// take.
std::optional<std::vector<Eigen::Affine3d>> read_gltf_instances(GltfDocument& document, const Json& json,
                                                                size_t node);

}  // namespace easypbr::io

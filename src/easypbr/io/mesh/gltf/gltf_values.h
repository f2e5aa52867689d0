// Labels, intensities and scalars of vertices as application-specific attributes of glTF, whose names begin
// with "_".
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "easypbr/io/mesh/gltf/gltf_document.h"
#include "easypbr/scene/mesh_data.h"
#include "easypbr/scene/rounding.h"

namespace easypbr::io {

inline constexpr const char* gltf_label_name = "_LABEL";
inline constexpr const char* gltf_intensity_name = "_INTENSITY";

/// Rows of floats by the names of attributes.
using GltfValues = std::map<std::string, ArrayXf::Dense>;

/// What of a mesh's values is written, all as floats.
GltfValues values_for_gltf(const MeshData& data);
/// What of a mesh has no place in a file: names for a message.
std::vector<std::string> left_out_of_gltf(const MeshData& data);

/// Adds the names of such attributes of a primitive that hold numbers.
void find_gltf_values(const GltfDocument& document, const Json& attributes, std::set<std::string>& names);

/// Makes values of the vertices labels, intensities or scalars, by the attribute's name. Scalars of files do
/// not colour the mesh unless asked to. `rounding`: what float32 made of each column, or empty; a warning
/// that begins with `path` names scalars and intensities of which it takes what tells them apart.
void add_gltf_values(const std::string& attribute, const ArrayXf::Dense& values,
                     const std::vector<RoundingCounts>& rounding, const std::filesystem::path& path,
                     MeshData& data);

}  // namespace easypbr::io

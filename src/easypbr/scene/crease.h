// Sharp edges: vertices whose faces meet at an angle get one normal per side.
#pragma once

#include <cstdint>
#include <vector>

#include "easypbr/scene/mesh_data.h"

namespace easypbr {

/// Fills N. Faces round a vertex share a normal when a chain of common edges joins them across which the face
/// normals differ by at most `crease_angle_deg`; otherwise the vertex is repeated, and source_vertex is set.
/// Vertices that were split from one (source_vertex) count as one, as for smooth_normals(). A face without
/// area joins what it touches. Returns the row that each vertex had before.
std::vector<int32_t> split_creases(MeshData& mesh, float crease_angle_deg);

/// The same for a mesh and its children, where they have faces without normals that are not drawn flat.
void split_creases(const Mesh& mesh, float crease_angle_deg);

}  // namespace easypbr

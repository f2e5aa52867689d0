// Sharp edges: vertices whose faces meet at an angle get one normal per side.
#pragma once

#include "easypbr/scene/mesh_data.h"

namespace easypbr::io {

/// Fills N. Faces round a vertex share a normal when a chain of common edges joins them across which the face
/// normals differ by at most `crease_angle_deg`; otherwise the vertex is repeated, and source_vertex is set.
/// A face without area joins what it touches.
void split_creases(MeshData& mesh, float crease_angle_deg);

}  // namespace easypbr::io

// Polygons that faces are triangles of (MeshData::source_face), and values given for each of them.
#pragma once

#include "easypbr/scene/mesh_data.h"

namespace easypbr {

/// One more than the largest number in source_face; 0 where there is none.
Eigen::Index polygon_count(const MeshData& mesh);

/// Gives labels and scalars that have a row per polygon a row per triangle. Rows for each vertex and rows for
/// each triangle stay what they are. Where there are as many triangles as vertices, a vertex is added as
/// tell_faces_from_vertices() does. Throws ArgumentError as validate() does.
void spread_polygon_values(MeshData& mesh);

}  // namespace easypbr

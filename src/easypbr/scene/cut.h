// Cutting away a part of an object.
#pragma once

#include <vector>

#include "easypbr/scene/mesh_data.h"

namespace easypbr {

/// What lies on the positive side of all planes, n . p + d >= 0 with (n, d) in the mesh's own frame. Faces
/// and edges are cut where planes go through them, vertices between interpolated; with
/// `by_vertex` each vertex is kept or left out whole. Normals that a mesh has not are computed
/// before, so that a cut changes no shading. Labels and scalars are not kept. `faces` and
/// `vertices`: for each face and each vertex the one it came from; for a vertex between others that with the
/// largest part in it.
MeshData cut(const MeshData& mesh, const std::vector<Eigen::Vector4d>& planes, bool by_vertex, Array1i& faces,
             Array1i& vertices);

}  // namespace easypbr

// What vertex normals are made of.
#pragma once

#include "easypbr/scene/array.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::detail {

/// For each vertex the sum of its faces' normals, weighted by area times the corner's angle. The unit is a
/// power of two that depends on the largest coordinate. Throws as vertex_normals() does.
Array3f::Dense normal_sums(const Array3f& V, const Array3i& F);

/// Rows of length 1; +z for zero.
Array3f directions(Array3f::Dense vectors);

/// The faces of a mesh with vertices that were split from one (source_vertex) as one.
struct UnitedMesh {
    Array3f V;
    Array3i F;
    Array1i rows;  ///< of V for each vertex of the mesh; empty: the same

    explicit UnitedMesh(const MeshData& mesh);
};

}  // namespace easypbr::detail

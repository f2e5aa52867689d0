// A mesh with sharp edges and without normals.
#pragma once

#include "easypbr/scene/mesh_data.h"

/// A cube of 8 vertices and 12 triangles, two for each side.
inline easypbr::MeshData cube() {
    easypbr::MeshData mesh;
    easypbr::Array3f::Dense V(8, 3);
    for (int i = 0; i < 8; ++i) V.row(i) << float(i & 1), float(i >> 1 & 1), float(i >> 2);
    mesh.V = std::move(V);
    mesh.F = easypbr::Array3i::Dense{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                     {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

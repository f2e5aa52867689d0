// Vertices of the primitives of a glTF mesh, before they are those of one mesh.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "easypbr/io/mesh/gltf/gltf_values.h"
#include "easypbr/scene/array.h"

namespace easypbr::io {

/// Vertices that primitives with the same accessors share. Absent attributes have no rows.
struct VertexBlock {
    Eigen::Index first = 0, row_count = 0;
    ArrayXf::Dense V, N, UV, tangents, C, joints, weights;
    std::vector<ArrayXf::Dense> targets_V, targets_N;  ///< of morph targets; without rows where one has none
    GltfValues values;                                 ///< without rows where there are none
    std::vector<int32_t> triangles;                    ///< of all primitives; indices into the block
};

/// Brings what was read into the form that MeshData has: unit normals and tangents, v upwards, sRGB colours.
void tidy(VertexBlock& block);

/// Replaces a block's vertices by those of the rows. `name` is for messages. Throws as charge_memory() does.
void choose_rows(VertexBlock& block, const std::vector<int32_t>& rows, const std::string& name);

/// Faces with vertices of their own, and for each vertex of all blocks the one that it was before. Both are
/// empty where nothing was split.
struct GltfFlatFaces {
    Array3i F;
    Array1i source_vertex;
};

/// Gives each face of blocks without normals vertices of its own. Others of such a block remain only for
/// lines. `faces` and `edges` are the corners of all faces and ends of all lines, counted over all blocks.
/// `name` is for messages. Throws FormatError when 32-bit indices cannot count the vertices, before any are
/// made, and as charge_memory() does.
GltfFlatFaces split_flat_faces(std::vector<VertexBlock>& blocks, std::vector<int32_t>& faces,
                               std::vector<int32_t>& edges, const std::string& name);

}  // namespace easypbr::io

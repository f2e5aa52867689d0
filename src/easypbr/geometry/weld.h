// Which vertices are at the same place.
#pragma once

#include <cstdint>
#include <vector>

#include "easypbr/scene/mesh_data.h"

namespace easypbr::geometry {

struct Weld {
    std::vector<int32_t> place;  ///< for each vertex the number of its position, from 0
    std::vector<int32_t> first;  ///< for each position the first vertex that is there, rising

    size_t count() const { return first.size(); }
};

/// Vertices with equal coordinates (-0 is 0) are one position.
Weld weld_positions(const Array3f& V);

/// Sets source_vertex so that vertices at one place count as one for smooth normals; clears it when no two
/// are. For meshes whose vertices have come to be others than those of the file.
void remember_seams(MeshData& mesh);

}  // namespace easypbr::geometry

// Which vertices are at the same place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "easypbr/scene/mesh_data.h"

namespace easypbr::geometry {

/// For each of `count` rows of `size` bytes a number, the same for rows of the same bytes: from 0 in the
/// order in which they first occur. Throws Interrupted.
std::vector<unsigned int> numbered_rows(std::shared_ptr<const void> rows, size_t count, size_t size);

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

// Cubes for the cells of a grid.
#pragma once

#include "easypbr/scene/mesh_data.h"

namespace easypbr {

/// The outer faces of cubes of edge `size`, one for each cell of a grid that holds vertices; the grid has a
/// centre of a cell at the first vertex. Sides between two cells that are both there are left out. Colours
/// (C) are the means of a cell's vertices; labels, scalars and intensities are not kept. `source_face` tells
/// for each triangle the first vertex of its cell. Throws ArgumentError for a size that is not positive or so
/// small that cells cannot be counted.
MeshData voxel_mesh(const MeshData& mesh, double size);

}  // namespace easypbr

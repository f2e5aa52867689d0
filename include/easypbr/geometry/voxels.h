// Grids of cells as meshes that are drawn as cubes.
#pragma once

#include <array>
#include <span>

#include "easypbr/scene/mesh.h"

namespace easypbr {

/// Where the cells of a grid lie. Cell (i, j, k), along x, y and z, is the cube of edge cell_size whose
/// lowest corner is origin + cell_size * (i, j, k); its value stands at (i * cells[1] + j) * cells[2] + k, as
/// in a numpy array indexed [i, j, k].
struct VoxelGrid {
    std::array<int, 3> cells{};
    Vec3d origin{0, 0, 0};
    double cell_size = 1;
};

/// The cells that are not 0. V are their centres in the order of the values, and MeshData::voxel_size is the
/// cell size. All of these throw ArgumentError when the number of values is not that of the cells, a count is
/// negative, the cell size is not above 0 or the origin is not finite.
Mesh make_voxels(const VoxelGrid& grid, std::span<const uint8_t> occupied);

/// The cells whose label is not `empty`, with L.
Mesh make_voxels(const VoxelGrid& grid, std::span<const int32_t> labels, int32_t empty = 0);

/// Cells with colours (a row each, sRGB 0 .. 1). With four columns those whose alpha is above 0, with three
/// those that are not NaN. C has the columns given.
Mesh make_voxels(const VoxelGrid& grid, const ArrayXf& colors);

}  // namespace easypbr

// Fewer points: a random choice, or one for each cell of a grid.
#pragma once

#include <cstdint>

#include "easypbr/scene/mesh.h"

namespace easypbr {

/// `count` vertices, each set of that size as likely as any other, in their order and with all that they
/// have; all of them when there are fewer. Faces and edges are left out. The same seed gives the same
/// vertices on every machine. Throws ArgumentError when count is negative.
Mesh subsample_random(const Mesh& mesh, int64_t count, uint64_t seed = 0);

/// One vertex for each cube of edge `cell_size` (on a grid through the origin of the mesh's frame) that has
/// some: at their mean position, with the mean of their normals (of length 1 again), colours, texture
/// coordinates, intensities and scalars (of those that are not NaN) and their most frequent label (of several
/// the least). In the order of the cells' first vertices. Faces, edges, tangents and what belongs to faces
/// are left out. Throws ArgumentError unless cell_size > 0 and there are at most 2^21 cells along each axis.
Mesh subsample_voxels(const Mesh& mesh, double cell_size);

/// The same cubes as voxels: V are their centres, and MeshData::voxel_size is their edge, so that they are
/// drawn as cubes. Normals and texture coordinates are left out. Throws as subsample_voxels() does.
Mesh voxelize(const Mesh& mesh, double cell_size);

}  // namespace easypbr

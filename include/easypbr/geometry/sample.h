// Points on a surface, and fewer points: a random choice, or one for each cell of a grid.
#pragma once

#include <cstdint>

#include "easypbr/scene/mesh.h"

namespace easypbr {

/// `count` points on the faces, uniformly by area: the faces' areas laid end to end are cut into `count`
/// equal stretches, and each gets one point at random, so that a face of n stretches gets n points, give or
/// take one. What vertices have is interpolated (normals of length 1; faces' normals where there are none;
/// labels of the nearest corner), labels and scalars of faces are handed on, source_face leads to the face
/// (of the file, or of the mesh when it has no such order). The same seed gives the same points on every
/// machine. Throws ArgumentError when count < 0 or no face has an area.
Mesh sample_surface(const Mesh& mesh, int64_t count, uint64_t seed = 0);

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

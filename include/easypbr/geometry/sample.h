// Points on a surface.
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

}  // namespace easypbr

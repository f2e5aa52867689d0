// Attributes from files brought into the ranges that MeshData promises.
#pragma once

#include "easypbr/io/tables/polygons.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::io {

/// Normals that are off unit length by more than 0.1 % are normalised, others keep their bits; a normal
/// without a direction becomes (0, 0, 1).
void tidy_normals(Array3f::Dense& N);

/// Colours are clamped to [0, 1]; NaN becomes 0.
void tidy_colors(ArrayXf::Dense& C);

/// Texture coordinates that are not finite become 0.
void tidy_uv(Array2f::Dense& UV);

}  // namespace easypbr::io

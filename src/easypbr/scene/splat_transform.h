// Splats that are moved as a whole.
#pragma once

#include "easypbr/core/math.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr {

/// The splats when their frame is mapped by M: covariances become M S M^T, and colours turn with the nearest
/// rotation (or rotation and mirroring) to M, so that a similarity changes nothing of what is seen.
SplatArrays transformed_splats(const SplatArrays& splats, const Mat3d& M);

}  // namespace easypbr

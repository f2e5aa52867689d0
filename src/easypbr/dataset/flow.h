// Optical flow between two frames.
#pragma once

#include "easypbr/dataset/ground_truth.h"
#include "easypbr/dataset/surfaces.h"

namespace easypbr::dataset {

/// Where the points of `now` are in `other`, and whether they are not seen there: flow and occlusion. A point
/// is seen where one of the four pixels around its place shows its face, or a surface that continues it.
void optical_flow(const Surfaces& now, const Surfaces& other, LayerArray& flow, LayerArray& occlusion);

}  // namespace easypbr::dataset

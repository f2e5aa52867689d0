// Optical flow between two frames.
#pragma once

#include "easypbr/dataset/ground_truth.h"
#include "easypbr/dataset/surfaces.h"

namespace easypbr::dataset {

/// Where the points of `now` are in `other`, and whether they are not seen there: flow and occlusion.
void optical_flow(const Surfaces& now, const Surfaces& other, LayerArray& flow, LayerArray& occlusion);

}  // namespace easypbr::dataset

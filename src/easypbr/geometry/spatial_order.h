// Points in an order in which neighbours in space are near each other in memory.
#pragma once

#include <cstdint>
#include <vector>

#include "easypbr/scene/array.h"

namespace easypbr {

/// Indices of the rows along a Morton curve.
std::vector<int32_t> spatial_order(const Array3f& points);

}  // namespace easypbr

// Elements in the order of their places in space, so that neighbours on the screen are neighbours in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "easypbr/scene/array.h"

namespace easypbr::render {

/// The numbers [0, count) by Morton's curve through a grid of 1024^3 cells around all vertices, those of a
/// cell in their own order; `vertex_of` tells where each is. As geometry/spatial_order.h for points, but of
/// whatever has a vertex, and vertices may be no numbers.
std::vector<uint32_t> curve_order(const Array3f& V, size_t count,
                                  const std::function<size_t(size_t)>& vertex_of);

}  // namespace easypbr::render

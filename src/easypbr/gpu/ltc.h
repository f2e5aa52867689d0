// The table of linearly transformed cosines (Heitz et al. 2016), fitted when the library was built.
#pragma once

#include <span>

#include "easypbr/native/views.h"

namespace easypbr::gpu {

/// Nodes per side. Node (i, j) holds NoV = (i / (N - 1))^2, roughness = j / (N - 1), row by row in roughness.
inline constexpr int ltc_size = 32;

/// Four numbers a node: (0, 0), (0, 2), (2, 0) and (2, 2) of the inverse matrix, whose (1, 1) is 1 and whose
/// others are 0. x is the projection of the view, z the normal.
std::span<const float> ltc_table();
/// The same for native shaders.
native::View host_ltc();

}  // namespace easypbr::gpu

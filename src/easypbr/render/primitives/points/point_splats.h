// How large the points of an item are in a frame.
#pragma once

#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/raster/visibility.h"

namespace easypbr::render {

/// Automatic splats of this many spacings leave no hole between the points of a square grid (its diagonal
/// is 1.41).
inline constexpr double spacings_per_splat = 1.5;

/// Size and shape of an item's splats. `spacing` is the points' mean distance, in their own units.
PointSplats splats_of(const DrawItem& item, const Frame& frame, double spacing);

}  // namespace easypbr::render

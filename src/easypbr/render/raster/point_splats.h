// How large the points of an item are in a frame.
#pragma once

#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/frame.h"

namespace easypbr::render {

/// How the points of a cloud are splatted.
struct PointSplats {
    Mat4 clip_from_mesh = Mat4::Identity();
    float pixels = 1;        ///< diameter, where world_pixels is 0
    float world_pixels = 0;  ///< diameter in pixels times the clip coordinate w
    float least_pixels = 1;  ///< no splat with a world size gets smaller
    float y_per_x = 1;       ///< height of a splat in parts of its width
    bool round = true;
};

/// Automatic splats of this many spacings leave no hole between the points of a square grid (its diagonal
/// is 1.41).
inline constexpr double spacings_per_splat = 1.5;

/// Size and shape of an item's splats. `spacing` is the points' mean distance, in their own units.
PointSplats splats_of(const DrawItem& item, const Frame& frame, double spacing);

}  // namespace easypbr::render

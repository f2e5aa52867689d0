// How large the points of an item are in a frame.
#pragma once

#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/raster/visibility.h"
#include "easypbr/scene/spacing_cache.h"

namespace easypbr::render {

/// Size and shape of an item's splats.
PointSplats splats_of(const DrawItem& item, const Frame& frame, SpacingCache& spacings);

}  // namespace easypbr::render

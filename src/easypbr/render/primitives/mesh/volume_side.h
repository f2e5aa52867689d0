// Which side of a volume's faces is its outside.
#pragma once

#include "easypbr/gpu/facing.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/frame.h"

namespace easypbr::render {

/// Whether the backs of a volume's faces are drawn as its fronts: where its closed mesh is wound inward, and
/// where the camera sees nothing but backs of an open one that is two-sided. False of all other items.
bool is_turned(const Frame& frame, const DrawItem& item, gpu::Winding winding);

}  // namespace easypbr::render

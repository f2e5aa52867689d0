// Opacities of vertices that are drawn as discs or ellipses.
#pragma once

#include <cstddef>
#include <functional>

#include "easypbr/render/drawables/draw_list.h"

namespace easypbr::render {

/// Of the material, and where the item is not opaque of the vertex's colour too.
float vertex_alpha(const DrawItem& item, size_t vertex);

/// Which vertices an item's alpha leaves; empty: all of them. The item must live as long.
std::function<bool(size_t vertex)> drawn_vertices(const DrawItem& item);

}  // namespace easypbr::render

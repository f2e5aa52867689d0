// Opacities of vertices that are drawn as discs or ellipses.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>

#include "easypbr/render/drawables/draw_list.h"

namespace easypbr::render {

/// Of the material, and where the item is not opaque of the vertex's colour too.
inline float vertex_alpha(const DrawItem& item, size_t vertex) {
    const ArrayXf& C = item.mesh().C;
    const bool has_own = item.alpha != AlphaMode::opaque && item.with_colors && C.cols() > 3;
    return item.material.opacity * (has_own ? C(Eigen::Index(vertex), 3) : 1.0f);
}

/// Which vertices an item's alpha leaves; empty: all of them. The item must live as long.
inline std::function<bool(size_t vertex)> drawn_vertices(const DrawItem& item) {
    if (item.alpha == AlphaMode::opaque) return {};
    const float cutoff =
        item.alpha == AlphaMode::mask ? item.material.alpha_cutoff : std::numeric_limits<float>::denorm_min();
    return [&item, cutoff](size_t vertex) { return vertex_alpha(item, vertex) >= cutoff; };
}

}  // namespace easypbr::render

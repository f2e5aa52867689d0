// Which vertices are at the same place.
#pragma once

#include <cstdint>
#include <vector>

#include "easypbr/scene/array.h"

namespace easypbr::geometry {

struct Weld {
    std::vector<int32_t> place;  ///< for each vertex the number of its position, from 0
    std::vector<int32_t> first;  ///< for each position the first vertex that is there, rising

    size_t count() const { return first.size(); }
};

/// Vertices with equal coordinates (-0 is 0) are one position.
Weld weld_positions(const Array3f& V);

}  // namespace easypbr::geometry

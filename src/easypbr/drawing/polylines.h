// Strokes: stretches of edges joined to polylines in the picture.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "easypbr/core/math.h"

namespace easypbr::drawing {

using Polyline = std::vector<Vec2d>;

/// A piece of a line with what its ends are joined by: equal numbers are the same place, -1 is joined to
/// nothing.
struct Piece {
    Polyline points;  ///< at least two
    std::array<int32_t, 2> places{-1, -1};
};

/// Pieces joined where just two meet, without the points that are not needed to stay within `tolerance` of
/// the line (Douglas and Peucker 1973).
std::vector<Polyline> joined(const std::vector<Piece>& pieces, double tolerance);

}  // namespace easypbr::drawing

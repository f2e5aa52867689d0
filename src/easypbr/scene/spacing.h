// How far apart the points of a cloud are, and where most of them lie.
#pragma once

#include "easypbr/core/math.h"
#include "easypbr/scene/array.h"

namespace easypbr {

/// The box of all points but outliers: each axis from its 1st to its 99th percentile, widened by three times
/// that range on both sides, cut to the points' own box. A cloud without far outliers keeps its own box.
/// Empty for no points. Percentiles are those of at most 65,536 points spread over the array.
Box3d trimmed_bounds(const Array3f& V);

/// Mean distance between neighbouring points, about, in the units of V: points are counted per occupied cell
/// of a grid, and how the number of cells grows with their fineness tells curves, surfaces and volumes apart.
/// Zero for fewer than two points or when all are equal. Does not depend on the order of the points.
double point_spacing(const Array3f& V);

/// How large the discs of a cloud's points are where nobody says, in the units of V.
struct AutomaticDiscs {
    double diameter = 0;  ///< 0 where all points are at one place
    double closing = 0;   ///< the diameter from which on neighbouring discs leave no hole between them
    double least = 0;     ///< part of the least diameter in pixels of discs that leave holes; 0 where none do
    Vec3d centre{0, 0, 0};  ///< of the cloud
};

/// The discs leave no hole, as far as they are readable: the diameter is at most 1.5 % of the diagonal of the
/// points' box, and half as much in volumes of many points, whose discs would hide each other.
AutomaticDiscs automatic_discs(const Array3f& V);

}  // namespace easypbr

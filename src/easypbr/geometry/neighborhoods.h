// The distinct points of a cloud with the nearest others of each.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/scene/array.h"

namespace easypbr::geometry {

/// Points that differ, along a space-filling curve, so that neighbours are near each other in memory.
struct Neighborhoods {
    Array3f points;                  ///< distinct
    std::vector<int32_t> place;      ///< for each row that was given, the point that stands for it
    int k = 0;                       ///< neighbours of each point, at most the number of the others
    std::vector<int32_t> neighbors;  ///< k for each point, the nearest first, without the point itself
    std::vector<float> reach;        ///< distance to the last of them

    size_t count() const { return size_t(points.rows()); }
    Vec3d point(size_t i) const { return points.row(Eigen::Index(i)).transpose().cast<double>(); }
    std::span<const int32_t> of(size_t i) const { return {neighbors.data() + i * size_t(k), size_t(k)}; }
};

/// Throws ArgumentError unless 3 <= k <= 256 and there are three different points.
Neighborhoods find_neighborhoods(const char* what, const Array3f& V, int k);

}  // namespace easypbr::geometry

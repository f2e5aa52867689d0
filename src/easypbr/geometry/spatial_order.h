// Points in an order in which neighbours in space are near each other in memory.
#pragma once

#include <cstdint>
#include <vector>

#include "easypbr/core/parallel.h"
#include "easypbr/scene/array.h"

namespace easypbr {

/// Indices of the rows along a Morton curve.
std::vector<int32_t> spatial_order(const Array3f& points);

/// array.row(rows[i]) as row i; the empty array stays empty.
template <class Scalar, int Cols>
Array<Scalar, Cols> rows_of(const Array<Scalar, Cols>& array, const std::vector<int32_t>& rows) {
    if (array.empty()) return {};
    typename Array<Scalar, Cols>::Dense result(Eigen::Index(rows.size()), array.cols());
    parallel_for(rows.size(), size_t(1) << 14,
                 [&](size_t i) { result.row(Eigen::Index(i)) = array.row(rows[i]); });
    return result;
}

}  // namespace easypbr

// Coordinates far from zero (UTM, other national grids): kept as a double offset and small float32 positions.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/scene/array.h"

namespace easypbr {

/// Numbers of float32 are 2^-13 = 0.12 mm apart from here on, the unit being the metre.
inline constexpr double near_zero = 1024;

/// What to subtract from positions, in double precision, before they become float32. Zero unless float32
/// would lose what matters: where the spacing of its numbers at the farthest coordinate is more than 0.1 mm
/// (farther than 1024 from zero, the unit being the metre) and more than half a millionth of the extent
/// (farther than 4 times the extent). Extent and centre are those of the box that holds the middle 90 % of
/// the samples on each axis, so that a stray point decides nothing; the offset is the centre rounded to a
/// decimal place that fits the extent. Samples beyond the range of float32 are ignored. `near`: how far from
/// zero positions may be without an offset, whatever their extent.
Vec3d offset_of_samples(std::vector<Vec3d> samples, double near = near_zero);

/// Number of positions that are looked at for a decision.
inline constexpr size_t offset_sample_count = 1024;

/// The row of sample `i` of `count` that are spread evenly over rows, the first and the last among them.
constexpr size_t spread_row(size_t i, size_t count, size_t rows) {
    return count > 1 ? i * (rows - 1) / (count - 1) : 0;
}

/// offset_of_samples() of positions spread over the rows; at(i) gives row i as Vec3d.
template <class At>
Vec3d choose_offset(size_t rows, At&& at, double near = near_zero) {
    std::vector<Vec3d> samples(std::min(rows, offset_sample_count));
    for (size_t i = 0; i < samples.size(); ++i) samples[i] = at(spread_row(i, samples.size(), rows));
    return offset_of_samples(std::move(samples), near);
}

/// Positions in double precision as local ones: given = offset + V.
struct LocalPositions {
    Array3f V;
    Vec3d offset = Vec3d::Zero();
};
LocalPositions local_positions(
    const Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>& positions);

}  // namespace easypbr

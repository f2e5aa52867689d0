#include "easypbr/scene/spacing.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "easypbr/core/parallel.h"

namespace easypbr {
namespace {

constexpr Eigen::Index sample_count = 1 << 16;
constexpr size_t spacing_grain = 1 << 16;
/// A percentile range is widened by this much on both sides before a point counts as an outlier.
constexpr double widening = 3;
/// Cells per side of the finest grid.
constexpr int finest = 512;
/// So many points in a cell on average make its count mean something.
constexpr double enough_per_cell = 4;
/// Discs of this many spacings leave no hole between the points of a square grid (its diagonal is 1.41).
constexpr double spacings_per_disc = 1.5;
/// Largest diameter of automatic discs, as a part of the diagonal of the cloud's box.
constexpr double largest_disc = 0.015;
/// Discs in a volume become smaller from this many points on, down to half.
constexpr double many_in_a_volume = 1000;

Box3d exact_bounds(const Array3f& V) {
    Box3d box;
    if (V.empty()) return box;
    // Extremes are the same whatever the points' order.
    return Box3d(Vec3d(V.colwise().minCoeff().cast<double>()), Vec3d(V.colwise().maxCoeff().cast<double>()));
}

/// Occupied cells of a grid of `cells` cells along the longest side of the box.
size_t count_occupied(const Array3f& V, const Box3d& box, int cells) {
    const double size = box.sizes().maxCoeff() / cells;
    const Vec3 low = box.min().cast<float>();
    const float scale = float(1 / size);
    const float farthest = float(cells) * (1 + 1e-5f);  // the box's own end, rounded
    std::vector<std::atomic<uint32_t>> bits((size_t(cells) * size_t(cells) * size_t(cells) + 31) / 32);
    std::atomic<size_t> total{0};
    parallel_chunks(size_t(V.rows()), spacing_grain, [&](size_t begin, size_t end) {
        size_t count = 0;
        for (size_t i = begin; i < end; ++i) {
            const float* p = V.data() + 3 * i;
            size_t index = 0;
            bool inside = true;
            for (int axis = 0; axis < 3; ++axis) {
                const float at = (p[axis] - low[axis]) * scale;
                inside &= at >= 0 && at <= farthest;
                index = index * size_t(cells) + size_t(std::clamp(int(at), 0, cells - 1));
            }
            const uint32_t bit = 1u << (index & 31);
            std::atomic<uint32_t>& word = bits[index >> 5];
            if (inside && !(word.load(std::memory_order_relaxed) & bit))
                count += (word.fetch_or(bit, std::memory_order_relaxed) & bit) == 0;
        }
        total += count;
    });
    return total;
}

/// All but a part of the points at either end of each axis lie within; of at most `sample_count` points.
Box3d percentile_box(const Array3f& V, size_t parts) {
    const Eigen::Index step = std::max<Eigen::Index>(1, V.rows() / sample_count);
    std::vector<float> values;
    Box3d box(Vec3d::Zero().eval());
    for (int axis = 0; axis < 3; ++axis) {
        values.clear();
        for (Eigen::Index i = 0; i < V.rows(); i += step) values.push_back(V(i, axis));
        const size_t low = values.size() / parts, high = values.size() - 1 - low;
        std::nth_element(values.begin(), values.begin() + long(low), values.end());
        box.min()[axis] = double(values[low]);
        std::nth_element(values.begin(), values.begin() + long(high), values.end());
        box.max()[axis] = double(values[high]);
    }
    return box;
}

/// Cells of a grid that hold enough points each, and what they tell.
struct Occupancy {
    int cells = finest;    ///< along the longest side of the box
    double per_cell = 1;   ///< points in an occupied cell, on average
    double dimension = 1;  ///< of what the points lie on: 1 to 3
};

Occupancy occupancy_of(const Array3f& V, const Box3d& box) {
    const double points = double(V.rows());
    Occupancy result;
    int& cells = result.cells;
    size_t occupied = count_occupied(V, box, cells);
    while (cells > 2 && points / double(occupied) < enough_per_cell)
        occupied = count_occupied(V, box, cells /= 2);
    const size_t coarser = count_occupied(V, box, cells / 2);
    result.per_cell = points / double(occupied);
    result.dimension = std::clamp(std::log2(double(occupied) / double(coarser)), 1.0, 3.0);
    return result;
}

/// Of the middle of the cloud: sparse parts around it do not count.
double dimension_of_core(const Array3f& V) {
    constexpr size_t outer_parts = 10;
    const Box3d core = percentile_box(V, outer_parts);
    if (!(core.sizes().maxCoeff() > 0)) return 1;
    const Eigen::Index step = std::max<Eigen::Index>(1, V.rows() / sample_count);
    std::vector<Eigen::Index> rows;
    for (Eigen::Index i = 0; i < V.rows(); i += step)
        if (core.contains(Vec3d(V.row(i).transpose().cast<double>()))) rows.push_back(i);
    if (rows.empty()) return 1;
    return occupancy_of(Array3f(Array3f::Dense(V(rows, Eigen::all))), core).dimension;
}

/// The part of the diameter that is left to discs in a volume, where each hides what is behind it.
double part_in_volume(const Array3f& V) {
    constexpr double least = 0.5;
    const double many = std::sqrt(many_in_a_volume / double(V.rows()));
    if (many >= 1) return 1;
    return std::pow(std::max(many, least), std::clamp(dimension_of_core(V) - 2, 0.0, 1.0));
}

}  // namespace

Box3d trimmed_bounds(const Array3f& V) {
    if (V.empty()) return {};
    const Box3d box = exact_bounds(V), bulk = percentile_box(V, 100);
    Box3d kept = box;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = bulk.min()[axis], b = bulk.max()[axis];
        kept.min()[axis] = std::max(box.min()[axis], a - widening * (b - a));
        kept.max()[axis] = std::min(box.max()[axis], b + widening * (b - a));
    }
    // A flat axis has no range to judge by.
    for (int axis = 0; axis < 3; ++axis)
        if (!(kept.max()[axis] > kept.min()[axis])) {
            kept.min()[axis] = box.min()[axis];
            kept.max()[axis] = box.max()[axis];
        }
    return kept;
}

double point_spacing(const Array3f& V) {
    if (V.rows() < 2) return 0;
    const Box3d box = trimmed_bounds(V);
    const double side = box.sizes().maxCoeff();
    if (!(side > 0)) return 0;
    const Occupancy occupancy = occupancy_of(V, box);
    return side / occupancy.cells / std::pow(occupancy.per_cell, 1 / occupancy.dimension);
}

AutomaticDiscs automatic_discs(const Array3f& V) {
    if (V.empty()) return {};
    const Box3d box = trimmed_bounds(V);
    const double closing = point_spacing(V) * spacings_per_disc, most = largest_disc * box.diagonal().norm();
    if (!(closing > most / 2)) return {closing, closing, 0, box.center()};
    const double part = part_in_volume(V);
    if (!(closing > most * part)) return {closing, closing, 0, box.center()};
    return {most * part, closing, part, box.center()};
}

}  // namespace easypbr

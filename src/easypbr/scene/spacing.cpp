#include "easypbr/scene/spacing.h"

#include <algorithm>
#include <atomic>
#include <bit>
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
    std::vector<std::atomic<uint32_t>> bits((size_t(cells) * size_t(cells) * size_t(cells) + 31) / 32);
    parallel_chunks(size_t(V.rows()), spacing_grain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const float* p = V.data() + 3 * i;
            size_t index = 0;
            bool inside = true;
            for (int axis = 0; axis < 3; ++axis) {
                const float at = (p[axis] - low[axis]) * scale;
                inside &= at >= 0 && at <= float(cells);
                index = index * size_t(cells) + size_t(std::clamp(int(at), 0, cells - 1));
            }
            const uint32_t bit = 1u << (index & 31);
            std::atomic<uint32_t>& word = bits[index >> 5];
            if (inside && !(word.load(std::memory_order_relaxed) & bit))
                word.fetch_or(bit, std::memory_order_relaxed);
        }
    });
    std::atomic<size_t> total{0};
    parallel_chunks(bits.size(), spacing_grain, [&](size_t begin, size_t end) {
        size_t count = 0;
        for (size_t i = begin; i < end; ++i) count += size_t(std::popcount(bits[i].load()));
        total += count;
    });
    return total;
}

}  // namespace

Box3d trimmed_bounds(const Array3f& V) {
    if (V.empty()) return {};
    const Eigen::Index step = std::max<Eigen::Index>(1, V.rows() / sample_count);
    std::vector<float> values;
    Box3d box = exact_bounds(V);
    Box3d kept = box;
    for (int axis = 0; axis < 3; ++axis) {
        values.clear();
        for (Eigen::Index i = 0; i < V.rows(); i += step) values.push_back(V(i, axis));
        const size_t low = values.size() / 100, high = values.size() - 1 - low;
        std::nth_element(values.begin(), values.begin() + long(low), values.end());
        const double a = double(values[low]);
        std::nth_element(values.begin(), values.begin() + long(high), values.end());
        const double b = double(values[high]);
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
    const double points = double(V.rows());
    int cells = finest;
    size_t occupied = count_occupied(V, box, cells);
    while (cells > 2 && points / double(occupied) < enough_per_cell)
        occupied = count_occupied(V, box, cells /= 2);
    const size_t coarser = count_occupied(V, box, cells / 2);
    const double dimension = std::clamp(std::log2(double(occupied) / double(coarser)), 1.0, 3.0);
    return side / cells / std::pow(points / double(occupied), 1 / dimension);
}

}  // namespace easypbr

#include "easypbr/geometry/neighborhoods.h"

#include <algorithm>
#include <limits>

#include "easypbr/core/parallel.h"
#include "easypbr/geometry/nearest.h"
#include "easypbr/geometry/require.h"
#include "easypbr/geometry/spatial_order.h"
#include "easypbr/geometry/weld.h"
#include "easypbr/scene/mesh_arrays.h"

namespace easypbr::geometry {
namespace {

/// Queries answered at once, so that what they give besides the neighbours does not add up.
constexpr Eigen::Index batch = 1 << 18;

/// Fills in the distinct points and the place of every row.
void take_distinct(Neighborhoods& result, const Array3f& V) {
    const Weld weld = weld_positions(V);
    const Array3f distinct = rows_of(V, weld.first);
    const std::vector<int32_t> order = spatial_order(distinct);
    result.points = rows_of(distinct, order);
    std::vector<int32_t> place_of(order.size());
    for (size_t i = 0; i < order.size(); ++i) place_of[size_t(order[i])] = int32_t(i);
    result.place.resize(weld.place.size());
    for (size_t i = 0; i < weld.place.size(); ++i) result.place[i] = place_of[size_t(weld.place[i])];
}

}  // namespace

Neighborhoods find_neighborhoods(const char* what, const Array3f& V, int k) {
    require_in(fmt::format("{}: k", what).c_str(), k, neighbor_counts);
    Neighborhoods result;
    take_distinct(result, V);
    const size_t count = result.count();
    if (count < 3)
        throw ArgumentError(
            fmt::format("{}: expected at least 3 different points, got {} in {}", what, count, V.rows()));
    result.k = int(std::min(size_t(k), count - 1));
    if (count * size_t(result.k) > std::numeric_limits<uint32_t>::max())
        throw ArgumentError(
            fmt::format("{}: expected at most {} neighbours in all, got {} points with k = {}", what,
                        std::numeric_limits<uint32_t>::max(), count, result.k));
    result.neighbors.resize(count * size_t(result.k));
    result.reach.resize(count);
    const KdTree tree(result.points);
    for (Eigen::Index first = 0; first < result.points.rows(); first += batch) {
        const Eigen::Index rows = std::min(batch, result.points.rows() - first);
        const Array3f queries(result.points.owner(), result.points.data() + 3 * first, rows, 3);
        const KdTree::Nearest nearest = tree.nearest(queries, result.k + 1);
        parallel_for(size_t(rows), 4096, [&](size_t i) {
            const auto row = Eigen::Index(i);
            const auto point = size_t(first) + i;
            int32_t* target = result.neighbors.data() + point * size_t(result.k);
            for (int j = 1; j <= result.k; ++j) *target++ = nearest.indices(row, j);
            result.reach[point] = nearest.distances(row, result.k);
        });
    }
    return result;
}

}  // namespace easypbr::geometry

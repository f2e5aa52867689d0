#include "easypbr/geometry/nearest.h"

#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>
#include <numeric>
#include <utility>

#include "easypbr/core/parallel.h"
#include "easypbr/geometry/require.h"
#include "easypbr/geometry/spatial_order.h"
#include "easypbr/scene/mesh_arrays.h"

namespace easypbr {
namespace {

constexpr size_t query_grain = 512;

/// What nanoflann wants to know of a set of points.
struct Points {
    Array3f rows;

    size_t kdtree_get_point_count() const { return size_t(rows.rows()); }
    float kdtree_get_pt(size_t i, size_t axis) const { return rows(Eigen::Index(i), Eigen::Index(axis)); }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points, float, uint32_t>,
                                                 Points, 3, uint32_t>;

/// Collects (squared distance, index) up to and including a squared radius.
class Collector {
  public:
    using DistanceType = float;

    Collector(float squared_radius, const std::vector<int32_t>& original,
              std::vector<std::pair<float, int32_t>>& found)
        : limit_(std::nextafter(squared_radius, std::numeric_limits<float>::infinity())),
          original_(original),
          found_(found) {}

    size_t size() const { return found_.size(); }
    bool full() const { return true; }
    float worstDist() const { return limit_; }
    bool addPoint(float squared, uint32_t index) {
        if (squared < limit_) found_.emplace_back(squared, original_[index]);
        return true;
    }
    /// nanoflann 1.5 and later ask for it. Who queries sorts.
    void sort() {}

  private:
    float limit_;
    const std::vector<int32_t>& original_;
    std::vector<std::pair<float, int32_t>>& found_;
};

/// Equally far points in the order of their indices.
void order_ties(int32_t* indices, const float* distances, int k) {
    for (int begin = 0, end; begin < k; begin = end) {
        end = begin + 1;
        while (end < k && distances[end] == distances[begin]) ++end;
        std::sort(indices + begin, indices + end);
    }
}

}  // namespace

/// The points lie in memory along a space-filling curve, so that a query's leaves are near each other.
struct KdTree::Index {
    std::vector<int32_t> original;  ///< index that the caller knows a point by
    Points points;
    Tree tree;

    explicit Index(const Array3f& given)
        : original(spatial_order(given)), points{rows_of(given, original)}, tree(3, points) {}
};

KdTree::KdTree(const Array3f& points) {
    if (points.empty()) throw ArgumentError("k-d tree: expected at least one point, got none");
    geometry::require_finite("k-d tree", points);
    index_ = std::make_shared<const Index>(points);
}

Eigen::Index KdTree::size() const {
    return index_->points.rows.rows();
}

KdTree::Nearest KdTree::nearest(const Array3f& queries, int k) const {
    geometry::require_between("nearest neighbours: k", k, 1, size());
    geometry::require_finite("nearest neighbours", queries);
    Rows<int32_t>::Dense all_indices(queries.rows(), k);
    Rows<float>::Dense all_distances(queries.rows(), k);
    parallel_chunks(size_t(queries.rows()), query_grain, [&](size_t begin, size_t end) {
        std::vector<uint32_t> indices(static_cast<size_t>(k));
        for (size_t i = begin; i < end; ++i) {
            const auto row = Eigen::Index(i);
            float* distances = all_distances.row(row).data();
            nanoflann::KNNResultSet<float, uint32_t> found(static_cast<size_t>(k));
            found.init(indices.data(), distances);
            index_->tree.findNeighbors(found, queries.row(row).data(), {});
            for (int j = 0; j < k; ++j) {
                all_indices(row, j) = index_->original[indices[size_t(j)]];
                distances[j] = std::sqrt(distances[j]);
            }
            order_ties(all_indices.row(row).data(), distances, k);
        }
    });
    return {std::move(all_indices), std::move(all_distances)};
}

KdTree::Within KdTree::within(const Array3f& queries, float radius) const {
    if (!(radius >= 0) || !std::isfinite(radius))
        throw ArgumentError(
            fmt::format("neighbours within a radius: expected a finite number >= 0, got {}", radius));
    geometry::require_finite("neighbours within a radius", queries);
    using Found = std::vector<std::pair<float, int32_t>>;
    const auto count = size_t(queries.rows());
    std::vector<Found> found(count);
    parallel_for(count, query_grain, [&](size_t i) {
        Collector collector(radius * radius, index_->original, found[i]);
        index_->tree.findNeighbors(collector, queries.row(Eigen::Index(i)).data(), {});
        std::sort(found[i].begin(), found[i].end());
    });
    Within result;
    result.offsets.assign(count + 1, 0);
    for (size_t i = 0; i < count; ++i) result.offsets[i + 1] = result.offsets[i] + int64_t(found[i].size());
    result.indices.resize(size_t(result.offsets.back()));
    result.distances.resize(result.indices.size());
    parallel_for(count, query_grain, [&](size_t i) {
        auto place = size_t(result.offsets[i]);
        for (const auto& [squared, index] : found[i]) {
            result.indices[place] = index;
            result.distances[place++] = std::sqrt(squared);
        }
    });
    return result;
}

}  // namespace easypbr

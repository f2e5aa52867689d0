// Nearest neighbours among points.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "easypbr/scene/array.h"

namespace easypbr {

/// k-d tree over the rows of an n x 3 array. Immutable and shared by handle; queries from any thread, many at
/// once in parallel. Distances are Euclidean, in single precision.
class KdTree {
  public:
    template <class Scalar>
    using Rows = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

    /// The k nearest points of each query, the nearest first, equally far ones by index.
    struct Nearest {
        Rows<int32_t> indices;  ///< queries x k
        Rows<float> distances;  ///< queries x k
    };

    /// All points around each query. Those of query i stand from offsets[i] to offsets[i + 1], in the same
    /// order.
    struct Within {
        std::vector<int64_t> offsets;
        std::vector<int32_t> indices;
        std::vector<float> distances;
    };

    /// Throws ArgumentError when there is no point or one that is not finite.
    explicit KdTree(const Array3f& points);

    Eigen::Index size() const;

    /// Throws ArgumentError unless 1 <= k <= size() and the queries are finite.
    Nearest nearest(const Array3f& queries, int k) const;

    /// Points at a distance of at most `radius`. Throws ArgumentError unless radius >= 0 and the queries are
    /// finite.
    Within within(const Array3f& queries, float radius) const;

  private:
    struct Index;
    std::shared_ptr<const Index> index_;
};

}  // namespace easypbr

// Nearest neighbours among points, nearest points on surfaces, and how far surfaces are from each other.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/scene/array.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr {

/// k-d tree over the rows of an n x 3 array. Immutable and shared by handle; queries from any thread, many at
/// once in parallel. Distances are Euclidean, in single precision: points far from zero for their extent
/// need an offset that is subtracted before (as that of MeshData::V), from queries too.
class KdTree {
  public:
    template <class Scalar>
    using Rows = Array<Scalar, Eigen::Dynamic>;

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

    // Moving copies: a handle always has its object.
    KdTree(const KdTree& other) = default;
    KdTree& operator=(const KdTree& other) = default;

    Eigen::Index size() const;

    /// Throws ArgumentError unless 1 <= k <= size() and the queries are finite.
    Nearest nearest(const Array3f& queries, int k) const;

    /// Points at a distance of at most `radius`. Throws ArgumentError unless radius >= 0, and it and the
    /// queries are finite.
    Within within(const Array3f& queries, float radius) const;

  private:
    struct Index;
    std::shared_ptr<const Index> index_;
};

/// Nearest points of a surface: exact distances from points to triangles, found through a tree of bounding
/// boxes. Of a mesh without faces the nearest vertices. Descendants do not count. Immutable, shared by
/// handle; queries from any thread, many at once in parallel. Computed in double precision, relative to the
/// mesh's offset.
class SurfaceTree {
  public:
    /// Throws ArgumentError when there are no vertices, and for faces out of range.
    explicit SurfaceTree(const MeshData& mesh);

    // Moving copies: a handle always has its object.
    SurfaceTree(const SurfaceTree& other) = default;
    SurfaceTree& operator=(const SurfaceTree& other) = default;

    struct Nearest {
        std::vector<double> distance;
        std::vector<int32_t>
            face;                  ///< of several nearest ones the first; the vertex, when there are no faces
        std::vector<Vec3d> point;  ///< on the surface
    };

    /// Throws ArgumentError when a query is not finite.
    Nearest nearest(const Array3f& queries) const;

  private:
    struct Tree;
    std::shared_ptr<const Tree> tree_;
};

/// Point of the triangle a b c nearest to p (Ericson 2005, Real-Time Collision Detection, 5.1.5); any order
/// of corners and triangles without area are fine.
Vec3d nearest_on_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c);

/// Distances from one surface to another.
struct SurfaceDistance {
    double max = 0, mean = 0, root_mean_square = 0;
};

/// One-sided: how far the first mesh is from the second. The maximum is over its vertices and `samples`
/// points on its faces, uniform by area; mean and root mean square are over the samples, or over the vertices
/// of a mesh without faces or when samples are 0. Meshes count with their descendants in the frame that they
/// are placed in. The same seed gives the same numbers. Throws ArgumentError when either has no vertices or
/// samples < 0.
SurfaceDistance surface_distance(const Mesh& from, const Mesh& to, int64_t samples = 100000,
                                 uint64_t seed = 0);

/// The larger of the two one-sided maxima: an estimate from below of the Hausdorff distance of the surfaces,
/// exact for clouds.
double hausdorff_distance(const Mesh& a, const Mesh& b, int64_t samples = 100000, uint64_t seed = 0);

}  // namespace easypbr

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"
#include "easypbr/core/triangle.h"
#include "easypbr/geometry/gather.h"
#include "easypbr/geometry/nearest.h"
#include "easypbr/geometry/spatial_order.h"

namespace easypbr {
namespace {

constexpr size_t leaf_size = 4;

using TreeTriangle = std::array<Vec3d, 3>;

/// Box of triangles, or of two boxes.
struct Box {
    Eigen::Array3d low = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Array3d high = Eigen::Array3d::Constant(-std::numeric_limits<double>::infinity());

    void add(const Vec3d& point) {
        low = low.min(point.array());
        high = high.max(point.array());
    }
    void add(const Box& other) {
        low = low.min(other.low);
        high = high.max(other.high);
    }
    double squared_distance(const Vec3d& point) const {
        return (low - point.array()).max(point.array() - high).max(0.0).matrix().squaredNorm();
    }
};

}  // namespace

/// Triangles along a space-filling curve, in groups of leaf_size, under a complete binary tree: node i has
/// the children 2 i and 2 i + 1, the leaves are the last nodes (Karras 2012 keeps the curve's own hierarchy;
/// halving it evenly needs no pointers).
struct SurfaceTree::Tree {
    std::vector<TreeTriangle> triangles;
    std::vector<int32_t> original;
    std::vector<Box> nodes;
    size_t first_leaf = 1;

    explicit Tree(const MeshData& mesh) {
        take_triangles(mesh);
        const size_t leaves = (triangles.size() + leaf_size - 1) / leaf_size;
        while (first_leaf < leaves) first_leaf *= 2;
        nodes.resize(2 * first_leaf);
        for (size_t i = 0; i < triangles.size(); ++i)
            for (const Vec3d& corner : triangles[i]) nodes[first_leaf + i / leaf_size].add(corner);
        for (size_t i = first_leaf - 1; i > 0; --i) {
            nodes[i].add(nodes[2 * i]);
            nodes[i].add(nodes[2 * i + 1]);
        }
    }

    void take_triangles(const MeshData& mesh) {
        const auto vertex = [&](Eigen::Index v) -> Vec3d { return mesh.V.row(v).transpose().cast<double>(); };
        const bool has_faces = !mesh.F.empty();
        const Eigen::Index count = has_faces ? mesh.F.rows() : mesh.V.rows();
        const auto corner = [&](Eigen::Index i, int k) { return vertex(has_faces ? mesh.F(i, k) : i); };
        Array3f::Dense centers(count, 3);
        for (Eigen::Index i = 0; i < count; ++i)
            centers.row(i) = ((corner(i, 0) + corner(i, 1) + corner(i, 2)) / 3).cast<float>().transpose();
        original = spatial_order(Array3f(std::move(centers)));
        triangles.resize(original.size());
        for (size_t i = 0; i < original.size(); ++i)
            triangles[i] = {corner(original[i], 0), corner(original[i], 1), corner(original[i], 2)};
    }

    struct Found {
        double squared = std::numeric_limits<double>::infinity();
        int32_t face = -1;
        Vec3d point = Vec3d::Zero();
    };

    void search_leaf(const Vec3d& query, size_t leaf, Found& found) const {
        const size_t begin = leaf * leaf_size, end = std::min(begin + leaf_size, triangles.size());
        for (size_t i = begin; i < end; ++i) {
            const auto& [a, b, c] = triangles[i];
            const Vec3d point = nearest_on_triangle(query, a, b, c);
            const double squared = (point - query).squaredNorm();
            if (squared < found.squared || (squared == found.squared && original[i] < found.face))
                found = {squared, original[i], point};
        }
    }

    Found nearest(const Vec3d& query) const {
        struct Pending {
            size_t node;
            double squared;
        };
        // One sibling waits on each level, and there are at most 32.
        std::array<Pending, 64> pending;
        size_t count = 0;
        pending[count++] = {1, 0};
        Found found;
        while (count > 0) {
            const Pending next = pending[--count];
            if (next.squared > found.squared) continue;
            if (next.node >= first_leaf) {
                search_leaf(query, next.node - first_leaf, found);
                continue;
            }
            Pending near{2 * next.node, nodes[2 * next.node].squared_distance(query)};
            Pending far{2 * next.node + 1, nodes[2 * next.node + 1].squared_distance(query)};
            if (far.squared < near.squared) std::swap(near, far);
            if (far.squared <= found.squared) pending[count++] = far;
            if (near.squared <= found.squared) pending[count++] = near;
        }
        return found;
    }
};

Vec3d nearest_on_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    return detail::nearest_on_triangle(p, a, b, c);
}

SurfaceTree::SurfaceTree(const MeshData& mesh) {
    geometry::require_vertices("surface distance", mesh);
    tree_ = std::make_shared<const Tree>(mesh);
}

SurfaceTree::Nearest SurfaceTree::nearest(const Array3f& queries) const {
    const auto count = size_t(queries.rows());
    for (Eigen::Index i = 0; i < queries.rows(); ++i)
        if (!queries.row(i).allFinite())
            throw ArgumentError(fmt::format(
                "surface distance: expected finite points, got others in row {} of {}", i, queries.rows()));
    Nearest result{std::vector<double>(count), std::vector<int32_t>(count), std::vector<Vec3d>(count)};
    parallel_for(count, 256, [&](size_t i) {
        const Tree::Found found = tree_->nearest(queries.row(Eigen::Index(i)).transpose().cast<double>());
        result.distance[i] = std::sqrt(found.squared);
        result.face[i] = found.face;
        result.point[i] = found.point;
    });
    return result;
}

}  // namespace easypbr

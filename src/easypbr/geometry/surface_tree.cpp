#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"
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

Vec3d nearest_on_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
    const double length = (b - a).squaredNorm();
    return length > 0 ? Vec3d(a + std::clamp((p - a).dot(b - a) / length, 0.0, 1.0) * (b - a)) : a;
}

Vec3d nearest_on_edges(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    Vec3d nearest = nearest_on_segment(p, a, b);
    for (const Vec3d& other : {nearest_on_segment(p, b, c), nearest_on_segment(p, c, a)})
        if ((other - p).squaredNorm() < (nearest - p).squaredNorm()) nearest = other;
    return nearest;
}

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
    const Vec3d ab = b - a, ac = c - a, ap = p - a;
    // A triangle that is a line, or nearly, is its edges: its plane says nothing.
    if (ab.cross(ac).squaredNorm() <= 1e-24 * ab.squaredNorm() * ac.squaredNorm())
        return nearest_on_edges(p, a, b, c);
    const double d1 = ab.dot(ap), d2 = ac.dot(ap);
    if (d1 <= 0 && d2 <= 0) return a;
    const Vec3d bp = p - b;
    const double d3 = ab.dot(bp), d4 = ac.dot(bp);
    if (d3 >= 0 && d4 <= d3) return b;
    const Vec3d cp = p - c;
    const double d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d6 >= 0 && d5 <= d6) return c;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    return a + (vb * ab + vc * ac) / (va + vb + vc);
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

// Triangles of a mesh in a tree of bounding boxes, for nearest points and for rays.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/core/parallel.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::geometry {

/// Box of triangles, or of two boxes. Float32, as positions are: it is exact.
struct TreeBox {
    Eigen::Array<float, 3, 2> corners;  ///< the lowest and the highest

    TreeBox() {
        corners.col(0).setConstant(std::numeric_limits<float>::infinity());
        corners.col(1).setConstant(-std::numeric_limits<float>::infinity());
    }
    Eigen::Array3d low() const { return corners.col(0).cast<double>(); }
    Eigen::Array3d high() const { return corners.col(1).cast<double>(); }

    void add(const Vec3& point) {
        corners.col(0) = corners.col(0).min(point.array());
        corners.col(1) = corners.col(1).max(point.array());
    }
    void add(const TreeBox& other) {
        corners.col(0) = corners.col(0).min(other.corners.col(0));
        corners.col(1) = corners.col(1).max(other.corners.col(1));
    }
    double squared_distance(const Vec3d& point) const {
        return (low() - point.array()).max(point.array() - high()).max(0.0).matrix().squaredNorm();
    }
};

/// Triangles under a complete binary tree: node i has the children 2 i and 2 i + 1, the leaves are the last
/// nodes and hold leaf_size triangles at most. Each node's triangles are halved by the median of their
/// centres along the longest axis. Of a mesh without faces each vertex is a triangle.
struct TriangleTree {
    using Triangle = std::array<Vec3d, 3>;
    using Corners = std::array<Vec3, 3>;
    static constexpr size_t leaf_size = 4;

    std::vector<Corners> triangles;
    std::vector<int32_t> original;  ///< the face of each triangle, or its vertex
    std::vector<TreeBox> nodes;
    size_t first_leaf = 1;

    explicit TriangleTree(const MeshData& mesh) {
        const bool has_faces = !mesh.F.empty();
        const auto count = size_t(has_faces ? mesh.F.rows() : mesh.V.rows());
        while (first_leaf * leaf_size < count) first_leaf *= 2;
        const auto corner = [&](size_t i, int k) -> Vec3 {
            return mesh.V.row(has_faces ? mesh.F(Eigen::Index(i), k) : int32_t(i)).transpose();
        };
        original.resize(count);
        std::vector<Centre> centres(count);
        parallel_for(count, grain, [&](size_t i) {
            centres[i] = {(corner(i, 0) / 3 + corner(i, 1) / 3 + corner(i, 2) / 3), int32_t(i)};
        });
        for (size_t level = 1; level < first_leaf; level *= 2)
            parallel_for(level, level / 64 + 1, [&](size_t i) { halve(centres, level + i); });
        triangles.resize(count);
        parallel_for(count, grain, [&](size_t i) {
            original[i] = centres[i].index;
            for (int k = 0; k < 3; ++k) triangles[i][size_t(k)] = corner(size_t(original[i]), k);
        });
        bound();
    }

    Triangle triangle(size_t i) const {
        const auto& [a, b, c] = triangles[i];
        return {a.cast<double>(), b.cast<double>(), c.cast<double>()};
    }

    /// Of everything. With a single leaf it is that leaf.
    const TreeBox& bounds() const { return nodes[1]; }

    /// Calls meet(i) for the triangles in boxes within a limit, which it may lower, the nearest box first.
    /// near(box) is how near a box is, infinity where nothing in it counts.
    template <class Near, class Meet>
    void visit(const Near& near, const double& limit, const Meet& meet) const {
        struct Pending {
            size_t node;
            double key;
        };
        // One sibling waits on each level, and there are at most 32.
        std::array<Pending, 64> pending;
        size_t count = 0;
        const auto push = [&](const Pending& next) {
            if (next.key <= limit && next.key < std::numeric_limits<double>::infinity())
                pending[count++] = next;
        };
        push({1, near(nodes[1])});
        while (count > 0) {
            const Pending next = pending[--count];
            if (next.key > limit) continue;
            if (next.node >= first_leaf) {
                const auto [begin, end] = range_of(next.node);
                for (size_t i = begin; i < end; ++i) meet(i);
                continue;
            }
            const size_t a = 2 * next.node, b = a + 1;
            const Pending first{a, near(nodes[a])}, second{b, near(nodes[b])};
            const bool in_order = first.key <= second.key;
            push(in_order ? second : first);
            push(in_order ? first : second);
        }
    }

  private:
    struct Centre {
        Vec3 at;
        int32_t index;
    };
    static constexpr size_t grain = 1 << 14;

    /// The first of a node's triangles, and the first after them.
    std::pair<size_t, size_t> range_of(size_t node) const {
        const size_t level = std::bit_floor(node), place = node - level;
        const auto before = [&](size_t i) { return triangles_before(i * (first_leaf / level)); };
        return {before(place), before(place + 1)};
    }
    /// Those of the leaves before the one that counts as `leaf` from 0 on: all hold equally many, or one
    /// more.
    size_t triangles_before(size_t leaf) const {
        return size_t(uint64_t(original.size()) * leaf >> std::countr_zero(first_leaf));
    }

    void halve(std::vector<Centre>& centres, size_t node) const {
        const auto [begin, end] = range_of(node);
        const size_t middle = range_of(2 * node).second;
        Eigen::AlignedBox3f box;
        for (size_t i = begin; i < end; ++i) box.extend(centres[i].at);
        if (begin == end) return;
        Eigen::Index axis;
        box.sizes().maxCoeff(&axis);
        const auto first = centres.begin();
        // Of equal ones too it is known which half they are in: the tree is the same on every machine.
        std::nth_element(first + std::ptrdiff_t(begin), first + std::ptrdiff_t(middle),
                         first + std::ptrdiff_t(end), [axis](const Centre& a, const Centre& b) {
                             return a.at[axis] != b.at[axis] ? a.at[axis] < b.at[axis] : a.index < b.index;
                         });
    }

    void bound() {
        nodes.resize(2 * first_leaf);
        parallel_for(first_leaf, grain, [&](size_t leaf) {
            const auto [begin, end] = range_of(first_leaf + leaf);
            for (size_t i = begin; i < end; ++i)
                for (const Vec3& corner : triangles[i]) nodes[first_leaf + leaf].add(corner);
        });
        for (size_t i = first_leaf - 1; i > 0; --i) {
            nodes[i].add(nodes[2 * i]);
            nodes[i].add(nodes[2 * i + 1]);
        }
    }
};

}  // namespace easypbr::geometry

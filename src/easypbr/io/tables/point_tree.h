// Points of a plane, found by the triangles that they lie in.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace easypbr::io {

using PlanePoint = std::array<double, 2>;

/// Twice the signed area of a triangle. Rounding keeps the order of the areas that a point gives which moves
/// along an axis.
inline double doubled_area(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

struct PlaneBox {
    static constexpr double far = std::numeric_limits<double>::infinity();
    PlanePoint low{far, far}, high{-far, -far};

    void add(const PlanePoint& p) {
        for (size_t axis = 0; axis < 2; ++axis) {
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    }
    bool overlaps(const PlaneBox& other) const {
        return low[0] <= other.high[0] && other.low[0] <= high[0] && low[1] <= other.high[1] &&
               other.low[1] <= high[1];
    }
};

/// A triangle of positive area.
struct PlaneTriangle {
    PlaneTriangle(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) : corners{a, b, c} {
        for (const PlanePoint& corner : corners) box.add(corner);
    }

    /// Above 0 within, 0 on the border.
    double depth(const PlanePoint& p) const {
        const auto& [a, b, c] = corners;
        return std::min({doubled_area(a, b, p), doubled_area(b, c, p), doubled_area(c, a, p)});
    }
    bool is_corner(const PlanePoint& p) const { return std::ranges::find(corners, p) != corners.end(); }

    /// Whether a box lies outside for sure.
    bool misses(const PlaneBox& other) const {
        if (!box.overlaps(other)) return true;
        for (size_t i = 0; i < 3; ++i) {
            const PlanePoint &a = corners[i], &b = corners[(i + 1) % 3];
            // The corner of the box that is farthest to the left of the edge.
            const PlanePoint p{b[1] > a[1] ? other.low[0] : other.high[0],
                               b[0] > a[0] ? other.high[1] : other.low[1]};
            if (doubled_area(a, b, p) < 0) return true;
        }
        return false;
    }

    std::array<PlanePoint, 3> corners;
    PlaneBox box;
};

/// A k-d tree of points that are taken away one after the other.
class PointTree {
  public:
    static constexpr uint32_t none = UINT32_MAX;

    /// Of those points that `of` names, each once. The points stay where they are, and must outlive the tree.
    PointTree(const std::vector<PlanePoint>& points, std::vector<uint32_t> of)
        : points_(points), order_(std::move(of)), leaf_of_(points.size()) {
        size_t leaves = 1;
        while (leaves * leaf_size < order_.size()) leaves *= 2;
        first_leaf_ = leaves - 1;
        nodes_.resize(2 * leaves - 1);
        build(0, 0, order_.size());
    }

    void remove(uint32_t point) {
        size_t node = leaf_of_[point];
        const auto begin = order_.begin() + nodes_[node].begin, last = begin + nodes_[node].left - 1;
        std::iter_swap(std::find(begin, last, point), last);
        for (; --nodes_[node].left, node > 0; node = (node - 1) / 2) {
        }
    }

    struct Found {
        uint32_t point = none;
        bool is_inside = false;  ///< else it lies on the border
    };

    /// A point in a triangle, rather within than on its border; its corners do not count.
    Found find(const PlaneTriangle& triangle) {
        Found found;
        search(0, triangle, found);
        return found;
    }

    /// Nodes that all searches have looked at.
    uint64_t looks() const { return looks_; }

  private:
    static constexpr size_t leaf_size = 8;

    struct Node {
        PlaneBox box;
        uint32_t begin = 0, left = 0;  ///< points: those of a leaf that are left stand first
    };

    void build(size_t node, size_t begin, size_t end) {
        nodes_[node].begin = uint32_t(begin);
        nodes_[node].left = uint32_t(end - begin);
        PlaneBox& box = nodes_[node].box;
        for (size_t i = begin; i < end; ++i) box.add(points_[order_[i]]);
        if (node >= first_leaf_) {
            for (size_t i = begin; i < end; ++i) leaf_of_[order_[i]] = uint32_t(node);
            return;
        }
        const size_t axis = box.high[1] - box.low[1] > box.high[0] - box.low[0] ? 1 : 0;
        const size_t middle = begin + (end - begin) / 2;
        const auto at = [&](size_t i) { return order_.begin() + ptrdiff_t(i); };
        std::nth_element(at(begin), at(middle), at(end),
                         [&](uint32_t a, uint32_t b) { return points_[a][axis] < points_[b][axis]; });
        build(2 * node + 1, begin, middle);
        build(2 * node + 2, middle, end);
    }

    /// Whether a point inside was found: there is nothing else to look for.
    bool search(size_t node, const PlaneTriangle& triangle, Found& found) {
        ++looks_;
        const Node& here = nodes_[node];
        if (here.left == 0 || triangle.misses(here.box)) return false;
        if (node < first_leaf_)
            return search(2 * node + 1, triangle, found) || search(2 * node + 2, triangle, found);
        for (uint32_t i = here.begin; i < here.begin + here.left; ++i) {
            const PlanePoint& p = points_[order_[i]];
            const double depth = triangle.depth(p);
            if (depth > 0) {
                found = {order_[i], true};
                return true;
            }
            if (depth == 0 && !triangle.is_corner(p)) found.point = order_[i];
        }
        return false;
    }

    const std::vector<PlanePoint>& points_;
    std::vector<uint32_t> order_;
    std::vector<uint32_t> leaf_of_;  ///< by point
    std::vector<Node> nodes_;        ///< the children of i are 2 i + 1 and 2 i + 2
    size_t first_leaf_ = 0;
    uint64_t looks_ = 0;
};

}  // namespace easypbr::io

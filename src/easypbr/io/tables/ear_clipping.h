// Triangles of one polygon that need not be convex.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "easypbr/core/interrupt.h"
#include "easypbr/core/math.h"
#include "easypbr/io/tables/linked_lists.h"
#include "easypbr/io/tables/point_tree.h"
#include "easypbr/scene/array.h"

namespace easypbr::io {

/// Whether the fan from a polygon's first corner has triangles on the side of the polygon's normal alone,
/// but for what the rounding of the positions to float does. The normal is that of the sum of the fan's
/// areas (Newell); a polygon without area counts as good.
inline bool is_fan_good(const Array3f& V, const int32_t* polygon, size_t size) {
    const auto at = [&](size_t corner) { return Vec3d(V.row(polygon[corner]).transpose().cast<double>()); };
    const Vec3d origin = at(0);
    double largest = origin.cwiseAbs().maxCoeff(), extent = 0;
    Vec3d normal = Vec3d::Zero(), before = at(1) - origin;
    for (size_t k = 2; k < size; ++k) {
        const Vec3d corner = at(k), edge = corner - origin;
        largest = std::max(largest, corner.cwiseAbs().maxCoeff());
        extent = std::max({extent, edge.norm(), before.norm()});
        normal += before.cross(edge);
        before = edge;
    }
    const double length = normal.norm();
    const double rounding = 2 * double(std::numeric_limits<float>::epsilon()) * largest * extent;
    if (!(length > rounding)) return true;
    before = at(1) - origin;
    for (size_t k = 2; k < size; ++k) {
        const Vec3d edge = at(k) - origin;
        if (before.cross(edge).dot(normal) < -rounding * length) return false;
        before = edge;
    }
    return true;
}

/// Cuts corners off a polygon one after the other (Meisters 1975, "Polygons have ears"), seen along its
/// normal. Bridges to holes, repeated corners and corners on a line are fine. What crosses itself is cut
/// too: the triangles' signed areas always add up to the polygon's.
///
/// A corner that is no ear is tested again only once its neighbours change, or the corner that lies in its
/// triangle is no longer in the way. Those are found in a tree. The time of usual outlines grows little
/// faster than the number of corners.
class EarClipper {
  public:
    /// `polygon` has `size` corners, at least three. `looks`: how many nodes of the tree are looked at for
    /// each of them at most.
    EarClipper(const Array3f& V, const int32_t* polygon, size_t size, uint64_t looks)
        : polygon_(polygon),
          points_(projected(V, polygon, size)),
          before_(size),
          after_(size),
          is_reflex_(size),
          ranks_(size, rank_count),
          waiting_(size, size),
          tree_(points_, link()),
          most_looks_(looks * size) {
        for (uint32_t i = 0; i < size; ++i) place(i);
    }

    EarClipper(const EarClipper&) = delete;
    EarClipper& operator=(const EarClipper&) = delete;

    /// Writes size - 2 triangles. Returns whether all corners were tested: the others, beyond the looks,
    /// were cut off as they came, and triangles may overlap. Throws Interrupted.
    bool write(int32_t* out) {
        uint32_t left_over = 0;
        for (size_t left = points_.size(); left > 3; --left) {
            const uint32_t corner = next();
            out = write_triangle(corner, out);
            left_over = after_[corner];
            remove(corner);
        }
        write_triangle(left_over, out);
        return tree_.looks() <= most_looks_;
    }

  private:
    /// What a corner is, in the order in which they are cut off: those of a rank only where all before it
    /// have none. An ear is cut off when it is found.
    enum Rank : size_t {
        untested,  ///< turns to the left
        flat,      ///< does not turn
        touched,   ///< others lie on the border of its triangle, none within
        blocked,   ///< others lie in its triangle
        reflex,    ///< turns to the right
        rank_count
    };

    /// Leaves out the axis along which the normal is longest.
    static std::vector<PlanePoint> projected(const Array3f& V, const int32_t* polygon, size_t size) {
        const auto at = [&](size_t i) { return Vec3d(V.row(polygon[i]).transpose().cast<double>()); };
        Vec3d normal = Vec3d::Zero();
        for (size_t i = 2; i < size; ++i) normal += (at(i - 1) - at(0)).cross(at(i) - at(0));
        Eigen::Index axis = 0;
        normal.cwiseAbs().maxCoeff(&axis);
        const Eigen::Index u = (axis + 1) % 3, v = (axis + 2) % 3;
        const bool flip = normal[axis] < 0;
        std::vector<PlanePoint> points(size);
        for (size_t i = 0; i < size; ++i) {
            const Vec3d p = at(i);
            points[i] = {p[flip ? v : u], p[flip ? u : v]};
        }
        return points;
    }

    /// Joins neighbours. The corners that turn to the right or not at all: where a corner lies in a triangle
    /// that is to be cut off, one of these does too.
    std::vector<uint32_t> link() {
        const size_t size = points_.size();
        for (size_t i = 0; i < size; ++i) {
            before_[i] = uint32_t(i == 0 ? size - 1 : i - 1);
            after_[i] = uint32_t(i + 1 == size ? 0 : i + 1);
        }
        std::vector<uint32_t> found;
        for (uint32_t i = 0; i < size; ++i)
            if ((is_reflex_[i] = !(turn(i) > 0))) found.push_back(i);
        return found;
    }

    /// Above 0 where the outline turns to the left.
    double turn(uint32_t corner) const {
        return doubled_area(points_[before_[corner]], points_[corner], points_[after_[corner]]);
    }

    /// The corner to cut off.
    uint32_t next() {
        for (uint32_t corner; (corner = ranks_.first(untested)) != LinkedLists::none;)
            if (is_ear(corner)) return corner;
        size_t rank = flat;
        while (ranks_.first(rank) == LinkedLists::none) ++rank;
        return ranks_.first(rank);
    }

    /// Else it goes into the rank that it has found to be of.
    bool is_ear(uint32_t corner) {
        check_interrupt(++tests_);
        if (tree_.looks() > most_looks_) return true;
        const PointTree::Found found =
            tree_.find({points_[before_[corner]], points_[corner], points_[after_[corner]]});
        if (found.point == PointTree::none) return true;
        ranks_.move(corner, found.is_inside ? blocked : touched);
        waiting_.move(corner, found.point);
        return false;
    }

    /// Puts a corner into the rank that its neighbours make it. Behind others: to go on there, behind the
    /// next corner, gives fewer thin triangles than a fan.
    void place(uint32_t corner) {
        const double turned = turn(corner);
        if (turned > 0) clear_way(corner);
        waiting_.remove(corner);
        ranks_.move(corner, turned > 0 ? untested : turned == 0 ? flat : reflex);
    }

    /// A corner no longer lies in the way of others.
    void clear_way(uint32_t corner) {
        if (!is_reflex_[corner]) return;
        is_reflex_[corner] = false;
        tree_.remove(corner);
        for (uint32_t waiting; (waiting = waiting_.first(corner)) != LinkedLists::none;) {
            waiting_.remove(waiting);
            ranks_.move(waiting, untested);
        }
    }

    void remove(uint32_t corner) {
        const uint32_t before = before_[corner], after = after_[corner];
        after_[before] = after;
        before_[after] = before;
        ranks_.remove(corner);
        waiting_.remove(corner);
        clear_way(corner);
        place(before);
        place(after);
    }

    int32_t* write_triangle(uint32_t corner, int32_t* out) const {
        for (const uint32_t i : {before_[corner], corner, after_[corner]}) *out++ = polygon_[i];
        return out;
    }

    const int32_t* polygon_;
    std::vector<PlanePoint> points_;
    std::vector<uint32_t> before_, after_;  ///< the neighbours that are left
    std::vector<char> is_reflex_;           ///< turned to the right or not at all ever since, and is left
    LinkedLists ranks_;
    LinkedLists waiting_;  ///< by the corner that lies in the way
    PointTree tree_;       ///< of those that may lie in the way
    uint64_t most_looks_;
    size_t tests_ = 0;
};

}  // namespace easypbr::io

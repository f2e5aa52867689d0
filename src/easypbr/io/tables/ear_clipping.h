// Triangles of one polygon that need not be convex.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/scene/array.h"

namespace easypbr::io {

/// Polygons with more corners are cut into fans: the time grows with the square of the corners.
inline constexpr size_t most_clipped_corners = 1 << 13;

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
class EarClipper {
  public:
    /// `polygon` has `size` corners, at least three.
    EarClipper(const Array3f& V, const int32_t* polygon, size_t size)
        : polygon_(polygon), points_(size), before_(size), after_(size), is_reflex_(size) {
        project(V);
        for (size_t i = 0; i < size; ++i) {
            before_[i] = uint32_t(i == 0 ? size - 1 : i - 1);
            after_[i] = uint32_t(i + 1 == size ? 0 : i + 1);
        }
        for (uint32_t i = 0; i < size; ++i)
            if ((is_reflex_[i] = turn(i) <= 0)) reflex_.push_back(i);
        for (auto& scanned : scanned_) scanned.assign(size, 0);
    }

    /// Writes size - 2 triangles.
    void write(int32_t* out) {
        uint32_t corner = 0, passed = 0;
        int rule = 0;
        for (size_t left = points_.size(); left > 3;) {
            if (!may_cut(corner, rule)) {
                corner = after_[corner];
                // A round without an ear: the next rule takes what the last one refused.
                if (++passed > left) passed = 0, ++rule;
                continue;
            }
            out = write_triangle(corner, out);
            remove(corner);
            // Going on behind the next corner gives fewer thin triangles than a fan.
            corner = after_[after_[corner]];
            --left, passed = 0, rule = 0;
        }
        write_triangle(corner, out);
    }

  private:
    using Point = std::array<double, 2>;

    /// Leaves out the axis along which the normal is longest.
    void project(const Array3f& V) {
        const auto at = [&](size_t i) { return Vec3d(V.row(polygon_[i]).transpose().cast<double>()); };
        Vec3d normal = Vec3d::Zero();
        for (size_t i = 2; i < points_.size(); ++i) normal += (at(i - 1) - at(0)).cross(at(i) - at(0));
        Eigen::Index axis = 0;
        normal.cwiseAbs().maxCoeff(&axis);
        const Eigen::Index u = (axis + 1) % 3, v = (axis + 2) % 3;
        const bool flip = normal[axis] < 0;
        for (size_t i = 0; i < points_.size(); ++i) {
            const Vec3d p = at(i);
            points_[i] = {p[flip ? v : u], p[flip ? u : v]};
        }
    }

    /// Twice the signed area of a triangle.
    static double area(const Point& a, const Point& b, const Point& c) {
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    }

    /// Above 0 where the outline turns to the left.
    double turn(uint32_t corner) const {
        return area(points_[before_[corner]], points_[corner], points_[after_[corner]]);
    }

    /// Rules from the strictest on: an ear; one without area; an ear that other corners touch; any corner to
    /// the left; any corner.
    bool may_cut(uint32_t corner, int rule) {
        const double turned = turn(corner);
        switch (rule) {
            case 0:
                return turned > 0 && is_free(corner, true);
            case 1:
                return turned == 0;
            case 2:
                return turned > 0 && is_free(corner, false);
            case 3:
                return turned > 0;
            default:
                return true;
        }
    }

    /// Whether no other corner lies in the triangle at a corner, or on its border with `closed`. Corners to
    /// the left need no test: where one lies within, one to the right does too. Those found outside stay
    /// there, so that a search goes on where the last one ended.
    bool is_free(uint32_t corner, bool closed) {
        const Point &a = points_[before_[corner]], &b = points_[corner], &c = points_[after_[corner]];
        const double low_x = std::min({a[0], b[0], c[0]}), high_x = std::max({a[0], b[0], c[0]});
        const double low_y = std::min({a[1], b[1], c[1]}), high_y = std::max({a[1], b[1], c[1]});
        uint32_t& next = scanned_[closed ? 0 : 1][corner];
        for (; next < reflex_.size(); ++next) {
            const Point& p = points_[reflex_[next]];
            if (p[0] < low_x || p[0] > high_x || p[1] < low_y || p[1] > high_y) continue;
            if (!is_reflex_[reflex_[next]] || p == a || p == b || p == c) continue;
            const double least = std::min({area(a, b, p), area(b, c, p), area(c, a, p)});
            if (closed ? least >= 0 : least > 0) return false;
        }
        return true;
    }

    void remove(uint32_t corner) {
        const uint32_t before = before_[corner], after = after_[corner];
        after_[before] = after;
        before_[after] = before;
        is_reflex_[corner] = false;
        for (const uint32_t neighbour : {before, after}) {
            is_reflex_[neighbour] = is_reflex_[neighbour] && turn(neighbour) <= 0;
            for (auto& scanned : scanned_) scanned[neighbour] = 0;
        }
    }

    int32_t* write_triangle(uint32_t corner, int32_t* out) const {
        for (const uint32_t i : {before_[corner], corner, after_[corner]}) *out++ = polygon_[i];
        return out;
    }

    const int32_t* polygon_;
    std::vector<Point> points_;
    std::vector<uint32_t> before_, after_;          ///< the neighbours that are left
    std::vector<char> is_reflex_;                   ///< turns to the right or not at all, and is left
    std::vector<uint32_t> reflex_;                  ///< those that were so at the begin
    std::array<std::vector<uint32_t>, 2> scanned_;  ///< how many of these lie outside; closed, open
};

}  // namespace easypbr::io

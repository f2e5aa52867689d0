// Distances of triangles.
#pragma once

#include <algorithm>

#include "easypbr/core/math.h"

namespace easypbr::detail {

inline Vec3d nearest_on_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
    const double length = (b - a).squaredNorm();
    return length > 0 ? Vec3d(a + std::clamp((p - a).dot(b - a) / length, 0.0, 1.0) * (b - a)) : a;
}

inline Vec3d nearest_on_edges(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    Vec3d nearest = nearest_on_segment(p, a, b);
    for (const Vec3d& other : {nearest_on_segment(p, b, c), nearest_on_segment(p, c, a)})
        if ((other - p).squaredNorm() < (nearest - p).squaredNorm()) nearest = other;
    return nearest;
}

/// See easypbr::nearest_on_triangle().
inline Vec3d nearest_on_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
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

}  // namespace easypbr::detail

// Ellipses in space: which pixels of a picture each of them covers, and how deep.
#pragma once

#include <algorithm>
#include <cmath>

#include "easypbr/core/math.h"
#include "easypbr/core/picture.h"

namespace easypbr::render {

/// An ellipse on a picture of `size` pixels a side: the points p + u t + v b with u^2 + v^2 <= 1. Homogeneous
/// pixel coordinates are linear in (u, v, 1), so that the inverse of a 3 x 3 matrix takes a pixel back to
/// them (Sigg et al. 2006, "GPU-Based Ray-Casting of Quadratic Surfaces"). Those that cross the plane of the
/// eye are right too.
class ScreenEllipse {
  public:
    /// Covers nothing.
    ScreenEllipse() = default;
    /// Vectors in clip coordinates; w of t and b is 0 before the projection.
    ScreenEllipse(const Eigen::Vector4d& p, const Eigen::Vector4d& t, const Eigen::Vector4d& b, int size) {
        // A row of the picture's matrix, of what varies as the given row of clip coordinates.
        const auto row = [&](auto&& of) { return Vec3d(of(t), of(b), of(p)); };
        const double half = 0.5 * size;
        const Vec3d x = row([&](const Eigen::Vector4d&v) { return half * (v.x() + v.w()); }),
                    y = row([&](const Eigen::Vector4d&v) { return half * (v.w() - v.y()); }),
                    w = row([](const Eigen::Vector4d&v) { return v.w(); });
        z_ = row([](const Eigen::Vector4d& v) { return v.z(); });
        // Wholly outside of one side: the largest value over the ellipse is negative.
        const auto is_outside = [](const Vec3d& side) {
            return side.z() + std::hypot(side.x(), side.y()) < 0;
        };
        if (is_outside(x) || is_outside(y) || is_outside(size * w - x) || is_outside(size * w - y) ||
            is_outside(z_) || is_outside(w - z_))
            return;
        by_x_ = y.cross(w);
        by_y_ = w.cross(x);
        by_one_ = x.cross(y);
        determinant_ = w.dot(by_one_);
        // Extent of what lies before the eye, by its dual conic.
        const auto conic = [](const Vec3d& k, const Vec3d& l) {
            return k.x() * l.x() + k.y() * l.y() - k.z() * l.z();
        };
        const double q_ww = conic(w, w);
        const auto extent = [&](const Vec3d& k, int& first, int& end) {
            end = size;
            if (!(q_ww < 0)) return;
            const double q_kw = conic(k, w),
                         root = std::sqrt(std::max(0.0, q_kw * q_kw - q_ww * conic(k, k)));
            first = int(std::ceil(std::clamp((q_kw + root) / q_ww - 0.5, 0.0, double(size))));
            end = int(std::floor(std::clamp((q_kw - root) / q_ww + 0.5, 0.0, double(size))));
        };
        extent(x, x0_, x1_);
        extent(y, y0_, y1_);
    }

    /// Rows that it may reach: from the first up to the end.
    int first_row() const { return y0_; }
    int end_row() const { return y1_; }

    /// Calls put(column, row, depth) for each pixel of a part of the picture whose centre the ellipse covers
    /// between the near and the far plane; depths are reversed.
    template <class Put>
    void cover(const PixelRect& part, const Put& put) const {
        const int left = std::max(x0_, part.x), right = std::min(x1_, part.x + part.width);
        for (int row = std::max(y0_, part.y); row < std::min(y1_, part.y + part.height); ++row)
            for (int column = left; column < right; ++column) {
                const Vec3d place = by_x_ * (column + 0.5) + by_y_ * (row + 0.5) + by_one_;
                // Of the two cones from the eye the one before it.
                const bool is_before = place.z() * determinant_ > 0;
                if (!is_before || place.head<2>().squaredNorm() > place.z() * place.z()) continue;
                const double depth = z_.dot(place) / determinant_;
                if (depth > 0 && depth <= 1) put(column, row, float(depth));
            }
    }

  private:
    Vec3d by_x_{0, 0, 0}, by_y_{0, 0, 0},
        by_one_{0, 0, 0};  ///< columns of the inverse, times the determinant
    Vec3d z_{0, 0, 0};
    double determinant_ = 0;
    int x0_ = 0, x1_ = 0, y0_ = 0, y1_ = 0;
};

}  // namespace easypbr::render

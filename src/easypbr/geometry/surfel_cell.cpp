#include "easypbr/geometry/surfel_cell.h"

#include <algorithm>
#include <cmath>

#include "easypbr/scene/principal_axes.h"

namespace easypbr::geometry {
namespace {

constexpr int outside = -1;

/// A convex polygon around the origin; each edge, from its corner to the next, knows what cut it.
class Cell {
  public:
    explicit Cell(double reach) {
        constexpr int corners = 16;
        for (int i = 0; i < corners; ++i) {
            const double angle = 2 * pi * i / corners;
            corners_.push_back({reach * Vec2d(std::cos(angle), std::sin(angle)), outside});
        }
    }

    /// Keeps the points x with x . across <= limit.
    void cut(const Vec2d& across, double limit, int name) {
        cut_.clear();
        const size_t count = corners_.size();
        for (size_t i = 0; i < count; ++i) {
            const Corner &here = corners_[i], &next = corners_[(i + 1) % count];
            const double above = here.at.dot(across) - limit, next_above = next.at.dot(across) - limit;
            if (above <= 0) cut_.push_back(here);
            if ((above <= 0) == (next_above <= 0)) continue;
            const Vec2d crossing = here.at + (next.at - here.at) * (above / (above - next_above));
            // Leaving: the new edge begins here. Entering: the old edge goes on.
            cut_.push_back({crossing, above <= 0 ? name : here.edge});
        }
        corners_.swap(cut_);
    }

    double farthest_squared() const {
        double farthest = 0;
        for (const Corner& corner : corners_) farthest = std::max(farthest, corner.at.squaredNorm());
        return farthest;
    }

    /// Calls visit(corner, edge to the next one, edge from the one before).
    template <class Visit>
    void visit(Visit&& visit) const {
        int before = corners_.empty() ? outside : corners_.back().edge;
        for (const Corner& corner : corners_) {
            visit(corner.at, corner.edge, before);
            before = corner.edge;
        }
    }

  private:
    struct Corner {
        Vec2d at;
        int edge;
    };
    std::vector<Corner> corners_, cut_;
};

/// A step's part in the tangent plane, and where the plane half way to it cuts that.
struct Bound {
    Vec2d across;
    double limit;
};

Cell cell_of(const std::vector<Bound>& bounds, double reach) {
    Cell cell(reach);
    for (size_t i = 0; i < bounds.size(); ++i) {
        const double length_squared = bounds[i].across.squaredNorm();
        // What cuts beyond the farthest corner cuts nothing.
        if (bounds[i].limit * bounds[i].limit < cell.farthest_squared() * length_squared)
            cell.cut(bounds[i].across, bounds[i].limit, int(i));
    }
    return cell;
}

/// The cell, ended where nothing bounds it.
Cell bounded_cell(const std::vector<Bound>& bounds, double reach) {
    Cell cell = cell_of(bounds, reach);
    bool is_open = false;
    double farthest_corner = 0, farthest_bound = 0;
    cell.visit([&](const Vec2d& corner, int edge, int edge_before) {
        is_open |= edge == outside;
        if (edge != outside && edge_before != outside)
            farthest_corner = std::max(farthest_corner, corner.norm());
        if (edge == outside) return;
        const Bound& bound = bounds[size_t(edge)];
        farthest_bound = std::max(farthest_bound, bound.limit / bound.across.norm());
    });
    if (!is_open || farthest_bound == 0) return cell;
    const double end = farthest_corner > 0 ? farthest_corner : farthest_bound * std::sqrt(2.0);
    return cell_of(bounds, std::min(reach, end));
}

/// Second moments whose ellipse { x : x' M^-1 x <= 2 } is, up to its size, the smallest one around the origin
/// that contains the corners: the multiplicative algorithm for the D-optimal design (Titterington 1976),
/// which is the dual problem. Each step moves weight to the corners that stick out most; a dozen come within
/// a few percent.
Eigen::Matrix2d covering_moments(const Cell& cell) {
    std::vector<double> weights;
    cell.visit([&](const Vec2d&, int, int) { weights.push_back(1); });
    Eigen::Matrix2d moments;
    for (int step = 0;; ++step) {
        moments.setZero();
        size_t i = 0;
        cell.visit(
            [&](const Vec2d& corner, int, int) { moments += weights[i++] * corner * corner.transpose(); });
        moments /= moments.trace();
        if (step == 12) return moments;
        Eigen::Matrix2d inverse = (moments + 1e-6 * Eigen::Matrix2d::Identity()).inverse();
        i = 0;
        cell.visit([&](const Vec2d& corner, int, int) { weights[i++] *= corner.dot(inverse * corner); });
        const double largest = *std::max_element(weights.begin(), weights.end());
        for (double& weight : weights) weight /= largest;
    }
}

}  // namespace

Vec3d perpendicular(const Vec3d& n) {
    const double sign = std::copysign(1.0, n.z()), a = -1 / (sign + n.z()), b = n.x() * n.y() * a;
    return {1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x()};
}

SurfelAxes covering_axes(const Vec3d& normal, std::span<const Vec3d> steps, double reach) {
    const Vec3d u = perpendicular(normal), v = normal.cross(u);
    std::vector<Bound> bounds;
    bounds.reserve(steps.size());
    for (const Vec3d& step : steps) {
        const Vec2d across(step.dot(u), step.dot(v));
        if (across.squaredNorm() > 0) bounds.push_back({across, step.squaredNorm() / 2});
    }
    const Cell cell = bounded_cell(bounds, reach);
    const detail::PrincipalAxes axes = detail::principal_axes(covering_moments(cell));
    const Vec2d direction = axes.directions.col(1);
    const double shape = std::sqrt(std::max(axes.values[0], 1e-4) / axes.values[1]);
    double first = 0;
    cell.visit([&](const Vec2d& corner, int, int) {
        const double along = corner.dot(direction);
        const double aside = (corner.y() * direction.x() - corner.x() * direction.y()) / shape;
        first = std::max(first, std::hypot(along, aside));
    });
    return {(direction.x() * u + direction.y() * v) * first, first * shape};
}

}  // namespace easypbr::geometry

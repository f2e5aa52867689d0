#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "easypbr/core/interrupt.h"
#include "easypbr/core/parallel.h"
#include "easypbr/geometry/gather.h"
#include "easypbr/geometry/place.h"
#include "easypbr/scene/merge.h"

namespace easypbr {
namespace {

using BoxPoints = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// The points that are not inside a star of tetrahedra between the farthest ones along 26 directions and
/// their mean: as these lie within the convex hull, no corner of it is left out (Akl and Toussaint 1978).
BoxPoints outer_points(const BoxPoints& points) {
    const Vec3d size = (points.colwise().maxCoeff() - points.colwise().minCoeff()).transpose();
    if (!(size.minCoeff() > 0)) return points;
    std::array<Vec3d, 27> extremes;  // of direction (x, y, z) in -1 .. 1 at 9 x + 3 y + z + 13
    for (int i = 0; i < 27; ++i) {
        check_interrupt();
        const int x = i / 9 - 1, y = i / 3 % 3 - 1, z = i % 3 - 1;
        const Vec3d direction = Vec3d(x, y, z).cwiseQuotient(size);
        Eigen::Index farthest = 0;
        (points * direction).maxCoeff(&farthest);
        extremes[size_t(i)] = points.row(farthest).transpose();
    }
    Vec3d centre = Vec3d::Zero();
    for (int i = 0; i < 27; ++i)
        if (i != 13) centre += extremes[size_t(i)] / 26;
    std::vector<Mat3d> to_barycentrics;
    // Of each triangle of a cube's faces: middle of the face, middle of an edge, corner.
    for (int face = 0; face < 6; ++face)
        for (int which = 0; which < 8; ++which) {
            const int axis = face / 2, steps[3] = {9, 3, 1}, first = (axis + 1 + which / 4) % 3,
                      second = 3 - axis - first;
            const int middle = 13 + steps[axis] * (face % 2 ? 1 : -1),
                      edge = middle + steps[first] * (which % 2 ? 1 : -1),
                      corner = edge + steps[second] * (which / 2 % 2 ? 1 : -1);
            Mat3d edges;
            edges << extremes[size_t(middle)] - centre, extremes[size_t(edge)] - centre,
                extremes[size_t(corner)] - centre;
            const double volume = std::abs(edges.determinant());
            if (volume > 1e-6 * edges.colwise().norm().prod()) to_barycentrics.emplace_back(edges.inverse());
        }
    std::vector<char> is_outer(static_cast<size_t>(points.rows()));
    parallel_for(is_outer.size(), size_t(1) << 12, [&](size_t i) {
        const Vec3d place = points.row(Eigen::Index(i)).transpose() - centre;
        is_outer[i] = std::ranges::none_of(to_barycentrics, [&](const Mat3d& matrix) {
            const Vec3d weights = matrix * place;
            return weights.minCoeff() >= 0 && weights.sum() < 1 - 1e-9;
        });
    });
    BoxPoints outer(std::ranges::count(is_outer, char(1)), 3);
    Eigen::Index row = 0;
    for (size_t i = 0; i < is_outer.size(); ++i)
        if (is_outer[i]) outer.row(row++) = points.row(Eigen::Index(i));
    return outer;
}

double cross(const Vec2d& a, const Vec2d& b) {
    return a.x() * b.y() - a.y() * b.x();
}

/// The points that are not inside the octagon of the farthest ones along eight directions (Akl and Toussaint
/// 1978): no corner of the convex hull is.
std::vector<Vec2d> outer_points(const std::vector<Vec2d>& points) {
    std::array<Vec2d, 8> extremes;
    for (int i = 0; i < 8; ++i) {
        const Vec2d direction(std::cos(pi * i / 4), std::sin(pi * i / 4));
        extremes[size_t(i)] = *std::max_element(
            points.begin(), points.end(),
            [&](const Vec2d& a, const Vec2d& b) { return a.dot(direction) < b.dot(direction); });
    }
    std::vector<Vec2d> outer;
    for (const Vec2d& point : points) {
        bool is_inside = true;
        for (size_t i = 0; i < 8 && is_inside; ++i) {
            const Vec2d &a = extremes[i], &b = extremes[(i + 1) % 8];
            // Where two extremes coincide their edge says nothing.
            is_inside = a == b || cross(b - a, point - a) > 0;
        }
        if (!is_inside) outer.push_back(point);
    }
    return outer;
}

/// Corners counter-clockwise (monotone chain, Andrew 1979).
std::vector<Vec2d> convex_hull(std::vector<Vec2d> points) {
    points = outer_points(points);
    std::sort(points.begin(), points.end(), [](const Vec2d& a, const Vec2d& b) {
        return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
    });
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() < 3) return points;
    std::vector<Vec2d> hull;
    const auto add_chain = [&](auto begin, auto end) {
        const size_t first = hull.size();
        for (auto point = begin; point != end; ++point) {
            while (hull.size() >= first + 2 &&
                   cross(hull.back() - hull[hull.size() - 2], *point - hull[hull.size() - 2]) <= 0)
                hull.pop_back();
            hull.push_back(*point);
        }
        // It is the first of the other chain.
        hull.pop_back();
    };
    add_chain(points.begin(), points.end());
    add_chain(points.rbegin(), points.rend());
    return hull;
}

/// Direction of a side of the rectangle of least area around the points.
Vec2d best_direction(const std::vector<Vec2d>& points) {
    const std::vector<Vec2d> hull = convex_hull(points);
    if (hull.size() < 2) return Vec2d::UnitX();
    if (hull.size() == 2) return (hull[1] - hull[0]).normalized();
    const size_t count = hull.size();
    double least = std::numeric_limits<double>::infinity();
    Vec2d best = Vec2d::UnitX();
    // The corners farthest along the edge, away from it and against it only go forward as the edge does.
    size_t along = 1, away = 1, against = 1;
    for (size_t i = 0; i < count; ++i) {
        const Vec2d direction = (hull[(i + 1) % count] - hull[i]).normalized(),
                    inwards(-direction.y(), direction.x());
        const auto advance = [&](size_t& corner, const Vec2d& towards) {
            while (hull[(corner + 1) % count].dot(towards) > hull[corner % count].dot(towards)) ++corner;
        };
        advance(along, direction);
        away = std::max(away, along);
        advance(away, inwards);
        against = std::max(against, away);
        advance(against, -direction);
        const double width = (hull[along % count] - hull[against % count]).dot(direction);
        const double height = (hull[away % count] - hull[i]).dot(inwards);
        if (width * height >= least) continue;
        least = width * height;
        best = direction;
    }
    return best;
}

Vec3d extent(const BoxPoints& points, const Mat3d& axes) {
    const BoxPoints turned = points * axes;
    return (turned.colwise().maxCoeff() - turned.colwise().minCoeff()).transpose();
}

/// Whether a box is smaller: in volume, else (when neither has any) in area, else in length.
bool is_smaller(const Vec3d& a, const Vec3d& b) {
    const double scale = std::max(a.maxCoeff(), b.maxCoeff());
    if (!(scale > 0)) return false;
    const auto measures = [&](const Vec3d& size) {
        const Vec3d s = size / scale;
        return Vec3d(s.prod(), s.x() * s.y() + s.y() * s.z() + s.z() * s.x(), s.sum());
    };
    const Vec3d difference = measures(a) - measures(b);
    for (const double change : difference)
        if (std::abs(change) > 1e-9) return change < 0;
    return false;
}

/// Axes (columns) after each was kept in turn while the other two were turned to the best rectangle.
Mat3d refined_axes(const BoxPoints& points, Mat3d axes) {
    Vec3d size = extent(points, axes);
    for (int kept = 0, unchanged = 0; unchanged < 3; kept = (kept + 1) % 3, ++unchanged) {
        check_interrupt();
        const Vec3d u = axes.col((kept + 1) % 3), v = axes.col((kept + 2) % 3);
        std::vector<Vec2d> projected(static_cast<size_t>(points.rows()));
        for (Eigen::Index i = 0; i < points.rows(); ++i)
            projected[size_t(i)] = Vec2d(points.row(i).dot(u), points.row(i).dot(v));
        const Vec2d direction = best_direction(projected);
        Mat3d turned = axes;
        turned.col((kept + 1) % 3) = direction.x() * u + direction.y() * v;
        turned.col((kept + 2) % 3) = -direction.y() * u + direction.x() * v;
        const Vec3d turned_size = extent(points, turned);
        if (!is_smaller(turned_size, size)) continue;
        axes = turned;
        size = turned_size;
        unchanged = -1;
    }
    return axes;
}

OrientedBox box_along(const BoxPoints& points, const Mat3d& axes) {
    const Vec3d size = extent(points, axes);
    std::array<int, 3> order{0, 1, 2};
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return size[a] > size[b]; });
    Mat3d sorted;
    for (int i = 0; i < 3; ++i) sorted.col(i) = axes.col(order[size_t(i)]);
    sorted.col(2) = sorted.col(0).cross(sorted.col(1));
    const BoxPoints turned = points * sorted;
    OrientedBox box;
    box.size = (turned.colwise().maxCoeff() - turned.colwise().minCoeff()).transpose();
    box.T_world_box.linear() = sorted;
    box.T_world_box.translation() =
        sorted * (turned.colwise().maxCoeff() + turned.colwise().minCoeff()).transpose() / 2;
    return box;
}

}  // namespace

OrientedBox oriented_bounding_box(const Mesh& mesh) {
    const MeshData flat = flatten_shape(mesh);
    geometry::require_vertices("oriented bounding box", flat);
    BoxPoints points = flat.V.cast<double>();
    const Eigen::RowVector3d mean = points.colwise().mean();
    points.rowwise() -= mean;
    const Mat3d covariance = points.transpose() * points;
    const Mat3d principal = Eigen::SelfAdjointEigenSolver<Mat3d>(covariance).eigenvectors();
    points = outer_points(points);
    const Mat3d candidates[2] = {refined_axes(points, principal), refined_axes(points, Mat3d::Identity())};
    const bool first = is_smaller(extent(points, candidates[0]), extent(points, candidates[1]));
    OrientedBox box = box_along(points, candidates[first ? 0 : 1]);
    box.T_world_box.pretranslate(mean.transpose() + flat.offset);
    return box;
}

}  // namespace easypbr

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"
#include "easypbr/geometry/gather.h"
#include "easypbr/geometry/rays.h"
#include "easypbr/geometry/require.h"
#include "easypbr/geometry/triangle_tree.h"
#include "easypbr/scene/eye.h"
#include "easypbr/scene/merge.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/mesh_arrays.h"
#include "easypbr/scene/near_plane.h"
#include "easypbr/scene/pixel.h"

namespace easypbr {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr size_t ray_grain = 256;

/// Which side of the directed line from p to q the origin of the plane is on, and twice the area between.
struct Side {
    int sign;
    double area;
};

/// The sign is exact, so that two triangles never disagree about the edge that they share: rounded products
/// keep their order, and where they are equal their rounding errors, which fma() gives, decide.
Side side_of(const Vec2d& p, const Vec2d& q) {
    const double a = p.x() * q.y(), b = p.y() * q.x();
    if (a != b) return {a > b ? 1 : -1, std::abs(a - b)};
    const double a_error = std::fma(p.x(), q.y(), -a), b_error = std::fma(p.y(), q.x(), -b);
    return {(a_error > b_error) - (a_error < b_error), std::abs(a_error - b_error)};
}

/// What the sign becomes when the origin moves by an infinitesimal part of x, and one far smaller of y
/// (Edelsbrunner and Muecke 1990, simulation of simplicity): no line passes through it any more.
int strict_sign(const Side& side, const Vec2d& p, const Vec2d& q) {
    if (side.sign != 0) return side.sign;
    if (p.y() != q.y()) return p.y() > q.y() ? 1 : -1;
    return (q.x() > p.x()) - (q.x() < p.x());
}

/// The same, to the last bit, for any order of the terms.
double ordered_sum(double a, double b, double c) {
    if (a > b) std::swap(a, b);
    if (b > c) std::swap(b, c);
    if (a > b) std::swap(a, b);
    return a + b + c;
}

/// A ray in the frame of a tree. Triangles are sheared so that the ray is an axis, which is the same for all
/// triangles at a vertex (Woop, Benthin and Wald 2013, Watertight Ray/Triangle Intersection).
class TreeRay {
  public:
    /// `direction` is unit. What the ray meets counts in boxes of this `extent`, the largest coordinate.
    TreeRay(const Vec3d& origin, const Vec3d& direction, double extent) : origin_(origin) {
        direction.cwiseAbs().maxCoeff(&z_);
        x_ = (z_ + 1) % 3;
        y_ = (z_ + 2) % 3;
        shear_ = Vec3d(direction[x_], direction[y_], 1) / direction[z_];
        inverse_ = direction.cwiseInverse();
        // Beyond all that shearing and the distances of planes round.
        const double margin = 1e-14 * (extent + origin.cwiseAbs().maxCoeff());
        for (int axis = 0; axis < 3; ++axis) {
            const bool is_falling = std::signbit(direction[axis]);
            near_[axis] = is_falling ? axis + 3 : axis;
            far_[axis] = is_falling ? axis : axis + 3;
            entry_[axis] = origin[axis] + (is_falling ? -margin : margin);
            exit_[axis] = origin[axis] - (is_falling ? -margin : margin);
        }
    }

    /// Where the ray enters a box, from 0 on; infinity where it does not.
    double entry(const geometry::TreeBox& box) const {
        const float* corners = box.corners.data();
        double begin = 0, end = infinite;
        for (int axis = 0; axis < 3; ++axis) {
            // What is not a number, 0 / 0, bounds nothing.
            begin = std::max(begin, (corners[near_[axis]] - entry_[axis]) * inverse_[axis]);
            end = std::min(end, (corners[far_[axis]] - exit_[axis]) * inverse_[axis]);
        }
        return begin <= end ? begin : infinite;
    }

    struct Meeting {
        double distance = infinite;  ///< negative behind the origin; infinity: none
        Vec3d barycentric{0, 0, 0};
        int winding = 0;  ///< 1 or -1 by the side that is met; 0 where strict rules let the ray pass
    };

    /// Distances of triangles with the same corners are equal, however they are wound.
    Meeting meet(const geometry::TriangleTree::Triangle& triangle) const {
        std::array<Vec2d, 3> at;
        for (size_t k = 0; k < 3; ++k) at[k] = plane_of(triangle[k]);
        const std::array<Side, 3> sides{side_of(at[1], at[2]), side_of(at[2], at[0]), side_of(at[0], at[1])};
        bool has_left = false, has_right = false;
        Vec3d areas, depths;
        for (size_t k = 0; k < 3; ++k) {
            has_left |= sides[k].sign > 0;
            has_right |= sides[k].sign < 0;
            areas[Eigen::Index(k)] = sides[k].area;
            depths[Eigen::Index(k)] = (triangle[k][z_] - origin_[z_]) * shear_.z();
        }
        const double area = ordered_sum(areas.x(), areas.y(), areas.z());
        // Seen edge-on, a triangle has no inside.
        if (has_left == has_right || !(area > 0)) return {};
        Meeting meeting;
        meeting.barycentric = areas / area;
        const Vec3d weighted = meeting.barycentric.cwiseProduct(depths);
        meeting.distance = ordered_sum(weighted.x(), weighted.y(), weighted.z());
        const auto strict = [&](size_t k) { return strict_sign(sides[k], at[(k + 1) % 3], at[(k + 2) % 3]); };
        if (strict(0) == strict(1) && strict(1) == strict(2)) meeting.winding = strict(0);
        return meeting;
    }

  private:
    Vec2d plane_of(const Vec3d& point) const {
        const double depth = point[z_] - origin_[z_];
        return {point[x_] - origin_[x_] - shear_.x() * depth, point[y_] - origin_[y_] - shear_.y() * depth};
    }

    Vec3d origin_, shear_, inverse_;
    Eigen::Index x_, y_, z_;
    std::array<int, 3> near_, far_;  ///< among the six numbers of a box
    std::array<double, 3> entry_, exit_;
};

/// How many pairs two lists make, of which either may be one row for all.
size_t pairs_of(const char* what, const Array3d& a, const Array3d& b) {
    if (a.rows() != b.rows() && a.rows() != 1 && b.rows() != 1)
        throw ArgumentError(fmt::format("{}: expected as many rows of both, or one of either, got {} and {}",
                                        what, a.rows(), b.rows()));
    return size_t(a.rows() == 1 ? b.rows() : a.rows());
}

Vec3d paired_row(const Array3d& rows, size_t i) {
    return rows.row(rows.rows() == 1 ? 0 : Eigen::Index(i)).transpose();
}

void require_directions(const Array3d& directions) {
    geometry::require_finite("rays", directions, "directions");
    for (Eigen::Index i = 0; i < directions.rows(); ++i)
        if (directions.row(i).isZero(0))
            throw ArgumentError(fmt::format(
                "rays: expected directions other than zero, got zero in row {} of {}", i, directions.rows()));
}

/// Also of vectors whose squares are no finite numbers above 0.
Vec3d unit_of(const Vec3d& direction) {
    return (direction / direction.cwiseAbs().maxCoeff()).normalized();
}

}  // namespace

struct RayTree::Tree : geometry::TriangleTree {
    Vec3d offset;
    double extent, touch;

    explicit Tree(const MeshData& mesh) : TriangleTree(mesh), offset(mesh.offset) {
        extent = double(bounds().corners.abs().maxCoeff());
        touch = touch_part * (bounds().high() - bounds().low()).matrix().norm();
    }

    struct Found {
        double distance;
        size_t triangle = 0;
        int32_t face = -1;
        Vec3d barycentric{0, 0, 0};
    };

    Found first_met(const TreeRay& ray, double max_distance) const {
        Found found{max_distance};
        visit([&](const geometry::TreeBox& box) { return ray.entry(box); }, found.distance,
              [&](size_t i) {
                  const TreeRay::Meeting meeting = ray.meet(triangle(i));
                  if (!(meeting.distance >= 0 && meeting.distance <= found.distance) ||
                      meeting.distance == infinite)
                      return;
                  if (meeting.distance == found.distance && found.face >= 0 && original[i] > found.face)
                      return;
                  found = {meeting.distance, i, original[i], meeting.barycentric};
              });
        return found;
    }

    bool is_occluded(const Vec3d& from, const Vec3d& to) const {
        const double length = (to - from).stableNorm();
        if (!(length > 2 * touch)) return false;
        const TreeRay ray(from, unit_of(to - from), extent);
        double limit = length - touch;
        visit([&](const geometry::TreeBox& box) { return ray.entry(box); }, limit,
              [&](size_t i) {
                  const double distance = ray.meet(triangle(i)).distance;
                  if (distance > touch && distance < length - touch) limit = -1;
              });
        return limit < 0;
    }

    /// How often the surface winds around a point: along a ray, faces of both windings weighed up.
    int winding_around(const Vec3d& point) const {
        const TreeRay ray(point, Vec3d::UnitZ(), extent);
        int winding = 0;
        visit([&](const geometry::TreeBox& box) { return ray.entry(box); }, infinite,
              [&](size_t i) {
                  const TreeRay::Meeting meeting = ray.meet(triangle(i));
                  if (meeting.distance >= 0) winding += meeting.winding;
              });
        return winding;
    }

    void put(Hits& hits, size_t i, const Found& found) const {
        if (found.face < 0) {
            hits.barycentric[i] = hits.points[i] = hits.normals[i] =
                Vec3d::Constant(std::numeric_limits<double>::quiet_NaN());
            return;
        }
        const auto [a, b, c] = triangle(found.triangle);
        const Vec3d& weights = found.barycentric;
        hits.distances[i] = found.distance;
        hits.faces[i] = found.face;
        hits.barycentric[i] = weights;
        hits.points[i] = offset + (weights.x() * a + weights.y() * b + weights.z() * c);
        hits.normals[i] = (b - a).cross(c - a).normalized();
    }
};

RayTree::RayTree(const Mesh& mesh) : RayTree(flatten_shape(mesh)) {}

RayTree::RayTree(const MeshData& mesh) {
    geometry::require_faces("rays", mesh);
    require_faces(mesh.F, mesh.V.rows());
    tree_ = std::make_shared<const Tree>(mesh);
}

Eigen::Index RayTree::face_count() const {
    return Eigen::Index(tree_->triangles.size());
}

RayTree::Hits RayTree::cast(const Array3d& origins, const Array3d& directions, double max_distance) const {
    if (!(max_distance >= 0))
        throw ArgumentError(fmt::format("rays: max_distance: expected a number >= 0, got {}", max_distance));
    geometry::require_finite("rays", origins, "origins");
    require_directions(directions);
    const size_t count = pairs_of("rays: origins and directions", origins, directions);
    Hits hits{std::vector<double>(count, infinite), std::vector<int32_t>(count, -1),
              std::vector<Vec3d>(count), std::vector<Vec3d>(count), std::vector<Vec3d>(count)};
    parallel_for(count, ray_grain, [&](size_t i) {
        const TreeRay ray(paired_row(origins, i) - tree_->offset, unit_of(paired_row(directions, i)),
                          tree_->extent);
        tree_->put(hits, i, tree_->first_met(ray, max_distance));
    });
    return hits;
}

std::vector<uint8_t> RayTree::occluded(const Array3d& from, const Array3d& to) const {
    geometry::require_finite("line of sight", from);
    geometry::require_finite("line of sight", to);
    std::vector<uint8_t> result(pairs_of("line of sight: from and to", from, to));
    parallel_for(result.size(), ray_grain, [&](size_t i) {
        result[i] =
            tree_->is_occluded(paired_row(from, i) - tree_->offset, paired_row(to, i) - tree_->offset);
    });
    return result;
}

std::vector<uint8_t> RayTree::contains(const Array3d& points) const {
    geometry::require_finite("inside", points);
    std::vector<uint8_t> result(size_t(points.rows()));
    parallel_for(result.size(), ray_grain, [&](size_t i) {
        result[i] = tree_->winding_around(points.row(Eigen::Index(i)).transpose() - tree_->offset) != 0;
    });
    return result;
}

namespace {

Array3d given_positions(const MeshData& mesh) {
    return Array3d::Dense(mesh.V.cast<double>().rowwise() + mesh.offset.transpose());
}

std::vector<uint8_t> inverted(std::vector<uint8_t> flags) {
    for (uint8_t& flag : flags) flag = !flag;
    return flags;
}

/// The near plane that a view infers for a camera which it is given.
double inferred_near(const Eye& eye, const MeshData& mesh) {
    const auto corner = [](const auto& row) { return Vec3d(row.transpose().template cast<double>()); };
    const Box3d box(corner(mesh.V.colwise().minCoeff()), corner(mesh.V.colwise().maxCoeff()));
    const double middle = eye.depth(mesh.offset + box.center());
    const double half = eye.backward.cwiseAbs().dot(box.sizes()) / 2;
    return detail::near_plane(middle - half, middle > 0 ? middle : box.diagonal().norm() / 2);
}

/// Whether a camera shows a point where nothing hides it; without a size whether it is beyond the near plane.
bool is_in_view(const Camera& camera, const Eye& eye, const Vec3d& point, const std::optional<Vec2i>& size) {
    if (!(eye.depth(point) > eye.near)) return false;
    if (!size) return true;
    const Vec3d pixel = pixel_of(camera, point, *size);
    return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= size->x() && pixel.y() <= size->y();
}

}  // namespace

std::vector<uint8_t> visible_vertices(const Mesh& mesh, const Vec3d& from) {
    const MeshData whole = flatten(mesh);
    const RayTree tree(whole);
    return inverted(tree.occluded(Array3d::Dense(from.transpose()), given_positions(whole)));
}

std::vector<uint8_t> visible_vertices(const Mesh& mesh, const Camera& camera,
                                      const std::optional<Vec2i>& size, const std::optional<Vec3d>& origin,
                                      const std::optional<double>& near) {
    if (size && size->minCoeff() < 1)
        throw ArgumentError(
            fmt::format("camera: expected a picture of at least 1x1, got {}x{}", size->x(), size->y()));
    if (near) geometry::require_positive("camera: near", *near);
    MeshData whole = flatten(mesh);
    // In the camera's frame of reference from here on.
    whole.offset -= origin.value_or(offset_of_tree(mesh));
    const RayTree tree(whole);
    const Array3d to = given_positions(whole);
    Array3d::Dense from = to;
    std::vector<uint8_t> in_view(size_t(to.rows()));
    Eye eye(camera);
    eye.near = near ? *near : inferred_near(eye, whole);
    parallel_for(in_view.size(), ray_grain, [&](size_t i) {
        const Vec3d point = paired_row(to, i);
        in_view[i] = is_in_view(camera, eye, point, size);
        if (!in_view[i]) return;
        // Seen from the near plane on.
        const Vec3d towards = eye.towards(point);
        from.row(Eigen::Index(i)) =
            (point + (eye.depth(point) - eye.near) / eye.backward.dot(towards) * towards).transpose();
    });
    const std::vector<uint8_t> hidden = tree.occluded(Array3d(std::move(from)), to);
    for (size_t i = 0; i < in_view.size(); ++i) in_view[i] = in_view[i] && !hidden[i];
    return in_view;
}

}  // namespace easypbr

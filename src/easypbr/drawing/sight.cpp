#include "easypbr/drawing/sight.h"

#include <algorithm>
#include <cmath>

#include "easypbr/scene/pixel.h"

namespace easypbr::drawing {
namespace {

/// Pixels between places whose visibility is found, and how exactly a change of it is.
constexpr double step_px = 0.5, exactness_px = 1.0 / 64;

/// What a picture's border encloses on the plane at depth 1 (perspective) or on any (orthographic), in the
/// camera's frame.
Eigen::AlignedBox2d seen_box(const Camera& camera, const Vec2i& size, double margin) {
    constexpr int steps = 32;  // a lens bends the border
    const Eigen::Isometry3d T_cam_world = camera.T_world_cam.inverse();
    Eigen::AlignedBox2d box;
    for (int i = 0; i <= steps; ++i) {
        const double t = double(i) / steps;
        const double x = -margin + t * (size.x() + 2 * margin), y = -margin + t * (size.y() + 2 * margin);
        for (const Vec2d& pixel : {Vec2d(x, -margin), Vec2d(x, size.y() + margin), Vec2d(-margin, y),
                                   Vec2d(size.x() + margin, y)}) {
            const Vec3d point = T_cam_world * point_at(camera, pixel, size, 1);
            box.extend(Vec2d(point.head<2>()));
        }
    }
    return box;
}

/// The part of an edge's length in space at a part of its length in the picture: depth is linear in space,
/// its inverse in the picture.
double space_of(double t, const std::array<double, 2>& depths, bool is_perspective) {
    if (!is_perspective) return t;
    return t * depths[0] / ((1 - t) * depths[1] + t * depths[0]);
}

/// Where a predicate changes between two places that it differs at.
template <class Predicate>
double change_between(double low, double high, double exactness, const Predicate& holds) {
    const bool at_low = holds(low);
    while (high - low > exactness) {
        const double middle = (low + high) / 2;
        (holds(middle) == at_low ? low : high) = middle;
    }
    return (low + high) / 2;
}

}  // namespace

Sight::Sight(const Camera& camera, const Vec2i& size, double margin)
    : camera_(camera), size_(size), eye_(camera) {
    const Eigen::AlignedBox2d box = seen_box(camera, size, margin);
    const double slope = eye_.is_perspective ? 1 : 0, constant = 1 - slope;
    for (int axis = 0; axis < 2; ++axis) {
        const Vec3d along = Vec3d::Unit(axis);
        planes_.push_back({along + slope * box.min()[axis] * Vec3d::UnitZ(), -constant * box.min()[axis]});
        planes_.push_back({-along - slope * box.max()[axis] * Vec3d::UnitZ(), constant * box.max()[axis]});
    }
    planes_.push_back({-Vec3d::UnitZ(), -camera.near});
    if (!eye_.is_perspective) planes_.push_back({Vec3d::UnitZ(), camera.far});
}

Vec2d Sight::pixel(const Vec3d& point) const {
    return pixel_of(camera_, point, size_).head<2>();
}

Stretch Sight::clipped(const FeatureEdge& edge) const {
    const Eigen::Isometry3d T_cam_world = camera_.T_world_cam.inverse();
    const Vec3d a = T_cam_world * edge.ends[0], b = T_cam_world * edge.ends[1];
    Stretch inside;
    for (const Plane& plane : planes_) {
        const double at_a = plane.normal.dot(a) + plane.offset, at_b = plane.normal.dot(b) + plane.offset;
        if (at_a < 0 && at_b < 0) return {0, 0};
        const double crossing = at_a / (at_a - at_b);
        if (at_a < 0) inside.begin = std::max(inside.begin, crossing);
        if (at_b < 0) inside.end = std::min(inside.end, crossing);
    }
    return inside;
}

std::vector<Stretch> Sight::stretches(const FeatureEdge& edge, size_t occluder,
                                      const Occluders& occluders) const {
    const Stretch inside = clipped(edge);
    if (inside.end <= inside.begin) return {};
    const auto at = [&](double t) { return Vec3d(edge.ends[0] + t * (edge.ends[1] - edge.ends[0])); };
    const std::array<double, 2> depths{eye_.depth(at(inside.begin)), eye_.depth(at(inside.end))};
    const double length_px = (pixel(at(inside.end)) - pixel(at(inside.begin))).norm();
    const auto in_space = [&](double t) {
        return inside.begin + (inside.end - inside.begin) * space_of(t, depths, eye_.is_perspective);
    };
    const auto is_visible = [&](double t) {
        return !occluders.hide(at(in_space(t)), eye_, occluder, edge.faces);
    };
    const int count = std::max(1, int(std::ceil(length_px / step_px)));
    std::vector<Stretch> found{{inside.begin, inside.end, is_visible(0.5 / count)}};
    for (int i = 1; i < count; ++i) {
        const double here = (i + 0.5) / count;
        if (is_visible(here) == found.back().visible) continue;
        const double change = change_between(here - 1.0 / count, here, exactness_px / length_px, is_visible);
        found.back().end = in_space(change);
        found.push_back({found.back().end, inside.end, !found.back().visible});
    }
    return found;
}

}  // namespace easypbr::drawing

#include "easypbr/render/frame/shadow_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "easypbr/scene/light_falloff.h"

namespace easypbr::render {
namespace {

/// Slope of the widest perspective view.
const double widest_slope = std::tan(radians(60));
/// Texels left free at a map's border: what filters find outside of the casters must be empty.
constexpr double margin_texels = 3;
/// Nearest plane of lights inside of the casters, in diagonals of their bounds. Depths are floats, near / z,
/// so that it costs no precision.
constexpr double least_near = 1e-5;

/// Rows right, down, forward; a forward direction along an axis has the others along axes too.
Mat3d frame_along(const Vec3d& forward) {
    Eigen::Index least = 0;
    forward.cwiseAbs().minCoeff(&least);
    const Vec3d f = forward.normalized(), right = Vec3d::Unit(least).cross(f).normalized();
    Mat3d frame;
    frame << right.transpose(), f.cross(right).transpose(), f.transpose();
    return frame;
}

/// The corners of a box in a light's frame.
std::array<Vec3d, 8> corners_in(const ShadowView& view, const Box3d& box) {
    std::array<Vec3d, 8> corners;
    for (int i = 0; i < 8; ++i)
        corners[size_t(i)] = view.R_light_world * (box.corner(Box3d::CornerType(i)) - view.position);
    return corners;
}

/// Lays the map over a window of slopes (or lengths), with a margin.
void set_window(ShadowView& view, const Eigen::AlignedBox2d& window, int resolution) {
    const double least = 1e-4 * window.sizes().maxCoeff();
    for (int axis = 0; axis < 2; ++axis) {
        const double extent = std::max(window.sizes()[axis], least);
        view.scale[axis] = (1 - 2 * margin_texels / resolution) / extent;
        view.offset[axis] = 0.5 - view.scale[axis] * window.center()[axis];
    }
}

/// The slopes at which a box is seen; nothing when some of it is not in front.
std::optional<Eigen::AlignedBox2d> slopes_of(const ShadowView& view, const Box3d& box, double& nearest) {
    Eigen::AlignedBox2d window;
    nearest = std::numeric_limits<double>::infinity();
    for (const Vec3d& corner : corners_in(view, box)) {
        if (!(corner.z() > 0)) return std::nullopt;
        window.extend(Vec2d(corner.head<2>() / corner.z()));
        nearest = std::min(nearest, corner.z());
    }
    return window;
}

double distance_to(const Box3d& box, const Vec3d& point) {
    return std::sqrt(box.squaredExteriorDistance(point));
}

ShadowProjection parallel(const ResolvedLight& light, const Box3d& casters, int resolution, double behind) {
    ShadowProjection projection;
    ShadowView& view = projection.views[0];
    view.perspective = false;
    view.R_light_world = frame_along(light.direction.cast<double>());
    view.position = casters.center();
    Eigen::AlignedBox2d window;
    double farthest = 0;
    for (const Vec3d& corner : corners_in(view, casters)) {
        window.extend(Vec2d(corner.head<2>()));
        farthest = std::max(farthest, corner.z());
    }
    // A flat caster seen from its side has no thickness, but depths need a range.
    farthest = std::max(farthest * 1.0009765625, 1.0 / 1024 * casters.diagonal().norm());
    view.near = -farthest;
    view.far = farthest + behind;
    set_window(view, window, resolution);
    return projection;
}

ShadowProjection cube(const Vec3d& position, const Box3d& casters) {
    ShadowProjection projection;
    projection.count = 6;
    const double near =
        std::max(0.5 * distance_to(casters, position), least_near * casters.diagonal().norm());
    for (int face = 0; face < 6; ++face) {
        ShadowView& view = projection.views[size_t(face)];
        const int axis = face / 2;
        view.R_light_world.row(0) = Vec3d::Unit((axis + 1) % 3);
        view.R_light_world.row(1) = Vec3d::Unit((axis + 2) % 3);
        view.R_light_world.row(2) = Vec3d::Unit(axis) * (face % 2 ? -1 : 1);
        view.position = position;
        view.near = near;
        view.scale.setConstant(0.5 / cube_slope);
        view.offset.setConstant(0.5);
    }
    return projection;
}

/// One perspective view towards the casters, or along a spot; nothing when neither sees enough.
std::optional<ShadowProjection> perspective(const ResolvedLight& light, const Box3d& casters,
                                            int resolution) {
    const Vec3d& position = light.position;
    const double diagonal = casters.diagonal().norm();
    ShadowProjection projection;
    ShadowView& view = projection.views[0];
    view.position = position;
    const auto fits = [](const Eigen::AlignedBox2d& window) {
        return std::max(-window.min().minCoeff(), window.max().maxCoeff()) <= widest_slope;
    };
    double nearest = 0;
    if (light.type == LightType::spot && light.outer_cone_deg <= 60) {
        view.R_light_world = frame_along(light.direction.cast<double>());
        const double slope = std::max(std::tan(radians(light.outer_cone_deg)), 1e-4);
        Eigen::AlignedBox2d window(Vec2d(-slope, -slope), Vec2d(slope, slope));
        const auto seen = slopes_of(view, casters, nearest);
        if (seen) window = window.intersection(*seen);
        if (window.isEmpty()) return std::nullopt;
        view.near = std::max(seen ? nearest : 0.0, least_near * diagonal);
        set_window(view, window, resolution);
    } else {
        const Vec3d towards = casters.center() - position;
        if (!(towards.norm() > 0)) return std::nullopt;
        view.R_light_world = frame_along(towards);
        const auto window = slopes_of(view, casters, nearest);
        if (!window || !fits(*window)) return std::nullopt;
        view.near = std::max(nearest, least_near * diagonal);
        set_window(view, *window, resolution);
    }
    view.near *= 1 - 1.0 / 1024;
    return projection;
}

/// Generalised golden ratios: point `index` of a sequence that is evenly spread in three dimensions (Roberts
/// 2018, "The Unreasonable Effectiveness of Quasirandom Sequences").
Vec3d spread_point(int index) {
    constexpr double g = 1.22074408460575947536;
    const auto fraction = [&](double step) {
        const double x = 0.5 + (index + 1) * step;
        return x - std::floor(x);
    };
    return {fraction(1 / g), fraction(1 / (g * g)), fraction(1 / (g * g * g))};
}

/// A point of the unit ball with the density 1 / sqrt(1 - s^2) at distance s from the centre: the inverse
/// Abel transform of a disc, so that its projection along any direction is an evenly filled disc. With s =
/// sin t the distribution function is (2 t - sin 2 t) / pi.
Vec3d disc_like_point(const Vec3d& u) {
    double t = pi / 2 * std::cbrt(u.x());
    for (int i = 0; i < 8; ++i) {
        const double slope = std::max(2 - 2 * std::cos(2 * t), 1e-9);
        t = std::clamp(t - (2 * t - std::sin(2 * t) - pi * u.x()) / slope, 0.0, pi / 2);
    }
    const double z = 1 - 2 * u.y(), ring = std::sqrt(std::max(0.0, 1 - z * z)), phi = 2 * pi * u.z();
    return std::sin(t) * Vec3d(ring * std::cos(phi), ring * std::sin(phi), z);
}

}  // namespace

Mat4d ShadowView::clip_from_world() const {
    Mat4d local = Mat4d::Identity();
    local.topLeftCorner<3, 3>() = R_light_world;
    local.topRightCorner<3, 1>() = -R_light_world * position;
    Mat4d clip = Mat4d::Zero();
    const int w = perspective ? 2 : 3;
    clip(0, 0) = 2 * scale.x();
    clip(0, w) = 2 * offset.x() - 1;
    clip(1, 1) = -2 * scale.y();
    clip(1, w) = 1 - 2 * offset.y();
    if (perspective) {
        clip(2, 3) = near;
    } else {
        clip(2, 2) = -1 / (far - near);
        clip(2, 3) = far / (far - near);
    }
    clip(3, w) = 1;
    return clip * local;
}

std::optional<ShadowProjection> project_shadows(const ResolvedLight& light, const Box3d& casters,
                                                int resolution, double behind) {
    if (casters.isEmpty() || !(casters.diagonal().norm() > 0)) return std::nullopt;
    if (light.type == LightType::directional) return parallel(light, casters, resolution, behind);
    if (auto single = perspective(light, casters, resolution)) return single;
    return cube(light.position, casters);
}

unsigned needed_maps(const ShadowProjection& projection, const Box3d& receivers) {
    if (!projection.is_cube()) return 1;
    unsigned needed = 0;
    for (unsigned face = 0; face < 6; ++face) {
        const Vec3d position = projection.views[face].position;
        const Vec3d low = receivers.min() - position, high = receivers.max() - position;
        const unsigned axis = face / 2;
        // The face holds the points that are farther along its axis than along any other.
        const double farthest = face % 2 ? -low[axis] : high[axis];
        const Vec3d nearest = low.cwiseMax(-high).cwiseMax(0);
        if (farthest > 0 && farthest >= nearest[(axis + 1) % 3] && farthest >= nearest[(axis + 2) % 3])
            needed |= 1u << face;
    }
    return needed;
}

ResolvedLight sampled_light(const ResolvedLight& light, int index, int count) {
    ResolvedLight sampled = light;
    if (count <= 1) return sampled;
    if (light.type == LightType::directional) {
        const Mat3d frame = frame_along(light.direction.cast<double>());
        const Vec3d u = spread_point(index);
        const double radius = std::tan(radians(light.angular_radius_deg)) * std::sqrt(u.x());
        const Vec3d direction = frame.transpose() * Vec3d(radius * std::cos(2 * pi * u.y()),
                                                          radius * std::sin(2 * pi * u.y()), 1);
        sampled.direction = direction.cast<float>();
    } else if (light.type == LightType::rectangle || light.type == LightType::disc) {
        const EmitterAxes axes = emitter_axes(light);
        const Vec3d u = spread_point(index);
        Vec2d at(2 * u.x() - 1, 2 * u.y() - 1);
        if (light.type == LightType::disc)
            at = std::sqrt(u.x()) * Vec2d(std::cos(2 * pi * u.y()), std::sin(2 * pi * u.y()));
        sampled.position = light.position + axes.x * at.x() + axes.y * at.y();
    } else {
        sampled.position = light.position + double(light.radius) * disc_like_point(spread_point(index));
    }
    return sampled;
}

}  // namespace easypbr::render

// Shapes of revolution, and what is put together from them.
#include <algorithm>
#include <array>
#include <cmath>

#include "easypbr/geometry/primitives.h"
#include "easypbr/geometry/require.h"
#include "easypbr/geometry/revolve.h"
#include "easypbr/scene/merge.h"

namespace easypbr {

using geometry::ProfilePoint;
using geometry::require_between;
using geometry::require_positive;

namespace {

constexpr int most_segments = 8192;
const Vec2d up(0, 1), down(0, -1), outwards(1, 0);

/// Points of an arc around (radius, y) between two angles from the top, in degrees, ends included; the axis
/// is met exactly.
std::vector<ProfilePoint> arc(const Vec2d& center, double arc_radius, double from_deg, double to_deg,
                              int steps) {
    std::vector<ProfilePoint> points;
    for (int i = 0; i <= steps; ++i) {
        const double angle = radians(from_deg + (to_deg - from_deg) * i / steps);
        Vec2d normal(std::sin(angle), std::cos(angle));
        if (center.x() == 0 && std::abs(normal.x()) < 1e-12) normal = Vec2d(0, normal.y() > 0 ? 1 : -1);
        points.push_back(
            {center.x() + arc_radius * normal.x(), center.y() + arc_radius * normal.y(), normal});
    }
    return points;
}

Mesh turned(const char* name, std::vector<ProfilePoint> profile, int segments) {
    geometry::set_v_by_length(profile);
    return Mesh(geometry::revolve(name, profile, segments));
}

Vec2d slope_normal(double radius, double height) {
    return Vec2d(height, radius).normalized();
}

/// Turns the y axis to a direction, by the shortest way. Quaterniond::FromTwoVectors would do, and compile a
/// singular value decomposition for directions close to -y.
Eigen::Quaterniond turn_from_y(const Vec3d& direction) {
    const Vec3d d = direction.normalized();
    if (d.y() < -1 + 1e-12) return {0, 1, 0, 0};
    return Eigen::Quaterniond(1 + d.y(), d.z(), 0, -d.x()).normalized();
}

}  // namespace

Mesh make_sphere(float radius, int segments) {
    require_positive("sphere: radius", radius);
    require_between("sphere: segments", segments, 3, most_segments);
    const int rings = std::max(2, segments / 2);
    std::vector<ProfilePoint> profile = arc({0, 0}, radius, 0, 180, rings);
    for (int ring = 0; ring <= rings; ++ring) profile[size_t(ring)].v = 1 - double(ring) / rings;
    return Mesh(geometry::revolve("sphere", profile, segments));
}

Mesh make_cylinder(float radius, float height, int segments) {
    require_positive("cylinder: radius", radius);
    require_positive("cylinder: height", height);
    require_between("cylinder: segments", segments, 3, most_segments);
    const double r = radius, h = height / 2.0;
    return turned("cylinder",
                  {{0, h, up}, {r, h, up}, {r, h, outwards}, {r, -h, outwards}, {r, -h, down}, {0, -h, down}},
                  segments);
}

Mesh make_cone(float radius, float height, int segments) {
    require_positive("cone: radius", radius);
    require_positive("cone: height", height);
    require_between("cone: segments", segments, 3, most_segments);
    const double r = radius, h = height / 2.0;
    const Vec2d slope = slope_normal(r, height);
    return turned("cone", {{0, h, slope}, {r, -h, slope}, {r, -h, down}, {0, -h, down}}, segments);
}

Mesh make_torus(float radius, float tube_radius, int segments, int tube_segments) {
    require_positive("torus: radius", radius);
    require_positive("torus: tube radius", tube_radius);
    require_between("torus: segments", segments, 3, most_segments);
    require_between("torus: tube segments", tube_segments, 3, most_segments);
    if (tube_radius >= radius)
        throw ArgumentError(
            fmt::format("torus: expected a tube radius below the radius {}, got {}", radius, tube_radius));
    std::vector<ProfilePoint> profile = arc({radius, 0}, tube_radius, 0, 360, tube_segments);
    // The last ring is where the first one is, to the last bit.
    profile.back() = profile.front();
    for (int ring = 0; ring <= tube_segments; ++ring)
        profile[size_t(ring)].v = 1 - double(ring) / tube_segments;
    return Mesh(geometry::revolve("torus", profile, segments));
}

Mesh make_capsule(float radius, float height, int segments) {
    require_positive("capsule: radius", radius);
    require_positive("capsule: height", height);
    require_between("capsule: segments", segments, 3, most_segments);
    const int rings = std::max(1, segments / 4);
    std::vector<ProfilePoint> profile = arc({0, height / 2.0}, radius, 0, 90, rings);
    for (const ProfilePoint& point : arc({0, -height / 2.0}, radius, 90, 180, rings))
        profile.push_back(point);
    return turned("capsule", std::move(profile), segments);
}

Mesh make_arrow(const Vec3& from, const Vec3& to, std::optional<float> radius, int segments) {
    const Vec3d direction = (to - from).cast<double>();
    const double length = direction.norm();
    require_positive("arrow: length", length);
    const double r = radius ? double(*radius) : length / 40;
    require_positive("arrow: radius", r);
    require_between("arrow: segments", segments, 3, most_segments);
    const double head_radius = 2.5 * r, head = std::min(6 * r, length / 2), neck = length - head;
    const Vec2d slope = slope_normal(head_radius, head);
    const Mesh upright = turned("arrow",
                                {{0, length, slope},
                                 {head_radius, neck, slope},
                                 {head_radius, neck, down},
                                 {r, neck, down},
                                 {r, neck, outwards},
                                 {r, 0, outwards},
                                 {r, 0, down},
                                 {0, 0, down}},
                                segments);
    const Eigen::Affine3d T = Eigen::Translation3d(from.cast<double>()) * turn_from_y(direction);
    return Mesh(transformed(*upright.snapshot(), T));
}

Mesh make_axes(float length, std::optional<float> radius) {
    require_positive("axes: length", length);
    const std::array<Eigen::RowVector3f, 3> colors{
        Eigen::RowVector3f(0.85f, 0.15f, 0.15f), {0.15f, 0.65f, 0.15f}, {0.15f, 0.3f, 0.85f}};
    std::vector<MeshData> arrows;
    for (int axis = 0; axis < 3; ++axis) {
        MeshData arrow = *make_arrow(Vec3::Zero(), length * Vec3::Unit(axis), radius).snapshot();
        arrow.C = ArrayXf(colors[size_t(axis)].replicate(arrow.V.rows(), 1));
        arrow.name = std::string(1, "xyz"[axis]);
        arrows.push_back(std::move(arrow));
    }
    MeshData axes = merged(arrows);
    axes.name = "axes";
    // One material for all: the colours tell them apart.
    axes.parts.clear();
    axes.materials.assign(1, {});
    axes.materials[0].base_color.setOnes();
    return Mesh(std::move(axes));
}

}  // namespace easypbr

#include "easypbr/render/shadow/useful_casters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "easypbr/scene/light_falloff.h"

namespace easypbr::render {
namespace {

/// Large ones decide how large maps are.
constexpr size_t most_left_out = 16;
/// How far others of less than half its size may sink into what is left out, in their diagonals.
constexpr double sunken = 0.01;
/// How far others may be below its plane at most, in the diagonal of the smaller one.
constexpr double beside = 1e-3;
/// How far from the ground a caster may end that lies on it, in its diagonals.
constexpr double on_ground = 1e-3;
/// Maps of more than this part of all casters are not worth it.
constexpr double least_gain = 0.7;

double diagonal_of(const CasterExtent& caster) {
    const Box3d box = caster.drawn();
    return box.isEmpty() ? 0 : box.diagonal().norm();
}

struct Heights {
    double lowest, highest;
};

/// Of a box above a plane.
Heights heights_of(const Box3d& box, const FacePlane& plane) {
    const double middle = plane.normal.dot(box.center()) - plane.offset,
                 half = plane.normal.cwiseAbs().dot(box.sizes()) / 2;
    return {middle - half, middle + half};
}

/// All of a light that is not directional lies within a sphere of this radius around its position.
double bounding_radius(const ResolvedLight& light) {
    if (light.type != LightType::rectangle) return light.radius;
    const EmitterAxes axes = emitter_axes(light);
    return axes.x.norm() + axes.y.norm();
}

/// The angle by which all of a directional light stands above a plane, radians.
double elevation_of(const ResolvedLight& light, const FacePlane& plane) {
    const Vec3d towards = -light.direction.cast<double>().normalized();
    return std::asin(std::clamp(plane.normal.dot(towards), -1.0, 1.0)) -
           radians(double(light.angular_radius_deg));
}

/// How far above a plane the lowest point of a light is that is not directional.
double height_of(const ResolvedLight& light, const FacePlane& plane) {
    return plane.normal.dot(light.position) - plane.offset - bounding_radius(light);
}

/// Whether all of a light lies above a plane.
bool is_above(const ResolvedLight& light, const FacePlane& plane) {
    return (light.type == LightType::directional ? elevation_of(light, plane) : height_of(light, plane)) > 0;
}

/// No less than the way of light from within a box to a plane below it; infinite where there may be none.
double longest_way(const ResolvedLight& light, const Box3d& box, const FacePlane& plane) {
    const double height = std::max(heights_of(box, plane).highest, 0.0);
    if (light.type == LightType::directional) return height / std::sin(elevation_of(light, plane));
    const double above = height_of(light, plane) - height;
    if (!(above > 0)) return std::numeric_limits<double>::infinity();
    double aside = 0;  // the distance along the plane is convex: corners have the largest
    for (int i = 0; i < 8; ++i) {
        const Vec3d to = box.corner(Box3d::CornerType(i)) - light.position;
        aside = std::max(aside, (to - plane.normal * plane.normal.dot(to)).norm());
    }
    return height * std::hypot(1, (aside + bounding_radius(light)) / above);
}

/// No less than the radius of the widest penumbra of a light at this distance behind casters within a box. Of
/// the powers of two, so that maps stay while a light grows.
double widest_penumbra(const ResolvedLight& light, double extent, const Box3d& box, double distance) {
    if (!(extent > 0)) return 0;
    double part = extent;
    if (light.type != LightType::directional) {
        const double nearest = std::sqrt(box.squaredExteriorDistance(light.position));
        part = extent < nearest ? extent / nearest : 1;
    }
    return std::exp2(std::ceil(std::log2(distance * part)));
}

bool lies_on(const CasterExtent& caster, const FacePlane& plane, const FacePlane& ground) {
    if (plane.normal.dot(ground.normal) < 1 - 1e-6) return false;
    const Heights heights = heights_of(caster.box, ground);
    const double most = on_ground * diagonal_of(caster);
    return std::abs(heights.lowest) < most && std::abs(heights.highest) < most;
}

/// Whether a caster below a plane hides nothing of another one, or too little to be seen.
bool is_clear_of(const CasterExtent& other, const CasterExtent& caster, const FacePlane& plane) {
    const Box3d box = other.drawn();
    if (box.isEmpty()) return true;
    const double own = diagonal_of(caster), others = diagonal_of(other);
    const auto [lowest, highest] = heights_of(box, plane);
    const bool sinks = others < own / 2 && highest > -lowest;
    return lowest >= -(sinks ? sunken * others : beside * std::min(own, others));
}

bool is_convex(const CasterSet& casters, size_t i) {
    return std::ranges::binary_search(casters.convex, i);
}

/// Whether a caster below a plane hides the light above it from no other one.
bool hides_nothing(const CasterSet& casters, size_t i, const FacePlane& plane) {
    const auto is_clear = [&](size_t other) {
        return other == i || is_clear_of(casters.extents[other], casters.extents[i], plane);
    };
    if (!std::ranges::all_of(casters.convex, is_clear)) return false;
    if (casters.others.isEmpty() || heights_of(casters.others, plane).lowest >= 0) return true;
    for (size_t other = 0; other < casters.extents.size(); ++other)
        if (!is_convex(casters, other) && !is_clear(other)) return false;
    return true;
}

/// How wide a box looks at least along a direction, however a map is turned about it.
double least_width(const Box3d& box, const Vec3d& along) {
    double least = std::numeric_limits<double>::infinity();
    // Between these directions across, the width is concave.
    for (int i = 0; i < 3; ++i) {
        const Vec3d across = along.cross(Vec3d::Unit(i));
        const double length = across.norm();
        if (length > 1e-9 * along.norm())
            least = std::min(least, box.sizes().dot(across.cwiseAbs()) / length);
    }
    return least;
}

/// The box with room for penumbrae of light along a direction, as far as there are casters: where these end,
/// it grows to the other sides.
Box3d with_room(const Box3d& box, double penumbra, const Vec3d& along, const Box3d& all) {
    const double room = penumbra / widest_filter;
    Box3d grown = box;
    for (double side = room; side > 0; side *= 1.25) {
        const Vec3d half = (box.sizes() / 2).cwiseMax(side / 2);
        grown = Box3d(box.center() - half, box.center() + half).intersection(all);
        if (grown.contains(all) || least_width(grown, along) >= room) break;
    }
    return grown;
}

}  // namespace

Box3d CasterExtent::drawn() const {
    if (box.isEmpty()) return box;
    const Vec3d margin = Vec3d::Constant(reach);
    return Box3d(box.min() - margin, box.max() + margin);
}

CasterSet::CasterSet(std::vector<CasterExtent> casters) : extents(std::move(casters)) {
    std::vector<std::pair<double, size_t>> sizes;
    for (size_t i = 0; i < extents.size(); ++i) {
        bounds.extend(extents[i].drawn());
        reach = std::max(reach, extents[i].reach);
        if (!extents[i].planes.empty()) sizes.emplace_back(-diagonal_of(extents[i]), i);
    }
    const auto end = sizes.begin() + std::ptrdiff_t(std::min(sizes.size(), most_left_out));
    std::partial_sort(sizes.begin(), end, sizes.end());
    for (auto it = sizes.begin(); it != end; ++it) convex.push_back(it->second);
    std::ranges::sort(convex);
    for (size_t i = 0; i < extents.size(); ++i)
        if (!std::ranges::binary_search(convex, i)) others.extend(extents[i].drawn());
}

UsefulCasters useful_casters(const ResolvedLight& light, const CasterSet& casters, double extent,
                             const std::optional<FacePlane>& ground) {
    UsefulCasters found;
    std::vector<FacePlane> floors;
    Box3d rest = casters.others;
    for (const size_t i : casters.convex) {
        const CasterExtent& caster = casters.extents[i];
        const auto is_useless = [&](const FacePlane& plane) {
            return is_above(light, plane) && (!ground || lies_on(caster, plane, *ground)) &&
                   hides_nothing(casters, i, plane);
        };
        const auto plane = std::ranges::find_if(caster.planes, is_useless);
        if (plane == caster.planes.end()) {
            rest.extend(caster.drawn());
        } else {
            found.left_out.push_back(i);
            floors.push_back(*plane);
        }
    }
    const UsefulCasters all{casters.bounds, {}};
    if (found.left_out.empty() || rest.isEmpty() || !(rest.diagonal().norm() > 0)) return all;
    // All that is lit lies above each floor, so that the way behind a caster ends at the nearest one.
    double behind = casters.bounds.diagonal().norm();
    for (const FacePlane& plane : floors) behind = std::min(behind, longest_way(light, rest, plane));
    const Vec3d along = light.type == LightType::directional ? Vec3d(light.direction.cast<double>())
                                                             : Vec3d(rest.center() - light.position);
    found.bounds = with_room(rest, widest_penumbra(light, extent, rest, behind), along, casters.bounds);
    return found.bounds.diagonal().norm() < least_gain * casters.bounds.diagonal().norm() ? found : all;
}

}  // namespace easypbr::render

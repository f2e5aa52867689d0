#include "easypbr/render/shadow/useful_casters.h"

#include <algorithm>
#include <cmath>

#include "easypbr/scene/light_falloff.h"

namespace easypbr::render {
namespace {

/// Larger ones alone decide how large maps are.
constexpr size_t most_left_out = 16;
/// How far others may reach below the plane of what is left out: those of less than half its size, which sink
/// into it, in their diagonals; and all, in the diagonal of the smaller one.
constexpr double sunken = 0.01, beside = 1e-3;
/// How far from the ground a caster may end that lies on it, in diagonals of all casters.
constexpr double on_ground = 1e-3;
/// Maps of more than this part of all casters are not worth it.
constexpr double least_gain = 0.7;
/// Shadows are filtered this far around a place at most, as a part of a map:
/// shaders/common_shadow_filter.glsl.
constexpr double widest_filter = 0.15;

double diagonal(const CasterExtent& caster) {
    return caster.box.isEmpty() ? 0 : caster.box.diagonal().norm();
}

double lowest(const Box3d& box, const FacePlane& plane) {
    return plane.normal.dot(box.center()) - plane.normal.cwiseAbs().dot(box.sizes()) / 2 - plane.offset;
}

/// Whether all of a light lies above a plane.
bool is_above(const ResolvedLight& light, const FacePlane& plane) {
    if (light.type == LightType::directional) {
        const Vec3d towards = -light.direction.cast<double>().normalized();
        return plane.normal.dot(towards) > std::sin(radians(double(light.angular_radius_deg)));
    }
    double around = light.radius;
    if (light.type == LightType::rectangle) {
        const EmitterAxes axes = emitter_axes(light);
        around = axes.x.norm() + axes.y.norm();
    }
    return plane.normal.dot(light.position) - plane.offset > around;
}

bool lies_on(const CasterExtent& caster, const FacePlane& plane, const FacePlane& ground, double size) {
    if (plane.normal.dot(ground.normal) < 1 - 1e-6) return false;
    return std::abs(ground.normal.dot(caster.box.center()) - ground.offset) < on_ground * size &&
           ground.normal.cwiseAbs().dot(caster.box.sizes()) < on_ground * size;
}

/// Whether a caster below a plane hides nothing of another one, or too little to be seen.
bool is_clear_of(const CasterExtent& other, const CasterExtent& caster, const FacePlane& plane) {
    if (other.box.isEmpty()) return true;
    const double own = diagonal(caster), others = diagonal(other);
    const double depth = others < own / 2 ? sunken * others : beside * std::min(own, others);
    return lowest(other.box, plane) >= -depth;
}

/// The box with room for penumbrae, as far as there are casters.
Box3d with_room(const Box3d& box, double penumbra, const Box3d& all) {
    const Vec3d half = (box.sizes() / 2).cwiseMax(penumbra / widest_filter / 2);
    return Box3d(box.center() - half, box.center() + half).intersection(all);
}

}  // namespace

UsefulCasters useful_casters(const ResolvedLight& light, std::span<const CasterExtent> casters,
                             const Box3d& all, double penumbra, const std::optional<FacePlane>& ground) {
    std::vector<size_t> candidates;
    for (size_t i = 0; i < casters.size(); ++i)
        if (!casters[i].planes.empty()) candidates.push_back(i);
    const auto smaller = [&](size_t i) { return -diagonal(casters[i]); };
    std::ranges::stable_sort(candidates, {}, smaller);
    candidates.resize(std::min(candidates.size(), most_left_out));
    const double size = all.isEmpty() ? 0 : all.diagonal().norm();
    const auto hides_nothing = [&](size_t i, const FacePlane& plane) {
        if (!is_above(light, plane)) return false;
        if (ground && !lies_on(casters[i], plane, *ground, size)) return false;
        for (size_t other = 0; other < casters.size(); ++other)
            if (other != i && !is_clear_of(casters[other], casters[i], plane)) return false;
        return true;
    };
    UsefulCasters found{all, {}};
    for (const size_t i : candidates)
        if (std::ranges::any_of(casters[i].planes,
                                [&](const auto& plane) { return hides_nothing(i, plane); }))
            found.left_out.push_back(i);
    std::ranges::sort(found.left_out);
    Box3d rest;
    for (size_t i = 0; i < casters.size(); ++i) {
        if (casters[i].box.isEmpty() || std::ranges::binary_search(found.left_out, i)) continue;
        const Vec3d reach = Vec3d::Constant(casters[i].reach);
        rest.extend(Box3d(casters[i].box.min() - reach, casters[i].box.max() + reach));
    }
    if (found.left_out.empty() || rest.isEmpty() || !(rest.diagonal().norm() > 0)) return {all, {}};
    rest = with_room(rest, penumbra, all);
    if (!(rest.diagonal().norm() < least_gain * size)) return {all, {}};
    found.bounds = rest;
    return found;
}

}  // namespace easypbr::render

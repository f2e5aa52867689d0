// How a light's strength falls off, as shaders/common_lights.glsl has it.
#pragma once

#include <algorithm>
#include <cmath>

#include "easypbr/scene/resolved_light.h"

namespace easypbr {

/// Of an area light, world units squared; of a sphere what is seen of it from afar.
inline double emitting_area(const ResolvedLight& light) {
    if (light.type == LightType::rectangle) return double(light.size.x()) * double(light.size.y());
    return pi * double(light.radius) * double(light.radius);
}

/// Half of a rectangle's width and height as vectors; of a disc two radii at a right angle.
struct EmitterAxes {
    Vec3d x, y;
};
inline EmitterAxes emitter_axes(const ResolvedLight& light) {
    const Vec3d normal = light.direction.cast<double>().normalized();
    const auto in_plane = [&](const Vec3d& v) { return Vec3d(v - normal * normal.dot(v)); };
    Vec3d x = in_plane(light.width_axis.cast<double>());
    Eigen::Index least = 0;
    normal.cwiseAbs().minCoeff(&least);
    if (!(x.norm() > 1e-6 * light.width_axis.cast<double>().norm())) x = in_plane(Vec3d::Unit(least));
    const Vec3d y = normal.cross(x).normalized();
    if (light.type != LightType::rectangle)
        return {x.normalized() * double(light.radius), y * double(light.radius)};
    return {x.normalized() * (0.5 * double(light.size.x())), y * (0.5 * double(light.size.y()))};
}

/// What a light's intensity is multiplied by for the irradiance of a surface that faces it. `from_light` is a
/// unit vector, `distance` > 0 in world units. Point and spot lights as KHR_lights_punctual: the inverse
/// square, a smooth cone, and a window that ends the light at its range. Area lights are seen from their
/// centre as a disc of the same area; on the axis of a disc and outside of a sphere that is exact.
inline double falloff(const ResolvedLight& light, const Vec3d& from_light, double distance) {
    const double squared = distance * distance;
    if (light.type == LightType::sphere) return emitting_area(light) / squared;
    if (is_area(light.type)) {
        const double cosine = from_light.dot(light.direction.cast<double>().normalized());
        return emitting_area(light) * std::max(cosine, 0.0) / (squared + emitting_area(light) / pi);
    }
    double factor = 1 / squared;
    if (light.range > 0) factor *= std::clamp(1 - std::pow(distance / light.range, 4), 0.0, 1.0);
    if (light.type == LightType::spot) {
        const double inner = std::cos(radians(light.inner_cone_deg)),
                     outer = std::cos(radians(light.outer_cone_deg));
        const double angle = from_light.dot(light.direction.cast<double>().normalized());
        const double cone = std::clamp((angle - outer) / std::max(inner - outer, 1e-3), 0.0, 1.0);
        factor *= cone * cone;
    }
    return factor;
}

}  // namespace easypbr

// How a light's strength falls off, as shaders/common_lights.glsl has it.
#pragma once

#include <algorithm>
#include <cmath>

#include "easypbr/scene/light.h"

namespace easypbr {

/// Of KHR_lights_punctual, for point and spot lights: the inverse square, a smooth cone, and a window that
/// ends the light at its range. `from_light` is a unit vector, `distance` > 0 in world units.
inline double falloff(const LightSource& light, const Vec3d& from_light, double distance) {
    double factor = 1 / (distance * distance);
    if (light.range > 0) {
        const double window = std::clamp(1 - std::pow(distance / light.range, 4), 0.0, 1.0);
        factor *= window * window;
    }
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

#include "easypbr/scene/light.h"

#include <fmt/format.h>

#include <cmath>

#include "easypbr/core/error.h"
#include "easypbr/scene/settings.h"

namespace easypbr {
namespace {

void require(bool valid, const std::string& name, const char* member, const char* expected, float given) {
    if (!valid)
        throw ArgumentError(
            fmt::format("light '{}': {}: expected {}, got {}", name, member, expected, given));
}

void require_finite(const Vec3& v, const std::string& name, const char* member) {
    if (!v.allFinite())
        throw ArgumentError(fmt::format("light '{}': {}: expected finite numbers, got ({}, {}, {})", name,
                                        member, v.x(), v.y(), v.z()));
}

bool is_length(float v) {
    return std::isfinite(v) && v >= 0;
}

}  // namespace

bool Light::operator==(const Light&) const = default;

StudioLight studio_light(int red, int green, int blue) {
    StudioLight light;
    light.color = Vec3(float(red), float(green), float(blue)) / 255.0f;
    return light;
}

void validate(const Light& light, const std::string& name) {
    require_finite(light.position, name, "position");
    require_finite(light.direction, name, "direction");
    require_finite(light.color, name, "color");
    const bool aims = light.type != LightType::point;
    if (aims && !(light.direction.norm() > 0))
        throw ArgumentError(
            fmt::format("light '{}': direction: expected a vector with a length, got (0, 0, 0)", name));
    require(is_length(light.intensity), name, "intensity", "a finite number of at least 0", light.intensity);
    require(is_length(light.range), name, "range", "a finite number of at least 0", light.range);
    if (light.radius.value())
        require(is_length(*light.radius), name, "radius", "a finite number of at least 0", *light.radius);
    const float angle = light.angular_radius_deg;
    require(angle >= 0 && angle <= 45, name, "angular_radius_deg", "0 to 45 degrees", angle);
}

}  // namespace easypbr

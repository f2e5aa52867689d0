#include "easypbr/scene/light.h"

#include <fmt/format.h>

#include "easypbr/core/error.h"
#include "easypbr/scene/light_table.h"

namespace easypbr {

bool LightSource::operator==(const LightSource&) const = default;
bool Light::operator==(const Light&) const = default;

void validate(const Light& light, const std::string& name) {
    const std::string owner = fmt::format("light '{}': ", name);
    for (const LightField& field : light_fields()) checked(field, field.get(light), owner);
    const bool is_aimed = light.type != LightType::point && light.type != LightType::sphere;
    if (is_aimed && !(light.direction.norm() > 0))
        throw ArgumentError(owner + "direction: expected a vector with a length, got (0, 0, 0)");
    const bool is_round = light.type == LightType::disc || light.type == LightType::sphere;
    if (is_round && light.radius.value() && !(*light.radius > 0))
        throw ArgumentError(owner + "radius: expected more than 0 for a disc or a sphere, got 0");
}

}  // namespace easypbr

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
    if (light.type != LightType::point && !(light.direction.norm() > 0))
        throw ArgumentError(owner + "direction: expected a vector with a length, got (0, 0, 0)");
}

}  // namespace easypbr

// The one table of what a light is made of: fields with documentation, unit and range.
#pragma once

#include <array>
#include <vector>

#include "easypbr/scene/fields.h"
#include "easypbr/scene/light.h"

namespace easypbr {

/// Its name is that of the member, of the attribute in Python and of the key in a settings file.
struct LightField : FieldOf<Light> {
    std::array<bool, 6> types{true, true, true,
                              true, true, true};  ///< for each LightType whether it means something
    bool is_color = false;                        ///< the vector is a linear colour

    bool concerns(LightType type) const { return types[size_t(type)]; }
};

/// Every member of Light, in the order of its declaration.
const std::vector<LightField>& light_fields();

}  // namespace easypbr

#include "easypbr/scene/light_table.h"

#include "easypbr/scene/field_builder.h"

namespace easypbr {
namespace detail {

template <>
const std::vector<std::string>& enum_names<LightType>() {
    static const std::vector<std::string> names = {"point", "directional", "spot"};
    return names;
}

namespace {

constexpr std::array<bool, 3> any{true, true, true}, placed{true, false, true}, aimed{false, true, true},
    spot{false, false, true}, directional{false, true, false};

template <class Member>
LightField row(const char* name, Member member, const char* doc, const std::array<bool, 3>& types = any,
               const char* unit = "", Range range = {}) {
    return {make<Light>(name, at(member), doc, unit, range), types};
}

LightField colored(LightField field) {
    field.is_color = true;
    return field;
}

std::vector<LightField> all_rows() {
    const Range from_zero{0, unlimited};
    return {
        row("type", &Light::type, "Point, directional or spot."),
        row("enabled", &Light::enabled, "Whether it shines."),
        row("position", &Light::position, "Point and spot.", placed, "world units"),
        row("direction", &Light::direction, "Where the light goes; directional and spot.", aimed),
        colored(row("color", &Light::color, "Multiplies the intensity.")),
        row("intensity", &Light::intensity, "Candela (point, spot) or lux (directional).", any, "",
            from_zero),
        row("inner_cone_deg", &Light::inner_cone_deg, "Half angle of a spot's full-intensity cone.", spot,
            "degrees"),
        row("outer_cone_deg", &Light::outer_cone_deg, "Half angle at which a spot ends.", spot, "degrees"),
        row("range", &Light::range, "Distance at which the light ends; 0: unlimited.", placed, "world units",
            from_zero),
        row("casts_shadows", &Light::casts_shadows, "Whether anything casts a shadow in this light."),
        row("radius", &Light::radius,
            "Of the glowing sphere of a point or spot light: what softens its shadows. Automatic: a "
            "twentieth of the content's radius.",
            placed, "world units", from_zero),
        row("angular_radius_deg", &Light::angular_radius_deg,
            "Directional: half the angle under which the light is seen; by default the sun's.", directional,
            "degrees", {0, 45})};
}

}  // namespace
}  // namespace detail

const std::vector<LightField>& light_fields() {
    static const std::vector<LightField> rows = detail::all_rows();
    return rows;
}

}  // namespace easypbr

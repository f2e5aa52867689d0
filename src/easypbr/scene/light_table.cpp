#include "easypbr/scene/light_table.h"

#include "easypbr/scene/field_builder.h"

namespace easypbr {
namespace detail {

template <>
const std::vector<std::string>& enum_names<LightType>() {
    static const std::vector<std::string> names = {"point",     "directional", "spot",
                                                   "rectangle", "disc",        "sphere"};
    return names;
}

namespace {

using Types = std::array<bool, 6>;
constexpr Types any{true, true, true, true, true, true}, placed{true, false, true, true, true, true},
    aimed{false, true, true, true, true, false}, punctual{true, false, true},
    round{true, false, true, false, true, true}, spot{false, false, true}, directional{false, true, false},
    rectangle{false, false, false, true};

template <class Member>
LightField row(const char* name, Member member, const char* doc, const Types& types = any,
               const char* unit = "", Range range = {}) {
    LightField field;
    make(
        field, name, [member](auto& light) -> auto& { return light.*member; }, doc, unit, range);
    field.types = types;
    return field;
}

LightField colored(LightField field) {
    field.is_color = true;
    return field;
}

std::vector<LightField> all_rows() {
    const Range from_zero{0, unlimited};
    return {
        row("type", &Light::type, "Point, directional, spot, rectangle, disc or sphere."),
        row("enabled", &Light::enabled, "Enables the light."),
        row("position", &Light::position,
            "Position in world space, of area lights the centre; all but directional.", placed,
            "world units"),
        row("direction", &Light::direction,
            "Direction of propagation, of rectangle and disc the normal of the side that emits; all but "
            "point and sphere.",
            aimed),
        colored(row("color", &Light::color, "Colour, multiplies the intensity.")),
        row("intensity", &Light::intensity,
            "Candela (point, spot), lux (directional) or cd/m2 (rectangle, disc, sphere).", any, "",
            from_zero),
        row("inner_cone_deg", &Light::inner_cone_deg, "Spot: half angle of full intensity.", spot, "degrees"),
        row("outer_cone_deg", &Light::outer_cone_deg, "Spot: half angle of zero intensity.", spot, "degrees"),
        row("range", &Light::range, "Point and spot: distance of zero intensity; 0: unlimited.", punctual,
            "world units", from_zero),
        row("size", &Light::size, "Rectangle: width and height.", rectangle, "world units",
            {positive, unlimited}),
        row("width_axis", &Light::width_axis, "Rectangle: direction of its width, projected onto its plane.",
            rectangle),
        row("casts_shadows", &Light::casts_shadows, "Enables the shadows of this light."),
        row("radius", &Light::radius,
            "Point and spot: radius of the spherical emitter, which sets the size of penumbrae. Disc and "
            "sphere: radius of the light. Automatic: 0.05 of the content's radius; of points and spots "
            "half of the distance to the nearest surface at most.",
            round, "world units", from_zero),
        row("angular_radius_deg", &Light::angular_radius_deg,
            "Directional: angular radius of the emitter; default: that of the sun.", directional, "degrees",
            {0, 45})};
}

}  // namespace
}  // namespace detail

const std::vector<LightField>& light_fields() {
    static const std::vector<LightField> rows = detail::all_rows();
    return rows;
}

}  // namespace easypbr

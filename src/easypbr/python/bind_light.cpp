// Light: point, directional or spot.
#include <fmt/format.h>

#include "easypbr/core/error.h"
#include "easypbr/core/suggest.h"
#include "easypbr/python/convert.h"
#include "easypbr/python/settings_value.h"
#include "easypbr/python/text.h"
#include "easypbr/scene/light.h"

namespace easypbr::python {
namespace {

const std::vector<std::string> type_names = {"point", "directional", "spot"};

void set_type(Light& light, const std::string& name) {
    const auto found = std::find(type_names.begin(), type_names.end(), name);
    if (found == type_names.end())
        throw ArgumentError(fmt::format("light.type: expected point, directional or spot, got '{}'{}", name,
                                        did_you_mean(name, type_names)));
    light.type = LightType(found - type_names.begin());
}

void vector_property(nb::class_<Light>& light, const char* name, Vec3 Light::*member, const char* doc) {
    light.def_prop_rw(
        name, [member](const Light& l) { return vector_to_tuple(l.*member); },
        [member, name](Light& l, const ArrayLike& value) {
            l.*member = to_vector3(value, name).cast<float>();
        },
        doc);
}

void check_length(const char* name, float value) {
    if (!(value >= 0 && std::isfinite(value)))
        throw ArgumentError(fmt::format("light.{}: expected a number of at least 0, got {}", name, value));
}

void light_number(nb::class_<Light>& light, const char* name, float Light::*member, const char* doc) {
    light.def_prop_rw(
        name, [member](const Light& l) { return l.*member; },
        [member, name](Light& l, float value) {
            check_length(name, value);
            l.*member = value;
        },
        doc);
}

nb::object get_radius(const Light& light) {
    if (light.radius.is_follow()) return nb::cast(Follow{});
    if (light.radius.is_pinned()) return nb::cast(*light.radius);
    return nb::cast(light.radius.value() ? Automatic{Value::Data(double(*light.radius))} : Automatic{});
}

void set_radius(Light& light, nb::handle value) {
    if (nb::isinstance<Automatic>(value)) {
        light.radius = automatic;
    } else if (nb::isinstance<Follow>(value)) {
        light.radius = follow;
    } else {
        float radius = 0;
        if (!nb::try_cast(value, radius))
            throw ArgumentError(
                fmt::format("light.radius: expected a number of at least 0, auto or follow, got {}",
                            nb::cast<std::string>(nb::repr(value))));
        check_length("radius", radius);
        light.radius = radius;
    }
}

void construct_light(Light* self, const std::string& type, const nb::kwargs& values) {
    Light light;
    set_type(light, type);
    // Python owns the object: an AttributeError holds on to it.
    nb::object object = nb::cast(light);
    for (auto [name, value] : values) nb::setattr(object, name, value);
    new (self) Light(nb::cast<const Light&>(object));
}

}  // namespace

void bind_light(nb::module_& module) {
    nb::class_<Light> light(
        module, "Light",
        "A light in world space. Its colour is given as linear numbers, or as text ('#rrggbb', sRGB).");
    light
        .def("__init__", construct_light, nb::arg("type") = "point", nb::arg("values"),
             nb::sig("def __init__(self, type: str = 'point', **values: object) -> None"))
        .def_prop_rw(
            "type", [](const Light& l) { return type_names[size_t(l.type)]; }, set_type,
            "'point', 'directional' or 'spot'.")
        .def_rw("enabled", &Light::enabled)
        .def_prop_rw(
            "color", [](const Light& l) { return vector_to_tuple(l.color); },
            [](Light& l, const ColorLike& value) { l.color = to_linear_color(value, "light.color"); },
            "Colour, multiplies the intensity.");
    vector_property(light, "position", &Light::position, "Position in world space; point and spot.");
    vector_property(light, "direction", &Light::direction, "Direction of propagation; directional and spot.");
    light_number(light, "intensity", &Light::intensity, "Candela (point, spot) or lux (directional).");
    light_number(light, "inner_cone_deg", &Light::inner_cone_deg,
                    "Spot: half angle of full intensity, degrees.");
    light_number(light, "outer_cone_deg", &Light::outer_cone_deg,
                    "Spot: half angle of zero intensity, degrees.");
    light.def_rw("casts_shadows", &Light::casts_shadows, "Enables the shadows of this light.")
        .def_prop_rw(
            "radius", get_radius, [](Light& l, const nb::object& value) { set_radius(l, value); },
            nb::for_getter(nb::sig("def radius(self) -> float | Automatic | Follow")),
            nb::for_setter(nb::sig("def radius(self, value: float | Automatic | Follow) -> None")),
            "Point and spot: radius of the spherical emitter in world units, which sets the size of "
            "penumbrae. Automatic: 0.05 of the content's radius.");
    light_number(light, "angular_radius_deg", &Light::angular_radius_deg,
                    "Directional: angular radius of the emitter in degrees; default: that of the sun.");
    light_number(light, "range", &Light::range, "Distance of zero intensity, world units; 0: unlimited.");
}

}  // namespace easypbr::python

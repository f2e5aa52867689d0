// Light: point, directional, spot, rectangle, disc or sphere.
#include <fmt/format.h>

#include "easypbr/python/convert.h"
#include "easypbr/python/pickle.h"
#include "easypbr/python/settings_value.h"
#include "easypbr/python/text.h"
#include "easypbr/scene/light_table.h"

namespace easypbr::python {
namespace {

const LightField& type_field() {
    return light_fields().front();
}

void put_field(Light& light, const LightField& field, const Value& value) {
    field.put(light, checked(field, value, "light."));
}

template <class Data>
Data light_data(const Light& light, const LightField& field) {
    return std::get<Data>(field.get(light).data);
}

void vector_property(nb::class_<Light>& light, const LightField& field) {
    light.def_prop_rw(
        field.name.c_str(),
        [&field](const Light& l) { return nb::tuple(value_to_python(field, field.get(l))); },
        [&field](Light& l, const ArrayLike& value) {
            if (field.sizes != std::vector<size_t>{3})
                return put_field(l, field, value_from_python(field, value));
            const Vec3d v = to_vector3(value, field.name.c_str());
            put_field(l, field, {std::vector<double>{v.x(), v.y(), v.z()}});
        },
        field.doc.c_str());
}

void light_color_property(nb::class_<Light>& light, const LightField& field) {
    light.def_prop_rw(
        field.name.c_str(),
        [&field](const Light& l) { return nb::tuple(value_to_python(field, field.get(l))); },
        [&field](Light& l, const ColorLike& value) {
            const Vec3d v = to_linear_color(value, ("light." + field.name).c_str()).cast<double>();
            put_field(l, field, {std::vector<double>{v.x(), v.y(), v.z()}});
        },
        field.doc.c_str());
}

/// Of a boolean, a number or a text.
template <class T>
void plain_property(nb::class_<Light>& light, const LightField& field) {
    light.def_prop_rw(
        field.name.c_str(), [&field](const Light& l) { return light_data<T>(l, field); },
        [&field](Light& l, const T& value) { put_field(l, field, {value}); }, field.doc.c_str());
}

void automatic_property(nb::class_<Light>& light, const LightField& field) {
    const std::string getter = fmt::format("def {}(self) -> float | Automatic | Follow", field.name);
    const std::string setter =
        fmt::format("def {}(self, value: float | Automatic | Follow) -> None", field.name);
    light.def_prop_rw(
        field.name.c_str(), [&field](const Light& l) { return value_to_python(field, field.get(l)); },
        [&field](Light& l, const nb::object& value) { put_field(l, field, value_from_python(field, value)); },
        nb::for_getter(nb::sig(getter.c_str())), nb::for_setter(nb::sig(setter.c_str())), field.doc.c_str());
}

void light_property(nb::class_<Light>& light, const LightField& field) {
    if (field.can_be_automatic) return automatic_property(light, field);
    if (field.is_color) return light_color_property(light, field);
    if (field.type == FieldType::vector) return vector_property(light, field);
    if (field.type == FieldType::boolean) return plain_property<bool>(light, field);
    if (field.type == FieldType::number) return plain_property<double>(light, field);
    plain_property<std::string>(light, field);
}

void construct_light(Light* self, const std::string& type, const nb::kwargs& values) {
    Light light;
    put_field(light, type_field(), {type});
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
    light.def("__init__", construct_light, nb::arg("type") = "point", nb::arg("values"),
              nb::sig("def __init__(self, type: str = 'point', **values: object) -> None"));
    for (const LightField& field : light_fields()) light_property(light, field);
    bind_copies(light, [](const Light& l) { return l; });
    bind_pickle(light);
}

}  // namespace easypbr::python

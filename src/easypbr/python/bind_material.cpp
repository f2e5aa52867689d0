// Material and Style: values of their own, or those of a mesh, whose changes then go through.
#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "easypbr/core/error.h"
#include "easypbr/io/image_io.h"
#include "easypbr/python/convert.h"
#include "easypbr/python/handles.h"
#include "easypbr/python/settings_value.h"
#include "easypbr/scene/fields.h"

namespace easypbr::python {
namespace {

using MaterialClass = nb::class_<MaterialHandle>;

template <class Member>
void number_property(MaterialClass& material, const char* name, Member Material::*member, float max,
                     const char* doc) {
    material.def_prop_rw(
        name, [member](const MaterialHandle& m) { return m.get().*member; },
        [member, max, name](MaterialHandle& m, float value) {
            if (!(value >= 0 && value <= max))
                throw ArgumentError(
                    max < 1e30f ? fmt::format("material.{}: expected 0 to {}, got {}", name, max, value)
                                : fmt::format("material.{}: expected at least 0, got {}", name, value));
            m.change([&](Material& material) { material.*member = value; });
        },
        doc);
}

void flag_property(MaterialClass& material, const char* name, bool Material::*member, const char* doc) {
    material.def_prop_rw(
        name, [member](const MaterialHandle& m) { return m.get().*member; },
        [member](MaterialHandle& m, bool value) { m.change([&](Material& own) { own.*member = value; }); },
        doc);
}

void color_property(MaterialClass& material, const char* name, Vec3 Material::*member, const char* doc) {
    material.def_prop_rw(
        name, [member](const MaterialHandle& m) { return vector_to_tuple(m.get().*member); },
        [member, name](MaterialHandle& m, const ColorLike& value) {
            const Vec3 color = to_linear_color(value, name);
            m.change([&](Material& own) { own.*member = color; });
        },
        doc);
}

Texture texture_from_python(nb::handle object, const char* name) {
    Texture texture;
    if (object.is_none()) return texture;
    if (is_path(object)) {
        const auto path = nb::cast<std::filesystem::path>(object);
        texture.path = path.string();
        texture.image = released([&] { return std::make_shared<const Image>(io::load_image(path)); });
    } else {
        texture.image = std::make_shared<const Image>(to_image(object, name));
    }
    return texture;
}

void texture_property(MaterialClass& material, const char* name, Texture Material::*member, const char* doc) {
    material.def_prop_rw(
        name,
        [member](const MaterialHandle& m) {
            const Texture texture = m.get().*member;
            return texture ? to_numpy(texture.image) : nb::none();
        },
        [member, name](MaterialHandle& m, const PathOrArray& value) {
            const Texture texture = texture_from_python(value, name);
            m.change([&](Material& own) { own.*member = texture; });
        },
        nb::for_setter(nb::arg("value").none()), doc);
}

void set_alpha_mode(MaterialHandle& m, const std::string& mode) {
    if (mode != "opaque" && mode != "mask" && mode != "blend")
        throw ArgumentError(
            fmt::format("material.alpha_mode: expected opaque, mask or blend, got '{}'", mode));
    m.change([&](Material& own) {
        own.alpha_mode = mode == "opaque" ? AlphaMode::opaque
                         : mode == "mask" ? AlphaMode::mask
                                          : AlphaMode::blend;
    });
}

const char* alpha_mode(const MaterialHandle& m) {
    const AlphaMode mode = m.get().alpha_mode;
    return mode == AlphaMode::opaque ? "opaque" : mode == AlphaMode::mask ? "mask" : "blend";
}

/// Keyword arguments are assignments to attributes; a misspelt one is an AttributeError.
template <class Handle>
void construct(Handle* self, const nb::kwargs& values) {
    // Python owns the object: an AttributeError holds on to it.
    nb::object object = nb::cast(Handle());
    for (auto [name, value] : values) nb::setattr(object, name, value);
    new (self) Handle(nb::cast<const Handle&>(object));
}

void bind_textures(MaterialClass& material) {
    texture_property(material, "base_color_texture", &Material::base_color_texture,
                     "Assign a path or an array; its alpha multiplies opacity. Reads as an array, or None.");
    texture_property(material, "metallic_texture", &Material::metallic_texture, "Its first channel is read.");
    texture_property(material, "roughness_texture", &Material::roughness_texture,
                     "Its first channel is read.");
    texture_property(material, "normal_texture", &Material::normal_texture, "Tangent space, +Y up.");
    texture_property(material, "occlusion_texture", &Material::occlusion_texture,
                     "Its first channel is read.");
    texture_property(material, "emissive_texture", &Material::emissive_texture, "Colour of the glow.");
    texture_property(material, "opacity_texture", &Material::opacity_texture, "Used by alpha mode mask.");
}

void bind_style(nb::module_& module) {
    nb::class_<StyleHandle> style(module, "Style",
                                  "How a mesh is drawn; `auto` where it follows from the data.");
    style.def("__init__", construct<StyleHandle>, nb::sig("def __init__(self, **values: object) -> None"));
    const std::string prefix = "style.";
    for (const Field& field : fields()) {
        if (!field.name.starts_with(prefix)) continue;
        const std::string name = field.name.substr(prefix.size());
        style.def_prop_rw(
            name.c_str(),
            [&field, name](const StyleHandle& s) {
                return value_to_python(field, easypbr::get(s.get(), name));
            },
            [&field, name](StyleHandle& s, const nb::object& object) {
                const Value value = checked(field, value_from_python(field, object));
                s.change([&](Style& own) { set(own, name, value); });
            },
            nb::for_getter(nb::sig(fmt::format("def {}(self) -> object", name).c_str())),
            nb::for_setter(nb::sig(fmt::format("def {}(self, value: object) -> None", name).c_str())),
            nb::for_setter(nb::arg("value").none()), field.doc.c_str());
    }
}

}  // namespace

void bind_material(nb::module_& module) {
    MaterialClass material(
        module, "Material",
        "glTF 2.0's metallic-roughness model. Colours are linear numbers, or text ('#rrggbb', sRGB).");
    material.def("__init__", construct<MaterialHandle>,
                 nb::sig("def __init__(self, **values: object) -> None"));
    material.def_prop_rw(
        "name", [](const MaterialHandle& m) { return m.get().name; },
        [](MaterialHandle& m, const std::string& name) {
            m.change([&](Material& own) { own.name = name; });
        });
    constexpr float unlimited = 3e38f;
    color_property(material, "base_color", &Material::base_color, "Linear colour.");
    color_property(material, "emissive", &Material::emissive, "Linear radiance that the surface glows in.");
    number_property(material, "opacity", &Material::opacity, 1, "0 clear to 1 opaque.");
    number_property(material, "metallic", &Material::metallic, 1, "0 dielectric to 1 metal.");
    number_property(material, "roughness", &Material::roughness, 1, "Perceptual, 0 to 1.");
    number_property(material, "normal_scale", &Material::normal_scale, unlimited,
                    "Strength of the normal texture.");
    number_property(material, "occlusion_strength", &Material::occlusion_strength, 1,
                    "Strength of the occlusion texture.");
    number_property(material, "alpha_cutoff", &Material::alpha_cutoff, 1,
                    "Alpha mode mask: drawn from this alpha on.");
    flag_property(material, "double_sided", &Material::double_sided, "Back faces are drawn too.");
    flag_property(material, "unlit", &Material::unlit, "The base colour is shown as it is.");
    material.def_prop_rw("alpha_mode", alpha_mode, set_alpha_mode, "'opaque', 'mask' or 'blend'.");
    bind_textures(material);
    bind_style(module);
}

}  // namespace easypbr::python

// Material and Style: values of their own, or those of a mesh, whose changes then go through.
#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/vector.h>

#include "easypbr/core/ascii.h"
#include "easypbr/core/error.h"
#include "easypbr/io/image/texture_loader.h"
#include "easypbr/python/convert.h"
#include "easypbr/python/handles.h"
#include "easypbr/python/pickle.h"
#include "easypbr/python/settings_value.h"
#include "easypbr/python/text.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/material_table.h"

namespace easypbr::python {
namespace {

using MaterialClass = nb::class_<MaterialHandle>;

void number_property(MaterialClass& material, const MaterialNumber& number) {
    material.def_prop_rw(
        number.name, [&number](const MaterialHandle& m) { return m.get().*number.value; },
        [&number](MaterialHandle& m, float value) {
            m.change([&](Material& material) { material.*number.value = value; });
        },
        number.doc);
}

void flag_property(MaterialClass& material, const char* name, bool Material::*member, const char* doc) {
    material.def_prop_rw(
        name, [member](const MaterialHandle& m) { return m.get().*member; },
        [member](MaterialHandle& m, bool value) { m.change([&](Material& own) { own.*member = value; }); },
        doc);
}

void color_property(MaterialClass& material, const MaterialColor& color) {
    material.def_prop_rw(
        color.name, [&color](const MaterialHandle& m) { return vector_to_tuple(m.get().*color.value); },
        [&color](MaterialHandle& m, const ColorLike& value) {
            const Vec3 linear = to_linear_color(value, color.name);
            // The library takes what files have; 255 is a mistake.
            if (color.value == &Material::base_color && (linear.array() > 1).any())
                throw ArgumentError(
                    fmt::format("material.base_color: expected a colour: {}, got ({}, {}, {})", color_forms,
                                linear.x(), linear.y(), linear.z()));
            m.change([&](Material& own) { own.*color.value = linear; });
        },
        color.doc);
}

Texture texture_from_python(nb::handle object, const char* name) {
    Texture texture;
    if (object.is_none()) return texture;
    if (is_path(object)) {
        const auto path = nb::cast<std::filesystem::path>(object);
        texture = released([&] { return io::load_texture(path); });
    } else {
        texture.image = std::make_shared<const Image>(to_image(object, name));
    }
    return texture;
}

void texture_property(MaterialClass& material, const MaterialTexture& use) {
    const std::string name = std::string(use.name) + "_texture";
    material.def_prop_rw(
        name.c_str(),
        [&use](const MaterialHandle& m) {
            const Texture texture = m.get().*use.texture;
            return texture ? to_numpy(texture.image) : nb::none();
        },
        [&use, name](MaterialHandle& m, const PathOrArray& value) {
            const Texture texture = texture_from_python(value, name.c_str());
            m.change([&](Material& own) { own.*use.texture = texture; });
        },
        nb::for_setter(nb::arg("value").none()),
        fmt::format("Assign a path or an array; reads as an array, or None. {}{}", use.doc,
                    use.use == TexelUse::color ? " Integers are sRGB; floats are linear and clamped to 1."
                                               : " Texels of floats are 0 to 1.")
            .c_str());
}

void set_alpha_mode(MaterialHandle& m, const std::string& mode) {
    using Choice = std::pair<const char*, decltype(Material::alpha_mode)>;
    const Choice choices[] = {{"auto", automatic},
                              {"opaque", AlphaMode::opaque},
                              {"mask", AlphaMode::mask},
                              {"blend", AlphaMode::blend}};
    for (const Choice& choice : choices)
        if (ascii::same_letters(choice.first, mode))
            return m.change([&](Material& own) { own.alpha_mode = choice.second; });
    throw ArgumentError(
        fmt::format("material.alpha_mode: expected auto, opaque, mask or blend, got '{}'", mode));
}

const char* alpha_mode(const MaterialHandle& m) {
    const std::optional<AlphaMode> mode = m.get().alpha_mode.value();
    return !mode                        ? "auto"
           : *mode == AlphaMode::opaque ? "opaque"
           : *mode == AlphaMode::mask   ? "mask"
                                        : "blend";
}

nb::object shader(const MaterialHandle& m) {
    const SurfaceShader own = m.get().shader;
    if (!own) return nb::none();
    return own.path.empty() ? nb::cast(own.text) : nb::cast(std::filesystem::path(own.path));
}

void set_shader(MaterialHandle& m, nb::handle object) {
    SurfaceShader own;
    if (nb::isinstance<nb::str>(object))
        own.text = nb::cast<std::string>(object);
    else if (is_path(object))
        own.path = std::filesystem::absolute(nb::cast<std::filesystem::path>(object)).string();
    else if (!object.is_none())
        throw ArgumentError("material.shader: expected GLSL as text, the path of a file or None");
    if (!own && !object.is_none())
        throw ArgumentError("material.shader: the text is empty; None takes a shader away");
    m.change([&](Material& material) { material.shader = own; });
}

/// Keyword arguments are assignments to attributes; a misspelt one is an AttributeError.
template <class Handle>
void construct_material(Handle* self, const nb::kwargs& values) {
    // Python owns the object: an AttributeError holds on to it.
    nb::object object = nb::cast(Handle());
    for (auto [name, value] : values) nb::setattr(object, name, value);
    new (self) Handle(nb::cast<const Handle&>(object));
}

/// What is not automatic, as arguments.
std::string style_text(nb::handle style) {
    const std::string prefix = "style.";
    std::string text;
    for (const Field& field : fields()) {
        if (!field.name.starts_with(prefix)) continue;
        const std::string name = field.name.substr(prefix.size());
        const std::string value = nb::cast<std::string>(nb::repr(style.attr(name.c_str())));
        if (value != "auto") text += fmt::format("{}{}={}", text.empty() ? "" : ", ", name, value);
    }
    return "Style(" + text + ")";
}

void bind_style(nb::module_& module) {
    nb::class_<StyleHandle> style(module, "Style", "Style of a mesh; `auto` values follow from the data.");
    style.def("__init__", construct_material<StyleHandle>,
              nb::sig("def __init__(self, **values: object) -> None"));
    style.def("__repr__", style_text);
    bind_copies(style, [](const StyleHandle& s) { return StyleHandle{{}, s.get()}; });
    bind_pickle(style);
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
    MaterialClass material(module, "Material",
                           "The metallic-roughness model of glTF 2.0 and its extensions. Colours are given "
                           "as linear numbers, or as text ('#rrggbb', sRGB).");
    material.def("__init__", construct_material<MaterialHandle>,
                 nb::sig("def __init__(self, **values: object) -> None"));
    bind_copies(material, [](const MaterialHandle& m) { return MaterialHandle{{}, 0, m.get()}; });
    bind_pickle(material);
    material.def_prop_rw(
        "name", [](const MaterialHandle& m) { return m.get().name; },
        [](MaterialHandle& m, const std::string& name) {
            m.change([&](Material& own) { own.name = name; });
        });
    for (const MaterialColor& color : material_colors()) color_property(material, color);
    for (const MaterialNumber& number : material_numbers()) number_property(material, number);
    for (const MaterialTexture& use : material_textures()) texture_property(material, use);
    flag_property(material, "double_sided", &Material::double_sided,
                  "Draws back faces, with the normal towards the viewer.");
    flag_property(material, "unlit", &Material::unlit, "Shows the base colour without lighting.");
    material.def_prop_rw(
        "alpha_mode", alpha_mode, set_alpha_mode,
        "'opaque', 'mask', 'blend', or 'auto': blend if the opacity or the alpha of a vertex is below 1.");
    material.def_prop_rw(
        "shader", shader, set_shader, nb::for_getter(nb::sig("def shader(self) -> str | os.PathLike | None")),
        nb::for_setter(nb::sig("def shader(self, value: str | os.PathLike | None) -> None")),
        nb::for_setter(nb::arg("value").none()),
        "Surface shader, GLSL with a function `void surface(inout Surface s)`: text, or the path of a file "
        "(pathlib.Path), which is reloaded when it changes. None: no shader.");
    bind_style(module);
}

}  // namespace easypbr::python

// LabelMap, and a mesh's labels and scalars.
#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include "easypbr/core/ascii.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/io/settings/label_map_io.h"
#include "easypbr/python/colormap.h"
#include "easypbr/python/convert.h"
#include "easypbr/python/handles.h"
#include "easypbr/python/text.h"
#include "easypbr/scene/colormap.h"
#include "easypbr/scene/label_colors.h"

namespace easypbr::python {
namespace {

/// One colour per class: '#rrggbb' or names, or n x 3 numbers as Mesh.C takes them.
class ColorsLike : public nb::object {
    NB_OBJECT_DEFAULT(ColorsLike, nb::object, "Sequence[str] | numpy.typing.ArrayLike | None", is_anything)
};
class NamesLike : public nb::object {
    NB_OBJECT_DEFAULT(NamesLike, nb::object, "Sequence[str] | Mapping[int, str]", is_anything)
};

/// Throws ArgumentError that says what was expected.
template <class T>
T taken(nb::handle object, std::string_view what, std::string_view expected) {
    T value{};
    if (!nb::try_cast(object, value))
        throw ArgumentError(fmt::format("LabelMap {}: expected {}, got {}", what, expected,
                                        nb::cast<std::string>(nb::repr(object))));
    return value;
}

std::vector<Rgb8> colors_of_array(nb::handle object) {
    const nb::object array = numeric_object(object, "LabelMap colors");
    const AnyArray shape = nb::cast<AnyArray>(array);
    if (shape.ndim() != 2 || shape.shape(1) != 3)
        throw ArgumentError(
            fmt::format("LabelMap colors: expected texts or an n x 3 array, got {}", shape_text(shape)));
    const ArrayXf numbers = to_colors(array, {"colors", 3, 3, "LabelMap"});
    if (!numbers.allFinite()) throw ArgumentError("LabelMap colors: expected finite numbers, got NaN");
    std::vector<Rgb8> colors;
    for (Eigen::Index i = 0; i < numbers.rows(); ++i)
        colors.push_back(to_rgb8(Vec3(numbers.row(i).transpose())));
    return colors;
}

std::vector<Rgb8> colors_from(nb::handle object) {
    std::vector<Rgb8> colors;
    const bool texts = nb::isinstance<nb::sequence>(object) && nb::len(object) > 0 &&
                       nb::isinstance<nb::str>(nb::object(object[0]));
    if (!texts) return colors_of_array(object);
    for (nb::handle text : object)
        colors.push_back(to_rgb8(parse_color(taken<std::string>(text, "colors", "texts"))));
    return colors;
}

std::vector<LabelClass> classes_from(nb::handle names, const std::optional<std::vector<int32_t>>& labels) {
    std::vector<LabelClass> classes;
    if (nb::isinstance<nb::dict>(names)) {
        if (labels) throw ArgumentError("LabelMap: expected names as a list beside labels, got a dict");
        for (auto [label, name] : nb::cast<nb::dict>(names))
            classes.push_back({taken<int32_t>(label, "names", "labels of 32 bits as keys"),
                               taken<std::string>(name, "names", "texts"),
                               {}});
    } else {
        for (const std::string& name : taken<std::vector<std::string>>(names, "names", "a list of texts")) {
            const size_t i = classes.size();
            classes.push_back({labels && i < labels->size() ? (*labels)[i] : int32_t(i), name, {}});
        }
        if (labels && labels->size() != classes.size())
            throw ArgumentError(fmt::format("LabelMap: expected a label for each of {} names, got {}",
                                            classes.size(), labels->size()));
    }
    return classes;
}

UnknownLabels unknown_from(const std::string& text) {
    if (ascii::same_letters(text, "refused")) return UnknownLabels::refused;
    if (ascii::same_letters(text, "unlabelled")) return UnknownLabels::unlabelled;
    throw ArgumentError(fmt::format("LabelMap unknown: expected 'refused' or 'unlabelled', got '{}'", text));
}

void construct_label_map(LabelMapHandle* self, const NamesLike& names, const ColorsLike& colors,
                         const std::optional<std::vector<int32_t>>& labels, std::optional<int32_t> unlabelled,
                         const std::string& unknown, const std::string& name) {
    std::vector<LabelClass> classes = classes_from(names, labels);
    const std::vector<Rgb8> given = colors.is_none() ? std::vector<Rgb8>() : colors_from(colors);
    if (!colors.is_none() && given.size() != classes.size())
        throw ArgumentError(fmt::format("LabelMap: expected a colour for each of {} classes, got {}",
                                        classes.size(), given.size()));
    for (size_t i = 0; i < classes.size(); ++i)
        classes[i].color =
            given.empty() ? GeneratedColors(classes[i].label).color_of(classes[i].label) : given[i];
    new (self) LabelMapHandle{
        std::make_shared<const LabelMap>(name, std::move(classes), unlabelled, unknown_from(unknown))};
}

nb::object colormap_to_numpy(nb::handle object) {
    const ColorTable table = color_table(parse_colormap(colormap_text(object)));
    Image colors(1, int(table.size()), 3, PixelType::u8);
    for (size_t i = 0; i < table.size(); ++i) std::copy_n(table[i].data(), 3, colors.at<uint8_t>(0, int(i)));
    return to_numpy(std::move(colors)).attr("reshape")(-1, 3);
}

nb::object colors_of(const LabelMapHandle& handle) {
    const auto& classes = handle.map->classes();
    Image colors(1, std::max<int>(1, int(classes.size())), 3, PixelType::u8);
    for (size_t i = 0; i < classes.size(); ++i)
        std::copy_n(classes[i].color.data(), 3, colors.at<uint8_t>(0, int(i)));
    return to_numpy(std::move(colors)).attr("reshape")(-1, 3);
}

const LabelClass& class_of(const LabelMapHandle& handle, int32_t label) {
    if (const LabelClass* own = handle.map->find(label)) return *own;
    throw NameError(fmt::format("label {} is not in the label map '{}', which has {}", label,
                                handle.map->name(), handle.map->range_text()));
}

template <class T>
std::vector<T> column(const LabelMapHandle& handle, T LabelClass::*member) {
    std::vector<T> values;
    for (const LabelClass& own : handle.map->classes()) values.push_back(own.*member);
    return values;
}

void bind_constructors(nb::class_<LabelMapHandle>& map) {
    map.def(
        "__init__", construct_label_map, nb::arg("names"), nb::arg("colors").none() = nb::none(),
        nb::arg("labels").none() = nb::none(), nb::arg("unlabelled").none() = nb::none(),
        nb::arg("unknown") = "refused", nb::arg("name") = "",
        "`names`: a list for labels 0, 1, 2, ... or for `labels`, or a dict of label to name. `colors`: "
        "texts, or n x 3 numbers as Mesh.C takes them: uint8 and uint16 span their range, others are 0 to "
        "1 if none is above 1, else 0 to 255; None: generated. `unlabelled`: the label of unlabelled "
        "elements. `unknown`: whether non-negative labels that are not in the map are 'refused', or shown "
        "as 'unlabelled'.");
    for (const std::string& name : built_in_label_map_names())
        map.def_static(
            name.c_str(), [name] { return LabelMapHandle{built_in_label_map(name)}; },
            fmt::format("The data set's names and colours, by the labels {}.",
                        name.ends_with("_train") ? "that networks are trained with" : "of its files")
                .c_str());
    map.def_static(
           "load",
           [](const fs::path& path) {
               return LabelMapHandle{
                   released([&] { return std::make_shared<const LabelMap>(io::load_label_map(path)); })};
           },
           nb::arg("path"), "Reads JSON, SemanticKITTI's YAML, or lines of text; see the page on labels.")
        .def(
            "save",
            [](const LabelMapHandle& m, const fs::path& path) {
                released([&] { io::save_label_map(*m.map, path); });
            },
            nb::arg("path"), "Writes JSON, or lines 'LABEL NAME R G B' for other extensions.");
}

std::string map_text(const LabelMapHandle& handle) {
    return fmt::format("<easypbr.LabelMap '{}': {}>", handle.map->name(), handle.map->range_text());
}

}  // namespace

std::shared_ptr<const LabelMap> to_label_map(nb::handle object) {
    if (object.is_none()) return nullptr;
    if (nb::isinstance<LabelMapHandle>(object)) return nb::cast<const LabelMapHandle&>(object).map;
    if (!is_path(object))
        throw ArgumentError(
            fmt::format("label_map: expected a LabelMap, a built-in map's name, a path or None, got {}",
                        nb::cast<std::string>(nb::str(object.type()))));
    const std::string name = nb::cast<std::string>(nb::module_::import_("os").attr("fsdecode")(object));
    return released([&] { return io::find_label_map(name); });
}

void bind_label_map(nb::module_& module) {
    nb::class_<LabelMapHandle> map(module, "LabelMap",
                                   "Names and colours of integer labels, one per class. Immutable.");
    bind_constructors(map);
    map.def_prop_ro("name", [](const LabelMapHandle& m) { return m.map->name(); })
        .def_prop_ro(
            "labels", [](const LabelMapHandle& m) { return column(m, &LabelClass::label); },
            "All labels in ascending order.")
        .def_prop_ro(
            "names", [](const LabelMapHandle& m) { return column(m, &LabelClass::name); },
            "The names of the classes in the order of `labels`.")
        .def_prop_ro("colors", colors_of, nb::sig("def colors(self) -> numpy.ndarray"),
                     "n x 3 uint8 sRGB in the order of `labels`.")
        .def_prop_ro(
            "unlabelled", [](const LabelMapHandle& m) { return m.map->unlabelled(); },
            "The label of unlabelled elements, or None.")
        .def_prop_ro("unknown",
                     [](const LabelMapHandle& m) {
                         return m.map->unknown() == UnknownLabels::refused ? "refused" : "unlabelled";
                     })
        .def(
            "name_of", [](const LabelMapHandle& m, int32_t label) { return class_of(m, label).name; },
            nb::arg("label"))
        .def(
            "color_of",
            [](const LabelMapHandle& m, int32_t label) {
                const Rgb8 c = class_of(m, label).color;
                return nb::make_tuple(int(c[0]), int(c[1]), int(c[2]));
            },
            nb::arg("label"), nb::sig("def color_of(self, label: int) -> tuple[int, int, int]"),
            "8-bit sRGB.")
        .def("__len__", [](const LabelMapHandle& m) { return m.map->classes().size(); })
        .def(
            "__contains__",
            [](const LabelMapHandle& m, int32_t label) { return m.map->find(label) != nullptr; },
            nb::arg("label"))
        .def("__reduce__",
             [](const nb::object& self) {
                 nb::list arguments;
                 for (const char* name : {"names", "colors", "labels", "unlabelled", "unknown", "name"})
                     arguments.append(self.attr(name));
                 return nb::make_tuple(self.type(), nb::tuple(arguments));
             })
        .def("__repr__", map_text);
    module.def(
        "colormap", colormap_to_numpy, nb::arg("name"),
        nb::sig("def colormap(name: object) -> numpy.ndarray"),
        "The 256 x 3 uint8 sRGB colours of a colour map: viridis, viridis_r (reversed), plasma, ..., one of "
        "matplotlib's, colours as text, or n x 3 sRGB colours, floats from 0 to 1 or uint8.");
}

}  // namespace easypbr::python

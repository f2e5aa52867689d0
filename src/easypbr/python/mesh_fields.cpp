#include "easypbr/python/mesh_fields.h"

#include <fmt/format.h>

#include "easypbr/core/error.h"
#include "easypbr/python/convert.h"
#include "easypbr/python/handles.h"
#include "easypbr/python/text.h"

namespace easypbr::python {
namespace {

/// What Mesh.label_map takes.
class LabelMapLike : public nb::object {
    NB_OBJECT_DEFAULT(LabelMapLike, nb::object, "LabelMap | str | os.PathLike | None", is_anything)
};
class ScalarsLike : public nb::object {
    NB_OBJECT_DEFAULT(ScalarsLike, nb::object, "Mapping[str, numpy.typing.ArrayLike] | None", is_anything)
};

const char* const advice =
    "scores of classes, such as a network's logits, become labels by their argmax: scores.argmax(-1)";
const char* const missing_advice =
    "NaN is no label: give -1 where there is none, such as numpy.nan_to_num(labels, nan=-1)";

/// Whether any number is NaN, as tables have it where a label is missing.
bool has_missing(nb::handle labels) {
    const nb::object numbers = numeric_object(labels, "mesh array L");
    const nb::object any = nb::module_::import_("numpy").attr("isnan")(numbers).attr("any")();
    return nb::cast<bool>(any.attr("item")());
}

/// Told from the shape alone, so that no tensor needs to be converted first.
void refuse_scores(nb::handle object) {
    if (!nb::hasattr(object, "shape")) return;
    const nb::object shape = object.attr("shape");
    if (nb::len(shape) < 2) return;
    const size_t last = nb::len(shape) - 1;
    if (nb::len(shape) == 2 && nb::cast<int64_t>(nb::object(shape[last])) <= 1) return;
    std::string text;
    for (nb::handle side : shape)
        text += fmt::format("{}{}", text.empty() ? "" : " x ", nb::cast<int64_t>(side));
    throw ArgumentError(fmt::format("mesh array L: expected n labels, got {}; {}", text, advice));
}

Array1f scalar_values(const std::string& name, nb::handle values) {
    const std::string array = fmt::format("scalars['{}']", name);
    const nb::object numbers = flags_as_numbers(values, fmt::format("mesh array {}", array).c_str());
    const ArrayShape shape{array.c_str(), 1, 1};
    const Array1f kept = to_array<float, 1>(numbers, shape);
    warn_of_rounding("", name, rounding_of(numbers, shape));
    return kept;
}

std::vector<ScalarArray> scalar_arrays(nb::handle items) {
    std::vector<ScalarArray> scalars;
    for (nb::handle item : items) {
        const std::string name = nb::cast<std::string>(nb::str(nb::object(item[0])));
        scalars.push_back({name, scalar_values(name, nb::object(item[1]))});
    }
    return scalars;
}

nb::dict scalars_of(const Mesh& mesh) {
    nb::dict scalars;
    for (const ScalarArray& scalar : mesh.snapshot()->scalars)
        scalars[nb::cast(scalar.name)] = view_of(scalar.values);
    return scalars;
}

nb::object label_map_of(const Mesh& mesh) {
    const auto map = mesh.label_map();
    return map ? nb::cast(LabelMapHandle{map}) : nb::none();
}

}  // namespace

MeshChange prepare_intensities(nb::handle object) {
    Array1f intensities;
    if (!object.is_none()) {
        const ArrayShape shape{"I", 1, 1};
        const nb::object numbers = numeric_object(object, "mesh array I");
        intensities = to_array<float, 1>(numbers, shape);
        warn_of_rounded_intensities("", rounding_of(numbers, shape));
    }
    return [intensities](MeshData& data) { data.I = intensities; };
}

MeshChange prepare_labels(nb::handle object) {
    Array1i labels;
    if (!object.is_none()) {
        refuse_scores(object);
        const nb::object numbers = flags_as_numbers(object, "mesh array L");
        try {
            labels = to_array<int32_t, 1>(numbers, {"L", 1, 1});
        } catch (const ArgumentError& error) {
            throw ArgumentError(
                fmt::format("{}; {}", error.what(), has_missing(numbers) ? missing_advice : advice));
        }
    }
    return [labels](MeshData& data) { data.L = labels; };
}

MeshChange prepare_scalars(nb::handle object) {
    std::vector<ScalarArray> scalars;
    if (!object.is_none()) {
        if (!nb::hasattr(object, "items"))
            throw ArgumentError(
                "mesh scalars: expected a dict of name to values; add_scalar(name, values) adds one");
        scalars = scalar_arrays(object.attr("items")());
    }
    return [scalars](MeshData& data) { data.scalars = scalars; };
}

MeshChange prepare_label_map(nb::handle object) {
    const auto map = to_label_map(object);
    return [map](MeshData& data) { data.label_map = map; };
}

void bind_mesh_fields(nb::class_<Mesh>& mesh) {
    mesh.def_prop_rw(
            "label_map", label_map_of,
            [](Mesh& m, const LabelMapLike& value) {
                const MeshChange change = prepare_label_map(value);
                released([&] { m.edit(change); });
            },
            nb::for_getter(nb::sig("def label_map(self) -> LabelMap | None")),
            nb::for_setter(nb::arg("value").none()),
            "Names and colours of the labels; None: generated colours. Assign a LabelMap, the name of a "
            "built-in one, or a path.")
        .def_prop_rw(
            "scalars",
            [](const Mesh& m) { return nb::module_::import_("easypbr.scalars").attr("Scalars")(m); },
            [](Mesh& m, const ScalarsLike& value) {
                const MeshChange change = prepare_scalars(value);
                released([&] { m.edit(change); });
            },
            nb::for_getter(nb::sig("def scalars(self) -> easypbr.scalars.Scalars")),
            nb::for_setter(nb::arg("value").none()),
            "Named scalar fields of vertices or faces: mesh.scalars['heat'] = values adds or replaces, del "
            "removes; assign a dict to replace all.")
        .def("_scalars", scalars_of)
        .def("_add_scalars",
             [](Mesh& m, const nb::dict& values) {
                 const std::vector<ScalarArray> scalars = scalar_arrays(values.attr("items")());
                 released([&] { m.add_scalars(scalars); });
             })
        .def("_keep_scalars_aside",
             [](Mesh& m) {
                 released([&] {
                     m.edit([](MeshData& data) {
                         for (ScalarArray& scalar : data.scalars) scalar.from_file = true;
                     });
                 });
             })
        .def(
            "add_scalar",
            [](Mesh& m, const std::string& name, const ArrayLike& values) {
                const Array1f numbers = scalar_values(name, values);
                released([&] { m.add_scalar(name, numbers); });
            },
            nb::arg("name"), nb::arg("values"),
            "Adds or replaces a named scalar field, one value per vertex, per face or per polygon of "
            "source_face (NaN: missing). Booleans are 0 and 1.")
        .def(
            "remove_scalar",
            [](Mesh& m, const std::string& name) { released([&] { m.remove_scalar(name); }); },
            nb::arg("name"));
}

}  // namespace easypbr::python

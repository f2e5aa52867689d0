// The table of settings, and `auto` and `follow`.
#include <fmt/format.h>
#include <nanobind/stl/vector.h>

#include "easypbr/core/error.h"
#include "easypbr/io/settings/settings_io.h"
#include "easypbr/python/colormap.h"
#include "easypbr/python/convert.h"
#include "easypbr/python/pickle.h"
#include "easypbr/python/settings_value.h"
#include "easypbr/python/text.h"
#include "easypbr/scene/synonyms.h"

namespace easypbr::python {
namespace {

nb::object number_to_python(double number, bool whole) {
    return whole ? nb::cast(int64_t(number)) : nb::cast(number);
}

nb::object data_to_python(const Value::Data& data, bool whole) {
    if (const auto* flag = std::get_if<bool>(&data)) return nb::cast(*flag);
    if (const auto* number = std::get_if<double>(&data)) return number_to_python(*number, whole);
    if (const auto* text = std::get_if<std::string>(&data)) return nb::cast(*text);
    nb::list list;
    for (double number : std::get<std::vector<double>>(data)) list.append(number_to_python(number, whole));
    return nb::tuple(list);
}

std::vector<double> numbers_of(const FieldInfo& field, nb::handle object) {
    nb::object array;
    try {
        array = numeric_object(object, field.name.c_str());
    } catch (const ArgumentError&) {
        reject_value(field, nb::cast<std::string>(nb::repr(object)));
    }
    const nb::object flat = array.attr("astype")("float64").attr("ravel")().attr("tolist")();
    return nb::cast<std::vector<double>>(flat);
}

/// numpy's scalars as Python's.
nb::object unboxed(nb::handle object) {
    const bool boxed =
        nb::hasattr(object, "item") && nb::hasattr(object, "ndim") && nb::cast<int>(object.attr("ndim")) == 0;
    return boxed ? object.attr("item")() : nb::borrow(object);
}

Value::Data data_from_python(const FieldInfo& field, nb::handle given) {
    if (given.is_none()) {
        if (field.type == FieldType::text) return std::string();
        if (field.type == FieldType::vector) return std::vector<double>();
        throw ArgumentError(fmt::format("setting '{}': None is no value{}", field.name,
                                        field.can_be_automatic ? "; auto infers it" : ""));
    }
    if (field.type == FieldType::colormap) return colormap_text(given);
    const nb::object object = unboxed(given);
    if (nb::isinstance<nb::str>(object)) return nb::cast<std::string>(object);
    if (is_path(object)) return nb::cast<std::string>(nb::module_::import_("os").attr("fsdecode")(object));
    if (nb::isinstance<nb::bool_>(object)) return nb::cast<bool>(object);
    if (nb::isinstance<nb::int_>(object) || nb::isinstance<nb::float_>(object))
        return PyFloat_Check(object.ptr()) ? nb::cast<double>(object) : double(nb::cast<int64_t>(object));
    return numbers_of(field, object);
}

nb::str automatic_text(const Automatic& automatic) {
    if (!automatic.value) return nb::str("auto");
    const std::string value = nb::cast<std::string>(nb::repr(data_to_python(*automatic.value, false)));
    return nb::str(fmt::format("auto (now {})", value).c_str());
}

const char* type_name(FieldType type) {
    constexpr const char* names[] = {"boolean", "integer", "number", "color",
                                     "vector",  "text",    "choice", "colormap"};
    return names[size_t(type)];
}

void bind_automatic(nb::module_& module) {
    nb::class_<Automatic> automatic(module, "Automatic",
                                    "Value of a setting: inferred at the next image, then latched.");
    automatic
        .def_prop_ro(
            "value",
            [](const Automatic& a) { return a.value ? data_to_python(*a.value, false) : nb::none(); },
            nb::sig("def value(self) -> bool | float | str | tuple[float, ...] | None"),
            "The value inferred for the last image; None before the first.")
        .def("__repr__", automatic_text)
        .def(
            "__eq__", [](const Automatic&, nb::handle other) { return nb::isinstance<Automatic>(other); },
            nb::arg("other").none())
        .def("__hash__", [](const Automatic&) { return 1; });
    bind_copies(automatic, [](const Automatic& a) { return a; });
    bind_pickle(automatic);
    nb::class_<Follow> follow(module, "Follow", "Value of a setting: inferred again for every image.");
    follow.def("__repr__", [](const Follow&) { return "follow"; })
        .def(
            "__eq__", [](const Follow&, nb::handle other) { return nb::isinstance<Follow>(other); },
            nb::arg("other").none())
        .def("__hash__", [](const Follow&) { return 2; });
    bind_copies(follow, [](const Follow& f) { return f; });
    bind_pickle(follow);
    module.attr("auto") = Automatic{};
    module.attr("follow") = Follow{};
}

}  // namespace

Value value_from_python(const FieldInfo& field, nb::handle object) {
    if (nb::isinstance<Follow>(object)) return {{}, Value::State::follow};
    if (nb::isinstance<Automatic>(object)) {
        const auto& automatic = nb::cast<const Automatic&>(object);
        return {automatic.value.value_or(Value::Data{}), Value::State::automatic,
                automatic.value.has_value()};
    }
    if (nb::isinstance<nb::str>(object) && field.can_be_automatic) {
        const std::string text = nb::cast<std::string>(object);
        if (text == "auto" || text == "follow") return parse_value(field, text);
    }
    return {data_from_python(field, object)};
}

nb::object value_to_python(const FieldInfo& field, const Value& value) {
    if (value.state == Value::State::follow) return nb::cast(Follow{});
    if (value.state == Value::State::given) return data_to_python(value.data, field.whole);
    return nb::cast(value.latched ? Automatic{value.data} : Automatic{});
}

void bind_settings(nb::module_& module) {
    bind_automatic(module);
    nb::class_<Field>(module, "Field", "One row of the table of settings.")
        .def_ro("name", &Field::name)
        .def_ro("doc", &Field::doc)
        .def_ro("unit", &Field::unit)
        .def_prop_ro("type", [](const Field& field) { return type_name(field.type); })
        .def_ro("can_be_automatic", &Field::can_be_automatic)
        .def_ro("min", &Field::min)
        .def_ro("max", &Field::max)
        .def_ro("choices", &Field::choices)
        .def_ro("sizes", &Field::sizes)
        .def_ro("whole", &Field::whole)
        .def_prop_ro("default",
                     [](const Field& field) { return value_to_python(field, field.get(Settings())); });
    nb::class_<Synonym>(module, "Synonym", "What other programs call a setting.")
        .def_prop_ro("word", [](const Synonym& s) { return std::string(s.word); })
        .def_prop_ro(
            "setting", [](const Synonym& s) { return std::string(s.setting); },
            "What it is called here; empty: it is no setting.")
        .def_prop_ro(
            "advice", [](const Synonym& s) { return std::string(s.advice); },
            "What to do instead in Python, where it is no setting.");
    module.def(
        "synonyms",
        [] {
            const auto all = synonyms();
            return std::vector<Synonym>(all.begin(), all.end());
        },
        "All words of other programs that are known.");
    module.def(
        "synonym",
        [](const std::string& word) {
            const Synonym* found = synonym(word);
            return found ? nb::cast(*found) : nb::none();
        },
        nb::arg("word"), nb::sig("def synonym(word: str) -> Synonym | None"),
        "What a word of another program means here; None: nothing.");
    module.def(
        "fields", [] { return fields(); }, "All settings in the order of the reference.");
    module.def(
        "field", [](const std::string& name) { return field(name); }, nb::arg("name"),
        "One setting by name. Raises UnknownNameError with the nearest name.");
}

}  // namespace easypbr::python

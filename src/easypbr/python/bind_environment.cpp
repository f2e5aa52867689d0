// Environment: an equirectangular picture that lights the scene.
#include <nanobind/stl/filesystem.h>

#include "easypbr/core/file.h"
#include "easypbr/python/convert.h"
#include "easypbr/python/pickle.h"
#include "easypbr/python/text.h"
#include "easypbr/scene/environment.h"

namespace easypbr::python {
namespace {

void construct_environment(Environment* self, const PathOrArray& source) {
    if (source.is_none()) {
        new (self) Environment();
    } else if (is_path(source)) {
        const auto path = nb::cast<fs::path>(source);
        released([&] { new (self) Environment(path); });
    } else {
        Image image = to_image(source, "environment");
        released([&] { new (self) Environment(to_linear_f32(image), "array"); });
    }
}

}  // namespace

void bind_environment(nb::module_& module) {
    nb::class_<Environment> environment(
        module, "Environment",
        "Equirectangular environment map for image-based lighting (HDR, EXR, PNG, JPEG, or an array; the "
        "first row is straight up).");
    bind_pickle(environment);
    environment.def("__init__", construct_environment, nb::arg("source").none() = nb::none())
        .def_prop_ro("name", [](const Environment& e) { return e.empty() ? std::string() : e.name(); })
        .def_prop_ro("empty", &Environment::empty)
        .def(
            "to_numpy", [](const Environment& e) { return e.empty() ? nb::none() : to_numpy(e.image()); },
            nb::sig("def to_numpy(self) -> numpy.ndarray | None"),
            "A copy of the environment map, linear float32.")
        .def("__bool__", [](const Environment& e) { return !e.empty(); });
    module.def(
        "studio_environment", [] { return released([] { return studio_environment(); }); },
        "The built-in studio, the default environment map.");
}

}  // namespace easypbr::python

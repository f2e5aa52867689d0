// Scene, as the Python class of the same name uses it.
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/vector.h>

#include "easypbr/geometry/primitives.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/python/bindings.h"
#include "easypbr/python/convert.h"
#include "easypbr/python/pickle.h"
#include "easypbr/python/text.h"
#include "easypbr/scene/scene.h"
#include "easypbr/viewer/viewer.h"

namespace easypbr::python {

void bind_scene(nb::module_& module) {
    nb::class_<Scene>(module, "SceneHandle", "Named meshes, lights and an environment, shared by handle.")
        .def(nb::init<>())
        .def("__reduce__", [](const Scene&) { refuse_pickle("Scene"); })
        .def(
            "show",
            [](Scene& s, const Mesh& mesh, const std::string& name) {
                released([&] { s.show(mesh, name); });
            },
            nb::arg("mesh"), nb::arg("name"))
        .def("get", &Scene::get, nb::arg("name"))
        .def(
            "remove", [](Scene& s, const std::string& name) { released([&] { s.remove(name); }); },
            nb::arg("name"))
        .def("hide", &Scene::hide, nb::arg("name"), nb::arg("hidden") = true)
        .def("clear", [](Scene& s) { released([&] { s.clear(); }); })
        .def("names", &Scene::names)
        .def("contains", &Scene::contains, nb::arg("name"))
        .def("set_light", &Scene::set_light, nb::arg("name"), nb::arg("light"))
        .def("light", &Scene::light, nb::arg("name"))
        .def("remove_light", &Scene::remove_light, nb::arg("name"))
        .def("light_names", &Scene::light_names)
        .def_prop_rw(
            "origin",
            [](const Scene& s) { return matrix_to_numpy(released([&] { return s.origin(); }).transpose()); },
            [](Scene& s, const ArrayLike& origin) { s.set_origin(to_vector3(origin, "origin")); },
            nb::for_getter(nb::sig("def origin(self) -> numpy.ndarray")))
        .def_prop_rw("environment", &Scene::environment,
                     [](Scene& s, const Environment& environment) { s.set_environment(environment); });
    nb::class_<io::LoadedScene>(module, "LoadedScene",
                                "The contents of a file: mesh, cameras, lights and animations.")
        .def_ro("mesh", &io::LoadedScene::mesh)
        .def_ro("cameras", &io::LoadedScene::cameras, "Cameras by name, in world space (glTF).")
        .def_ro("lights", &io::LoadedScene::lights, "Lights by name, in world space (glTF).")
        .def_ro("animations", &io::LoadedScene::animations, "Animations of the mesh and its children (glTF).")
        .def_ro("variants", &io::LoadedScene::variants, "Names of the material variants (glTF).");
    module.def(
        "load_scene",
        [](const std::filesystem::path& path, double memory_gb, bool strict, const std::string& variant) {
            return released([&] {
                return io::load_scene(path, {.memory_gb = memory_gb, .variant = variant, .strict = strict});
            });
        },
        nb::arg("path"), nb::arg("memory_gb") = 0.0, nb::arg("strict") = false, nb::arg("variant") = "",
        "Reads a file with its cameras, lights and animations; Mesh(path) reads the mesh alone. "
        "Its arrays and images may take at most memory_gb; 0: three quarters of what is available. "
        "With strict, points of a cloud without a finite position raise FormatError; "
        "else they are left out with a warning. "
        "variant names a material variant of a glTF file (LoadedScene.variants); "
        "empty: the file's own materials. Raises UnknownNameError for one that the file has not.");
    module.def(
        "default_scene", [] { return default_scene(); }, "The default scene.");
    module.def("demo_scene", [] { return released([] { return make_demo_scene(); }); });
}

}  // namespace easypbr::python

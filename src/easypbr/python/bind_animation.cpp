// Animations: what moves the meshes of a file.
#include <nanobind/stl/map.h>
#include <nanobind/stl/vector.h>

#include "easypbr/python/bindings.h"
#include "easypbr/python/text.h"
#include "easypbr/scene/animation.h"

namespace easypbr::python {
namespace {

/// A name or a number.
size_t index_of(const Animations& animations, const nb::object& animation) {
    if (!nb::isinstance<nb::int_>(animation)) return animations.find(nb::cast<std::string>(animation));
    return animations.find(nb::cast<std::string>(nb::str(animation)));
}

}  // namespace

void bind_animation(nb::module_& module) {
    nb::class_<Animations>(module, "Animations",
                           "Animations of the nodes, skins and morph targets of a file; may be empty.")
        .def_prop_ro("names", &Animations::names)
        .def("__len__", [](const Animations& a) { return a.names().size(); })
        .def(
            "duration_s",
            [](const Animations& a, const nb::object& animation) {
                return a.duration_s(index_of(a, animation));
            },
            nb::arg("animation") = 0, nb::sig("def duration_s(self, animation: str | int = 0) -> float"),
            "Duration of an animation in seconds, by name or number.")
        .def(
            "apply",
            [](Animations& a, double time, const nb::object& animation, bool loop) {
                const size_t index = index_of(a, animation);
                released([&] { a.apply(index, time, loop); });
            },
            nb::arg("time_s"), nb::arg("animation") = 0, nb::arg("loop") = true,
            nb::sig("def apply(self, time_s: float, animation: str | int = 0, loop: bool = True) -> None"),
            "Poses the meshes of the file at a time: nodes, skins, morph targets. With loop the animation "
            "repeats, else the time is clamped to its ends.")
        .def(
            "lights",
            [](const Animations& a, double time, const nb::object& animation, bool loop) {
                return a.lights(index_of(a, animation), time, loop);
            },
            nb::arg("time_s"), nb::arg("animation") = 0, nb::arg("loop") = true,
            nb::sig("def lights(self, time_s: float, animation: str | int = 0, loop: bool = True) -> "
                    "dict[str, Light]"),
            "The lights that the animations of the file move, change or hide, at a time, by name, in world "
            "space. A hidden one has no intensity. Viewer.play() moves those that the scene has under these "
            "names.")
        .def(
            "cameras",
            [](const Animations& a, double time, const nb::object& animation, bool loop) {
                return a.cameras(index_of(a, animation), time, loop);
            },
            nb::arg("time_s"), nb::arg("animation") = 0, nb::arg("loop") = true,
            nb::sig("def cameras(self, time_s: float, animation: str | int = 0, loop: bool = True) -> "
                    "dict[str, Camera]"),
            "The cameras that the animations of the file move or change, at a time, by name, in world "
            "space.");
}

}  // namespace easypbr::python

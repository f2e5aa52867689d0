// What the files of the Python module share: one bind function per class family, and how C++ is called.
#pragma once

#include <nanobind/nanobind.h>

#include <utility>

#include "easypbr/python/job.h"

namespace easypbr::python {

namespace nb = nanobind;

void bind_errors();
void bind_log();
void bind_laz();
void bind_denoiser();
void bind_settings(nb::module_& module);
void bind_image(nb::module_& module);
void bind_material(nb::module_& module);
void bind_label_map(nb::module_& module);
void bind_mesh(nb::module_& module);
void bind_shapes(nb::module_& module);
void bind_neighbors(nb::module_& module);
void bind_geometry(nb::module_& module);
void bind_surfaces(nb::module_& module);
void bind_light(nb::module_& module);
void bind_environment(nb::module_& module);
void bind_scene(nb::module_& module);
void bind_animation(nb::module_& module);
void bind_camera(nb::module_& module);
void bind_camera_path(nb::module_& module);
void bind_viewer(nb::module_& module);
void bind_ground_truth(nb::module_& module);

/// Hands the messages logged so far to Python. Needs the GIL; no lock of ours may be held. What a handler of
/// them raises to end the program is raised when the main thread is back in Python; the call is not undone.
void deliver_log();

/// Runs work without the GIL; see Job for how it is interrupted. What it logs reaches Python afterwards, when
/// no lock is held any more.
template <class Work>
auto released(Work&& work) {
    struct Delivery {
        ~Delivery() { deliver_log(); }
    } delivery;
    Job job;
    try {
        nb::gil_scoped_release release;
        const Job::Running running;
        return std::forward<Work>(work)();
    } catch (const Interrupted&) {
        Job::raise();
    }
}

/// Has copy.copy() and copy.deepcopy() give what `copy` makes of an object.
template <class T, class Copy>
void bind_copies(nb::class_<T>& type, Copy copy) {
    type.def("__copy__", copy);
    type.def(
        "__deepcopy__", [copy](const T& object, const nb::object&) { return copy(object); }, nb::arg("memo"));
}

}  // namespace easypbr::python

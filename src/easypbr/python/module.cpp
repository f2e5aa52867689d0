// The Python module easypbr._easypbr. Importing it touches no GL library.
#include "easypbr/python/bindings.h"

#include <nanobind/stl/vector.h>

#ifdef EASYPBR_HAS_CLI
#include "easypbr/cli/cli.h"
#include "easypbr/python/text.h"
#endif

namespace easypbr::python {
namespace {

#ifdef EASYPBR_HAS_CLI
int run_command_line(const std::vector<std::string>& arguments) {
    std::vector<const char*> pointers;
    for (const std::string& argument : arguments) pointers.push_back(argument.c_str());
    const int code = released([&] { return cli::run(int(pointers.size()), pointers.data()); });
    // It has replaced the log sink.
    bind_log();
    return code;
}
#endif

}  // namespace
}  // namespace easypbr::python

NB_MODULE(_easypbr, module) {
    using namespace easypbr::python;
    bind_errors();
    bind_log();
    bind_jobs();
    bind_laz();
    bind_denoiser();
    bind_settings(module);
    bind_image(module);
    bind_material(module);
    bind_label_map(module);
    bind_mesh(module);
    bind_light(module);
    bind_environment(module);
    bind_animation(module);
    bind_scene(module);
    bind_camera(module);
    bind_camera_path(module);
    bind_shapes(module);
    bind_neighbors(module);
    bind_geometry(module);
    bind_surfaces(module);
    bind_viewer(module);
    bind_ground_truth(module);
    module.attr("__version__") = EASYPBR_VERSION;
#ifdef EASYPBR_HAS_CLI
    module.def("main", run_command_line, nb::arg("arguments"),
               "The command line; the first argument is the program's name. Returns the exit code.");
#endif
}

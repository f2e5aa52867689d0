// Viewer, as the Python class of the same name uses it: one thread at a time, without the GIL.
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/io/settings_io.h"
#include "easypbr/python/convert.h"
#include "easypbr/python/settings_value.h"
#include "easypbr/python/shared_viewer.h"

namespace easypbr::python {
namespace {

app::Encoding encoding_named(const std::string& name) {
    if (name == "srgb8") return app::Encoding::srgb8;
    if (name == "srgb16") return app::Encoding::srgb16;
    if (name == "linear") return app::Encoding::scene_linear;
    throw ArgumentError("encoding: expected srgb8, srgb16 or linear, got '" + name + "'");
}

nb::object render(SharedViewer& self, const nb::object& size, std::optional<int> samples,
                  const std::string& encoding) {
    const app::PictureOptions options{optional_size(size), samples, encoding_named(encoding)};
    return to_numpy(self.run([&](Viewer& viewer) { return viewer.render(options); }));
}

nb::dict layers(SharedViewer& self, const std::vector<std::string>& names, const nb::object& size) {
    const std::optional<Vec2i> pixels = optional_size(size);
    auto images = self.run([&](Viewer& viewer) { return viewer.session().render_layers(names, pixels); });
    nb::dict result;
    for (const std::string& name : names) result[name.c_str()] = to_numpy(std::move(images.at(name)));
    return result;
}

nb::object get_setting(SharedViewer& self, const std::string& name) {
    const Value value = self.run([&](Viewer& viewer) { return get(viewer.settings(), name); });
    return value_to_python(field(name), value);
}

void set_setting(SharedViewer& self, const std::string& name, nb::handle object) {
    const Value value = value_from_python(field(name), object);
    self.run([&](Viewer& viewer) { set(viewer.settings(), name, value); });
}

nb::object resolved_setting(SharedViewer& self, const std::string& name) {
    const Settings settings = self.run([](Viewer& viewer) { return viewer.session().resolve().settings; });
    Value value = get(settings, name);
    if (value.latched) value = {value.data};
    return value_to_python(field(name), value);
}

std::string settings_to_json(SharedViewer& self) {
    return self.run([](Viewer& viewer) {
        io::SettingsFile file;
        file.settings = viewer.settings();
        for (const std::string& name : viewer.scene().light_names())
            file.lights[name] = viewer.scene().light(name);
        return io::to_json(file);
    });
}

void settings_from_json(SharedViewer& self, const std::string& json) {
    self.run([&](Viewer& viewer) {
        const io::SettingsFile file = io::parse_settings(json, "settings");
        viewer.session().replace_settings(file.settings);
        for (const auto& [name, light] : file.lights) viewer.scene().set_light(name, light);
    });
}

nb::dict timing(SharedViewer& self) {
    const app::Timing timing = self.run([](Viewer& viewer) { return viewer.session().timing(); });
    nb::dict result;
    result["context"] = timing.context;
    result["images"] = timing.images;
    result["draw"] = timing.draw;
    result["read"] = timing.read;
    return result;
}

using ViewerClass = nb::class_<SharedViewer>;

void bind_pictures(ViewerClass& viewer) {
    viewer
        .def("render", render, nb::arg("size").none() = nb::none(), nb::arg("samples").none() = nb::none(),
             nb::arg("encoding") = "srgb8")
        .def("layers", layers, nb::arg("names"), nb::arg("size").none() = nb::none())
        .def("object_names",
             [](SharedViewer& self) {
                 return self.run([](Viewer& viewer) { return viewer.session().object_names(); });
             })
        .def("timing", timing)
        .def("refit", [](SharedViewer& self) { self.run([](Viewer& viewer) { viewer.refit(); }); });
}

void bind_viewer_settings(ViewerClass& viewer) {
    viewer.def("get_setting", get_setting, nb::arg("name"))
        .def("set_setting", set_setting, nb::arg("name"), nb::arg("value").none())
        .def("resolved_setting", resolved_setting, nb::arg("name"))
        .def("settings_to_json", settings_to_json)
        .def("settings_from_json", settings_from_json, nb::arg("json"))
        .def(
            "save_settings",
            [](SharedViewer& self, const fs::path& path, const std::vector<fs::path>& files) {
                self.run([&](Viewer& viewer) { app::save_settings(viewer.session(), files, path); });
            },
            nb::arg("path"), nb::arg("files"))
        .def(
            "load_settings",
            [](SharedViewer& self, const fs::path& path) {
                self.run([&](Viewer& viewer) { app::load_settings(viewer.session(), path); });
            },
            nb::arg("path"));
}

}  // namespace

void bind_viewer(nb::module_& module) {
    ViewerClass viewer(module, "ViewerHandle", "Settings and a renderer for one scene.");
    viewer.def(nb::init<const Scene&>(), nb::arg("scene"))
        .def(
            "load_environment_map",
            [](SharedViewer& self, const fs::path& path) {
                self.run([&](Viewer& viewer) { viewer.load_environment_map(path); });
            },
            nb::arg("path"))
        .def_prop_rw(
            "camera",
            [](SharedViewer& self) { return self.run([](Viewer& viewer) { return viewer.camera(); }); },
            [](SharedViewer& self, const Camera& camera) {
                self.run([&](Viewer& viewer) { viewer.set_camera(camera); });
            });
    bind_pictures(viewer);
    bind_viewer_settings(viewer);
    bind_recorder(module, viewer);
    module.def("layer_names", [] { return render::layer_names(); });
}

}  // namespace easypbr::python

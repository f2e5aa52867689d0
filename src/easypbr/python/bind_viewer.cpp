// Viewer, as the Python class of the same name uses it: one thread at a time, without the GIL.
#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include "easypbr/app/output.h"
#include "easypbr/app/scene_files.h"
#include "easypbr/core/ascii.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/gui/live_view.h"
#include "easypbr/io/settings/settings_io.h"
#include "easypbr/python/convert.h"
#include "easypbr/python/pickle.h"
#include "easypbr/python/settings_value.h"
#include "easypbr/python/shared_viewer.h"
#include "easypbr/python/text.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::python {
namespace {

app::Encoding encoding_named(const std::string& name) {
    if (ascii::same_letters(name, "srgb8")) return app::Encoding::srgb8;
    if (ascii::same_letters(name, "srgb16")) return app::Encoding::srgb16;
    if (ascii::same_letters(name, "linear")) return app::Encoding::scene_linear;
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
    for (const std::string& name : names)
        if (!result.contains(name.c_str())) result[name.c_str()] = to_numpy(std::move(images.at(name)));
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

/// All of them or none; a camera is pinned before the values are set.
void set_settings(SharedViewer& self, const nb::dict& values, const std::optional<Camera>& camera) {
    std::vector<std::pair<std::string, Value>> given;
    for (const auto& [key, object] : values) {
        const auto name = nb::cast<std::string>(key);
        given.emplace_back(name, value_from_python(field(name), object));
    }
    self.run([&](Viewer& viewer) {
        const Settings before = viewer.settings();
        try {
            if (camera) viewer.set_camera(*camera);
            for (const auto& [name, value] : given) set(viewer.settings(), name, value);
        } catch (...) {
            viewer.settings() = before;
            throw;
        }
    });
}

nb::object resolved_setting(SharedViewer& self, const std::string& name) {
    const InferredSettings settings =
        self.run([](Viewer& viewer) { return viewer.session().resolve().settings; });
    return value_to_python(field(name), get(settings, name));
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

nb::object pick(SharedViewer& self, double x, double y, const nb::object& size) {
    const std::optional<Vec2i> pixels = optional_size(size);
    const auto pick = self.run([&](Viewer& viewer) { return viewer.pick({x, y}, pixels); });
    return pick ? nb::cast(*pick) : nb::none();
}

/// What tests and programs may ask about the window.
struct GuiReport {
    app::Selection selection;
    app::LiveStatistics statistics;
    app::RecordingReport recorder;
    gui::PanelLayout panels;
    gui::Screen screen;
    gui::ItemPlaces places;
    std::vector<app::Notification> messages;
    std::map<std::string, std::string> errors;  ///< of the user's panels
    std::string channel, image_value;
    size_t path_keys = 0;
    double path_time = 0;
    bool path_plays = false, records = false;
};

GuiReport report_of(gui::LiveView& view) {
    gui::GuiState& state = view.state();
    app::LiveDrawing& live = view.drawing();
    GuiReport report;
    report.selection = live.selection();
    report.statistics = live.picture().statistics();
    report.recorder = live.report();
    report.panels = state.panels;
    report.screen = state.screen;
    report.places = view.places();
    report.messages = live.notifications().list();
    report.errors = live.panels().errors();
    report.channel = live.channel;
    report.image_value = state.image_value;
    const app::PathEditor& path = live.path().editor;
    report.path_keys = path.keys().size();
    report.path_time = path.time();
    report.path_plays = path.is_playing();
    report.records = live.recording().is_running();
    return report;
}

nb::dict gui_state(SharedViewer& self) {
    nb::dict result;
    const auto put = [&](const char* name, const auto& value) { result[name] = nb::cast(value); };
    const GuiReport report = self.run([](Viewer& viewer) { return report_of(viewer.live()); });
    put("object", report.selection.object);
    put("show_panels", report.panels.shown);
    put("show_keys", report.panels.keys);
    put("path_keys", report.path_keys);
    put("path_time", report.path_time);
    put("path_plays", report.path_plays);
    put("records", report.records);
    put("recorder_says", report.recorder.text);
    put("image_value", report.image_value);
    put("channel", report.channel);
    put("scale", report.screen.scale);
    put("light", report.selection.light);
    put("pictures", report.statistics.pictures);
    put("frames", report.statistics.frames);
    put("total", report.statistics.total);
    put("size", std::vector<int>{report.screen.size.x(), report.screen.size.y()});
    put("drawn_size", std::vector<int>{report.statistics.size.x(), report.statistics.size.y()});
    put("frame_seconds", report.statistics.frame_seconds);
    nb::list panels, messages;
    for (int i = 0; i < gui::panel_count; ++i)
        if (report.panels.open[size_t(i)]) panels.append(gui::panel_name(gui::Panel(i)));
    for (const app::Notification& message : report.messages) messages.append(message.text);
    nb::dict own_panels, places;
    for (const auto& [name, error] : report.errors) own_panels[name.c_str()] = error;
    result["own_panels"] = own_panels;
    for (const auto& [name, box] : report.places)
        places[name.c_str()] =
            std::vector<double>{box.min().x(), box.min().y(), box.max().x(), box.max().y()};
    result["places"] = places;
    result["panels"] = panels;
    result["messages"] = messages;
    return result;
}

void set_gui(SharedViewer& self, const std::string& name, nb::handle value) {
    const std::string text = nb::isinstance<nb::str>(value) ? nb::cast<std::string>(value) : "";
    const bool flag = text.empty() && nb::cast<bool>(value);
    self.run([&](Viewer& viewer) {
        viewer.live().touch();
        gui::GuiState& state = viewer.live().state();
        if (name == "object")
            state.selection().object = text;
        else if (name == "channel")
            state.live.channel = text;
        else if (name == "light_theme")
            state.screen.theme = flag ? gui::Theme::light : gui::Theme::dark;
        else if (name == "show_panels")
            state.panels.shown = flag;
        else if (name == "show_keys")
            state.panels.keys = flag;
        else if (name == "picture_file")
            state.live.recording_form().picture = text;
        else if (name == "video_file")
            state.live.recording_form().video = text;
        else if (name == "path_file")
            state.path_panel.file = text;
        else if (name == "with_panels")
            state.live.recording_form().panels = flag;
        else if (name == "transparent")
            state.live.recording_form().transparent = flag;
        for (int i = 0; i < gui::panel_count; ++i)
            if (name == "unfold" && text == gui::panel_name(gui::Panel(i)))
                state.panels.unfold.insert(gui::Panel(i));
        for (int i = 0; i < gui::panel_count; ++i)
            if (name == gui::panel_name(gui::Panel(i))) state.panels.open[size_t(i)] = flag;
    });
}

void add_pass(SharedViewer& self, const std::string& name, nb::handle shader, const std::string& stage) {
    const Stage at = stage_named(stage);
    const bool is_text = nb::isinstance<nb::str>(shader);
    const std::string text = is_text ? nb::cast<std::string>(shader) : "";
    const fs::path path = is_text ? fs::path() : nb::cast<fs::path>(shader);
    self.run([&](Viewer& viewer) {
        viewer.add_pass(name, at,
                        is_text ? std::make_shared<app::ShaderPass>(name, text)
                                : std::make_shared<app::ShaderPass>(path));
    });
}

using ViewerClass = nb::class_<SharedViewer>;

void bind_window(ViewerClass& viewer) {
    viewer.def("update", update_window)
        .def("reopen", [](SharedViewer& self) { self.run([](Viewer& v) { v.reopen(); }); })
        .def("close", [](SharedViewer& self) { self.run([](Viewer& v) { v.close(); }); })
        .def("is_open", [](SharedViewer& self) { return self.run([](Viewer& v) { return v.is_open(); }); })
        .def("pick", pick, nb::arg("x"), nb::arg("y"), nb::arg("size").none() = nb::none(),
             nb::sig("def pick(self, x: float, y: float, size: object | None = None) -> Pick | None"))
        .def(
            "screenshot",
            [](SharedViewer& self, const nb::object& size, float scale) {
                const std::optional<Vec2i> pixels = optional_size(size);
                Image screen;
                try {
                    screen = self.run([&](Viewer& v) { return v.screenshot(pixels, scale); });
                } catch (const nb::python_error&) {
                    self.take_exception();  // A panel met the same Ctrl-C.
                    throw;
                }
                raise_kept(self);
                return to_numpy(std::move(screen));
            },
            nb::arg("size").none() = nb::none(), nb::arg("scale") = 1.0f,
            nb::sig("def screenshot(self, size: object | None = None, scale: float = 1.0) -> numpy.ndarray"))
        .def("open",
             [](SharedViewer& self, const fs::path& path) {
                 self.run([&](Viewer& v) { v.live().drawing().files().open(path); });
             })
        .def("set_path",
             [](SharedViewer& self, const CameraPath& path) {
                 self.run([&](Viewer& v) {
                     v.live().state().path().editor.set(path);
                     v.live().touch();
                 });
             })
        .def("get_path",
             [](SharedViewer& self) {
                 return self.run([](Viewer& v) { return v.live().state().path().editor.path(); });
             })
        .def("panel_names",
             [](SharedViewer&) {
                 std::vector<std::string> names;
                 for (int i = 0; i < gui::panel_count; ++i) names.push_back(gui::panel_name(gui::Panel(i)));
                 return names;
             })
        .def("gui_state", gui_state)
        .def_prop_rw(
            "panel_scale",
            [](SharedViewer& self) {
                return self.run([](Viewer& v) { return v.live().state().screen.panel_scale; });
            },
            [](SharedViewer& self, float scale) {
                self.run([&](Viewer& v) { v.live().set_panel_scale(scale); });
            })
        .def("set_gui", set_gui, nb::arg("name"), nb::arg("value"));
}

void bind_pictures(ViewerClass& viewer) {
    viewer
        .def("render", render, nb::arg("size").none() = nb::none(), nb::arg("samples").none() = nb::none(),
             nb::arg("encoding") = "srgb8",
             nb::sig("def render(self, size: object | None = None, samples: int | None = None, encoding: str "
                     "= 'srgb8') -> numpy.ndarray"))
        .def("layers", layers, nb::arg("names"), nb::arg("size").none() = nb::none())
        .def("forget_motion",
             [](SharedViewer& self) { self.run([](Viewer& viewer) { viewer.session().forget_motion(); }); })
        .def(
            "begin_motion",
            [](SharedViewer& self, const Camera& from) {
                self.run([&](Viewer& viewer) { viewer.session().begin_motion(from); });
            },
            nb::arg("from_camera"))
        .def(
            "focus_at",
            [](SharedViewer& self, int x, int y, const nb::object& size) {
                const std::optional<Vec2i> pixels = optional_size(size);
                return self.run([&](Viewer& viewer) { return viewer.session().focus_at(x, y, pixels); });
            },
            nb::arg("x"), nb::arg("y"), nb::arg("size").none() = nb::none())
        .def("object_names",
             [](SharedViewer& self) {
                 return self.run([](Viewer& viewer) { return viewer.session().object_names(); });
             })
        .def("timing", timing)
        .def("add_pass", add_pass, nb::arg("name"), nb::arg("shader"), nb::arg("stage"))
        .def("remove_pass",
             [](SharedViewer& self, const std::string& name) {
                 self.run([&](Viewer& viewer) { viewer.remove_pass(name); });
             })
        .def("refit", [](SharedViewer& self) { self.run([](Viewer& viewer) { viewer.refit(); }); });
}

void bind_viewer_settings(ViewerClass& viewer) {
    viewer.def("get_setting", get_setting, nb::arg("name"))
        .def("set_setting", set_setting, nb::arg("name"), nb::arg("value").none())
        .def("set_settings", set_settings, nb::arg("values"), nb::arg("camera").none() = nb::none())
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
            nb::arg("path"))
        .def(
            "apply_preset",
            [](SharedViewer& self, const std::string& preset) {
                self.run([&](Viewer& viewer) { viewer.apply_preset(preset); });
            },
            nb::arg("preset"));
}

}  // namespace

void bind_viewer(nb::module_& module) {
    ViewerClass viewer(module, "ViewerHandle", "Settings and a renderer for one scene.");
    viewer.def("__reduce__", [](const SharedViewer&) { refuse_pickle("Viewer"); })
        .def(
            "__init__",
            [](SharedViewer* self, const Scene& scene, const std::string& device) {
                new (self) SharedViewer(scene, draw_device_named(device));
            },
            nb::arg("scene"), nb::arg("device") = "auto")
        .def_prop_ro("device",
                     [](SharedViewer& self) {
                         const DrawDevice device = self.run([](Viewer& viewer) { return viewer.device(); });
                         return draw_device_names()[size_t(device)];
                     })
        .def(
            "load_environment_map",
            [](SharedViewer& self, const fs::path& path) {
                self.run([&](Viewer& viewer) { viewer.load_environment_map(path); });
            },
            nb::arg("path"))
        .def(
            "load_background_image",
            [](SharedViewer& self, const fs::path& path) {
                self.run([&](Viewer& viewer) { viewer.load_background_image(path); });
            },
            nb::arg("path"))
        .def(
            "set_background_image",
            [](SharedViewer& self, const ArrayLike& array) {
                Image image = to_image(array, "background image");
                self.run([&](Viewer& viewer) { viewer.set_background_image(std::move(image)); });
            },
            nb::arg("image"))
        .def_prop_rw(
            "camera",
            [](SharedViewer& self) { return self.run([](Viewer& viewer) { return viewer.camera(); }); },
            [](SharedViewer& self, const Camera& camera) {
                self.run([&](Viewer& viewer) { viewer.set_camera(camera); });
            });
    bind_pictures(viewer);
    bind_viewer_settings(viewer);
    bind_recorder(module, viewer);
    bind_window(viewer);
    bind_gui(module, viewer);
    bind_server(module, viewer);
    nb::class_<app::Pick> pick(module, "Pick", "The surface at a pixel.");
    pick.def_ro("object", &app::Pick::object, "Name in the scene; 'car/wheel' for a child.")
        .def_ro("part", &app::Pick::part, "Name of the part of the mesh; empty without parts.")
        .def_ro("is_face", &app::Pick::is_face,
                "Whether `element` is a face; else it is a vertex, also of a voxel.")
        .def_ro("element", &app::Pick::element, "Index of the face or vertex in the mesh's own arrays.")
        .def_prop_ro(
            "position", [](const app::Pick& pick) { return matrix_to_numpy(pick.position.transpose()); },
            "Position in world space, relative to the scene's origin.",
            nb::sig("def position(self) -> numpy.ndarray"))
        .def_ro("depth", &app::Pick::depth, "Distance along the optical axis.")
        .def("__repr__", [](const app::Pick& pick) {
            return fmt::format("<Pick: {} {} {} at ({:g}, {:g}, {:g})>", pick.object,
                               pick.is_face ? "face" : "point", pick.element, pick.position.x(),
                               pick.position.y(), pick.position.z());
        });
    bind_pickle(pick);
    module.def("layer_names", [] { return render::layer_names(); });
}

}  // namespace easypbr::python

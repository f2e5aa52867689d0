// Panels, events and messages of a viewer's window, with functions written in Python.
#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include "easypbr/app/widgets.h"
#include "easypbr/gui/live_view.h"
#include "easypbr/python/colormap.h"
#include "easypbr/python/held.h"
#include "easypbr/python/shared_viewer.h"
#include "easypbr/python/text.h"
#include "easypbr/scene/animation.h"

namespace easypbr::python {
namespace {

using app::InputEvent;
using app::Widgets;
using ViewerClass = nb::class_<SharedViewer>;

/// Calls a function of the Python package, which has caught all exceptions but those that end a program:
/// these wait until update() is over. Returns what it returns as a T; nothing when it is None.
template <class T, class... Arguments>
std::optional<T> call(SharedViewer& viewer, const nb::object& function, Arguments&&... arguments) {
    try {
        const nb::object result = function(std::forward<Arguments>(arguments)...);
        return result.is_none() ? std::nullopt : std::optional<T>(nb::cast<T>(result));
    } catch (const std::exception&) {
        viewer.keep_exception(std::current_exception());
        return {};
    }
}

/// `function` takes the widgets and returns a traceback, or None.
void add_panel(SharedViewer& self, const std::string& name, nb::object function) {
    const auto panel = [&self, function = held(std::move(function))](Widgets& widgets) {
        std::optional<std::string> traceback;
        {
            const nb::gil_scoped_acquire gil;
            traceback = call<std::string>(self, *function, nb::cast(&widgets, nb::rv_policy::reference));
        }
        if (traceback) throw Error(*traceback);
    };
    // Servers get another one from the Python package: this one ends with the viewer.
    self.run([&](Viewer& viewer) { viewer.live().add_panel(name, panel); });
}

/// `function` takes an event and returns whether that is all that shall happen.
int on_event(SharedViewer& self, nb::object function) {
    const auto handler = [&self, function = held(std::move(function))](const InputEvent& event) {
        const nb::gil_scoped_acquire gil;
        return call<bool>(self, *function, nb::cast(event)).value_or(false);
    };
    return self.run([&](Viewer& viewer) { return viewer.on_event(handler); });
}

std::string kind_name(const InputEvent& event) {
    constexpr const char* names[] = {"move", "press", "release", "scroll",     "key_down", "key_up",
                                     "text", "drop",  "resize",  "focus_lost", "leave"};
    static_assert(std::size(names) == size_t(InputEvent::Kind::leave) + 1);
    return names[size_t(event.kind)];
}

std::string key_name(const InputEvent& event) {
    namespace k = app::key;
    static const std::map<int, std::string> names = {
        {k::space, "space"},         {k::escape, "escape"}, {k::enter, "enter"}, {k::tab, "tab"},
        {k::backspace, "backspace"}, {k::insert, "insert"}, {k::del, "delete"},  {k::right, "right"},
        {k::left, "left"},           {k::down, "down"},     {k::up, "up"},       {k::page_up, "page_up"},
        {k::page_down, "page_down"}, {k::home, "home"},     {k::end, "end"}};
    if (const auto named = names.find(event.key); named != names.end()) return named->second;
    if (event.key >= k::f1 && event.key <= k::f12) return fmt::format("F{}", event.key - k::f1 + 1);
    if (event.key > ' ' && event.key < 127) return std::string(1, char(event.key));
    return event.key ? fmt::format("key {}", event.key) : "";
}

std::string text_of(const InputEvent& event) {
    if (!event.code) return {};
    return nb::cast<std::string>(nb::module_::import_("builtins").attr("chr")(event.code));
}

std::pair<double, double> pair_of(const Vec2d& values) {
    return {values.x(), values.y()};
}

void bind_event(nb::module_& module) {
    nb::class_<InputEvent>(module, "Event", "An input event of mouse, keyboard or window.")
        .def_prop_ro("kind", kind_name,
                     "'move', 'press', 'release', 'scroll', 'key_down', 'key_up', 'text', 'drop', 'resize', "
                     "'focus_lost' or 'leave'.")
        .def_prop_ro(
            "position", [](const InputEvent& e) { return pair_of(e.position); },
            "Pointer position in pixels from the top left corner of the window.")
        .def_prop_ro(
            "button",
            [](const InputEvent& e) {
                constexpr const char* names[] = {"left", "right", "middle"};
                const bool any = e.kind == InputEvent::Kind::press || e.kind == InputEvent::Kind::release;
                return std::string(any ? names[size_t(e.button)] : "");
            },
            "'left', 'right' or 'middle', for 'press' and 'release'.")
        .def_prop_ro(
            "key", key_name,
            "For 'key_down' and 'key_up': a capital letter, a digit, 'F1', 'space', 'escape', 'left', ...")
        .def_ro("repeat", &InputEvent::repeat,
                "For 'key_down' and 'text': whether the event is a repetition of a key that is held.")
        .def_ro("shift", &InputEvent::shift)
        .def_ro("control", &InputEvent::control)
        .def_ro("alt", &InputEvent::alt)
        .def_prop_ro(
            "scroll", [](const InputEvent& e) { return pair_of(e.scroll); },
            "Wheel steps (x, y); y is positive away from the user.")
        .def_prop_ro("text", text_of, "The typed character, for 'text'.")
        .def_ro("paths", &InputEvent::paths, "Paths of the dropped files, for 'drop'.")
        .def_prop_ro(
            "size", [](const InputEvent& e) { return std::pair(e.size.x(), e.size.y()); },
            "The new (width, height) of the window, for 'resize'.")
        .def("__repr__", [](const InputEvent& e) {
            return fmt::format("<Event: {} {} at ({:g}, {:g})>", kind_name(e), key_name(e), e.position.x(),
                               e.position.y());
        });
}

/// What the widgets of the package's Panel stand on: values go in and come back.
void bind_widgets(nb::module_& module) {
    nb::class_<Widgets>(module, "_Widgets")
        .def("text", &Widgets::text)
        .def("separator", &Widgets::separator)
        .def("same_line", &Widgets::same_line)
        .def("section", &Widgets::section)
        .def("button", &Widgets::button)
        .def("progress", &Widgets::progress)
        .def("checkbox",
             [](Widgets& w, const std::string& name, bool value) {
                 w.checkbox(name, value);
                 return value;
             })
        .def("slider",
             [](Widgets& w, const std::string& name, double value, double low, double high) {
                 w.slider(name, value, low, high);
                 return value;
             })
        .def("slider_int",
             [](Widgets& w, const std::string& name, int value, int low, int high) {
                 w.slider(name, value, low, high);
                 return value;
             })
        .def("number",
             [](Widgets& w, const std::string& name, double value) {
                 w.number(name, value);
                 return value;
             })
        .def("combo",
             [](Widgets& w, const std::string& name, std::string value,
                const std::vector<std::string>& choices) {
                 w.combo(name, value, choices);
                 return value;
             })
        .def("text_field",
             [](Widgets& w, const std::string& name, std::string value) {
                 w.text_field(name, value);
                 return value;
             })
        .def("color",
             [](Widgets& w, const std::string& name, const ArrayLike& value) {
                 Vec3 color = to_vector3(value, "color").cast<float>();
                 w.color(name, color);
                 return vector_to_tuple(color);
             })
        .def(
            "plot",
            [](Widgets& w, const std::string& name, const std::vector<float>& values,
               std::optional<std::pair<float, float>> range) {
                w.plot(name, values, range ? std::optional(Vec2(range->first, range->second)) : std::nullopt);
            },
            nb::arg("name"), nb::arg("values"), nb::arg("range").none());
}

void show_image(SharedViewer& self, const std::string& name, const nb::object& array,
                std::optional<float> min, std::optional<float> max, const nb::object& colormap) {
    Image image = to_image(array, "show_image");
    gui::ImageLook look{min, max, {}};
    if (!colormap.is_none()) look.colormap = parse_colormap(colormap_text(colormap));
    self.show_image(name, std::move(image), look);
}

/// Calls with the viewer's player.
template <class Work>
auto with_player(SharedViewer& self, Work&& work) {
    return self.run([&](Viewer& viewer) { return work(viewer.player()); });
}

void bind_player(ViewerClass& viewer) {
    using app::AnimationPlayer;
    viewer
        .def("play",
             [](SharedViewer& self, const Animations& animations, const std::string& animation, double speed,
                bool loop) { self.run([&](Viewer& v) { v.play(animations, animation, speed, loop); }); })
        .def(
            "resume",
            [](SharedViewer& self, std::optional<double> speed, std::optional<bool> loop) {
                with_player(self, [&](AnimationPlayer& player) {
                    if (player.empty()) return player.resume();  // which throws
                    if (speed) player.set_speed(*speed);
                    if (loop) player.set_loop(*loop);
                    player.resume();
                });
            },
            nb::arg("speed").none(), nb::arg("loop").none())
        .def("pause", [](SharedViewer& self) { self.run([](Viewer& v) { v.pause(); }); })
        .def("is_playing",
             [](SharedViewer& self) {
                 return with_player(self, [](AnimationPlayer& player) { return player.is_playing(); });
             })
        .def_prop_rw(
            "animation_time",
            [](SharedViewer& self) {
                return with_player(self, [](AnimationPlayer& player) { return player.time(); });
            },
            [](SharedViewer& self, double time) {
                with_player(self, [&](AnimationPlayer& player) { player.seek(time); });
            });
}

}  // namespace

void raise_kept(SharedViewer& self) {
    if (const std::exception_ptr kept = self.take_exception()) std::rethrow_exception(kept);
}

bool update_window(SharedViewer& self) {
    const bool open = self.run([](Viewer& viewer) {
        const Uninterrupted whole;
        return viewer.update();
    });
    raise_kept(self);
    return open;
}

void bind_gui(nb::module_& module, ViewerClass& viewer) {
    bind_event(module);
    bind_widgets(module);
    bind_player(viewer);
    viewer.def("add_panel", add_panel)
        .def("remove_panel",
             [](SharedViewer& self, const std::string& name) {
                 self.run([&](Viewer& v) { v.remove_panel(name); });
             })
        .def("show_image", show_image, nb::arg("name"), nb::arg("image"), nb::arg("min").none(),
             nb::arg("max").none(), nb::arg("colormap").none())
        .def("remove_image",
             [](SharedViewer& self, const std::string& name) {
                 self.run([&](Viewer& v) { v.remove_image(name); });
             })
        .def("image_names",
             [](SharedViewer& self) { return self.run([](Viewer& v) { return v.live().images().names(); }); })
        .def("on_event", on_event)
        .def("remove_callback",
             [](SharedViewer& self, int number) { self.run([&](Viewer& v) { v.remove_callback(number); }); })
        .def("notify", [](SharedViewer& self, const std::string& text, bool is_error) {
            self.run([&](Viewer& v) {
                v.live().state().notify(text, is_error);
                v.live().touch();
            });
        });
}

}  // namespace easypbr::python

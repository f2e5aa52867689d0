// The recorder and the clock of a viewer.
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include "easypbr/app/recorder.h"
#include "easypbr/drawing/line_drawing.h"
#include "easypbr/io/video/video.h"
#include "easypbr/python/shared_viewer.h"
#include "easypbr/python/text.h"
#include "easypbr/remote/orbit_page.h"
#include "easypbr/scene/settings.h"

namespace easypbr::python {
namespace {

namespace fs = std::filesystem;

fs::path record(SharedViewer& self, const fs::path& path, const nb::object& size, std::optional<int> samples,
                bool deep) {
    const app::PictureOptions options{optional_size(size), samples};
    return self.run([&](Viewer& viewer) { return viewer.recorder.record(path, options, deep); });
}

void start(SharedViewer& self, const fs::path& path, double fps, const nb::object& size,
           std::optional<int> samples, const std::string& codec, bool deep) {
    const app::RecordingOptions options{fps, optional_size(size), samples, codec, deep};
    self.run([&](Viewer& viewer) { viewer.recorder.start(path, options); });
}

void add_frame(SharedViewer& self, const nb::object& picture) {
    if (picture.is_none()) return self.run([](Viewer& viewer) { viewer.recorder.add_frame(); });
    Image image = to_image(picture, "add_frame: picture");
    self.run([&](Viewer& viewer) { viewer.recorder.add_frame(std::move(image)); });
}

fs::path save_html(SharedViewer& self, const fs::path& path, std::pair<int, int> orbit, double row_step,
                   const nb::object& size, std::optional<int> samples, const std::string& format, int quality,
                   double max_mb, const std::string& title) {
    const app::OrbitPageOptions options{
        orbit.first, orbit.second, row_step, optional_size(size), samples, format, quality, max_mb, title};
    return self.run([&](Viewer& viewer) { return viewer.save_html(path, options); });
}

fs::path save_svg(SharedViewer& self, const fs::path& path, const std::string& hidden,
                  const nb::object& size) {
    const app::LineDrawingOptions options{optional_size(size), drawing::hidden_lines_named(hidden)};
    return self.run([&](Viewer& viewer) { return viewer.save_svg(path, options); });
}

void bind_recording(nb::class_<SharedViewer>& viewer) {
    viewer
        .def("save_html", save_html, nb::arg("path"), nb::arg("orbit"), nb::arg("row_step"),
             nb::arg("size").none(), nb::arg("samples").none(), nb::arg("format"), nb::arg("quality"),
             nb::arg("max_mb"), nb::arg("title"))
        .def("save_svg", save_svg, nb::arg("path"), nb::arg("hidden"), nb::arg("size").none())
        .def("record", record, nb::arg("path"), nb::arg("size").none() = nb::none(),
             nb::arg("samples").none() = nb::none(), nb::arg("deep") = false)
        .def("start_recording", start, nb::arg("path"), nb::arg("fps"), nb::arg("size").none(),
             nb::arg("samples").none(), nb::arg("codec"), nb::arg("deep"))
        .def("add_frame", add_frame, nb::arg("picture").none())
        .def("stop_recording",
             [](SharedViewer& self) {
                 return self.run([](Viewer& viewer) { return viewer.recorder.stop(); });
             })
        .def("is_recording",
             [](SharedViewer& self) {
                 return self.run([](Viewer& viewer) { return viewer.recorder.is_recording(); });
             })
        .def("frame_count",
             [](SharedViewer& self) {
                 return self.run([](Viewer& viewer) { return viewer.recorder.frame_count(); });
             })
        .def(
            "turntable",
            [](SharedViewer& self, double duration_s) {
                return self.run([&](Viewer& viewer) {
                    return app::turntable(viewer.session(), duration_s, viewer.player());
                });
            },
            nb::arg("duration_s"));
}

void bind_clock(nb::class_<SharedViewer>& viewer) {
    viewer
        .def_prop_rw(
            "time", [](SharedViewer& self) { return self.run([](Viewer& viewer) { return viewer.time(); }); },
            [](SharedViewer& self, double time) {
                self.run([&](Viewer& viewer) { viewer.clock().set_time(time); });
            })
        .def_prop_ro(
            "delta_time",
            [](SharedViewer& self) { return self.run([](Viewer& viewer) { return viewer.delta_time(); }); })
        .def_prop_rw(
            "fixed_step",
            [](SharedViewer& self) {
                return self.run([](Viewer& viewer) { return viewer.clock().fixed_step(); });
            },
            [](SharedViewer& self, std::optional<double> step) {
                self.run([&](Viewer& viewer) { viewer.clock().set_fixed_step(step); });
            },
            nb::for_setter(nb::arg("step").none()))
        .def("tick", [](SharedViewer& self) { self.run([](Viewer& viewer) { viewer.clock().tick(); }); });
}

/// A viewer's camera settings, to put back.
/// What imageio-ffmpeg has, where it is installed; empty elsewhere.
fs::path find_ffmpeg() {
    const nb::gil_scoped_acquire gil;
    try {
        return nb::cast<std::string>(nb::module_::import_("easypbr.video").attr("find_ffmpeg")());
    } catch (const nb::python_error& error) {
        throw_as_own(error);
    }
}

struct CameraState {
    CameraSettings settings;
};

}  // namespace

void bind_recorder(nb::module_& module, nb::class_<SharedViewer>& viewer) {
    io::set_ffmpeg_finder(find_ffmpeg);
    const nb::class_<CameraState> state(module, "_CameraState");
    bind_recording(viewer);
    bind_clock(viewer);
    viewer.def_prop_rw(
        "camera_state",
        [](SharedViewer& self) {
            return self.run([](Viewer& viewer) { return CameraState{viewer.settings().camera}; });
        },
        [](SharedViewer& self, const CameraState& state) {
            self.run([&](Viewer& viewer) { viewer.settings().camera = state.settings; });
        });
    module.def("video_encoders", [] { return io::video_encoders(); });
}

}  // namespace easypbr::python

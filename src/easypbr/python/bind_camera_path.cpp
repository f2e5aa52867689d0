// CameraPath: where the camera is at each moment.
#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include "easypbr/core/error.h"
#include "easypbr/geometry/camera_shapes.h"
#include "easypbr/io/settings/camera_path_io.h"
#include "easypbr/python/convert.h"
#include "easypbr/python/pickle.h"
#include "easypbr/python/text.h"
#include "easypbr/scene/camera_path.h"

namespace easypbr::python {
namespace {

template <class Choice>
Choice choice_named(const char* what, const std::string& name, const std::vector<std::string>& names) {
    for (size_t i = 0; i < names.size(); ++i)
        if (names[i] == name) return Choice(i);
    throw ArgumentError(
        fmt::format("camera path: {}: expected {}, got '{}'", what, fmt::join(names, " or "), name));
}

const std::vector<std::string> mode_names{"smooth", "linear"}, ease_names{"none", "in", "out", "in_out"},
    axes_names{"opengl", "opencv"};
enum class Axes { opengl, opencv };

CameraKey key_of(nb::handle object, Axes axes) {
    if (nb::isinstance<Camera>(object)) return CameraKey::at(nb::cast<const Camera&>(object));
    CameraKey key;
    Mat4d T = to_matrix4(object, "camera path: key");
    if (axes == Axes::opencv) T.block<3, 2>(0, 1) *= -1;
    key.T_world_cam.matrix() = T;
    return key;
}

/// One number for all, or one for each of `count`.
std::vector<double> numbers_for(const nb::object& object, size_t count, const char* what) {
    if (nb::isinstance<nb::float_>(object) || nb::isinstance<nb::int_>(object))
        return std::vector<double>(count, nb::cast<double>(object));
    std::vector<double> values;
    for (nb::handle value : object) values.push_back(nb::cast<double>(nb::float_(value)));
    if (values.size() != count)
        throw ArgumentError(
            fmt::format("camera path: {}: expected one number or {}, got {}", what, count, values.size()));
    return values;
}

void construct_camera_path(CameraPath* self, const nb::object& keys, const nb::object& segment_s,
                           const nb::object& fov_y_deg, const std::string& mode, const std::string& ease,
                           bool closed, const std::string& axes) {
    const auto kind = choice_named<Axes>("axes", axes, axes_names);
    std::vector<CameraKey> list;
    for (nb::handle key : keys) list.push_back(key_of(key, kind));
    const size_t segments = closed ? list.size() : std::max<size_t>(list.size(), 1) - 1;
    const std::vector<double> times = numbers_for(segment_s, segments, "segment_s");
    for (size_t i = 0; i < segments; ++i) list[i].segment_s = times[i];
    if (!fov_y_deg.is_none()) {
        const std::vector<double> angles = numbers_for(fov_y_deg, list.size(), "fov_y_deg");
        for (size_t i = 0; i < list.size(); ++i) {
            list[i].fov_y_deg = angles[i];
            list[i].is_calibrated = list[i].is_orthographic = false;
        }
    }
    const CameraPathOptions options{choice_named<PathMode>("mode", mode, mode_names),
                                    choice_named<PathEase>("ease", ease, ease_names), closed};
    new (self) CameraPath(std::move(list), options);
}

CameraPath orbit(const Camera& camera, const ArrayLike& center, const nb::object& axis, double angle_deg,
                 double duration_s, const std::string& ease) {
    const Vec3d direction = axis.is_none() ? Vec3d::UnitY() : to_vector3(axis, "orbit: axis");
    return CameraPath::orbit(camera, to_vector3(center, "orbit: center"), direction, angle_deg, duration_s,
                             choice_named<PathEase>("ease", ease, ease_names));
}

void bind_camera_path_makers(nb::class_<CameraPath>& path) {
    path.def("__init__", construct_camera_path, nb::arg("keys"), nb::arg("segment_s") = 1.0,
             nb::arg("fov_y_deg").none() = nb::none(), nb::arg("mode") = "smooth", nb::arg("ease") = "none",
             nb::arg("closed") = false, nb::arg("axes") = "opengl",
             nb::sig(
                 "def __init__(self, keys: collections.abc.Iterable[Camera | numpy.typing.ArrayLike], "
                 "segment_s: float | collections.abc.Iterable[float] = 1.0, fov_y_deg: float | "
                 "collections.abc.Iterable[float] | None = None, mode: str = 'smooth', ease: str = 'none', "
                 "closed: bool = False, axes: str = 'opengl') -> None"),
             "Path through cameras or 4 x 4 poses T_world_cam with OpenGL or OpenCV axes. segment_s: "
             "seconds between keys, one number or one per segment. fov_y_deg: of each key; "
             "by default that of its camera, or what lies between those of its neighbours. "
             "mode: 'smooth' (continuous velocity and acceleration) or 'linear'. "
             "ease: 'none', 'in', 'out' or 'in_out'. closed: returns to the first key and repeats.")
        .def_static(
            "orbit", orbit, nb::arg("camera"), nb::arg("center") = nb::make_tuple(0, 0, 0),
            nb::arg("axis").none() = nb::none(), nb::arg("angle_deg") = 360.0, nb::arg("duration_s") = 4.0,
            nb::arg("ease") = "none",
            nb::sig("def orbit(camera: Camera, center: numpy.typing.ArrayLike = (0, 0, 0), axis: "
                    "numpy.typing.ArrayLike | None = None, angle_deg: float = 360.0, duration_s: float = "
                    "4.0, ease: str = 'none') -> CameraPath"),
            "Circle that starts at the camera's pose, around the line through `center` along `axis`, default "
            "(0, 1, 0). Orthographic cameras have the height of that one all the way.")
        .def_static(
            "load",
            [](const std::filesystem::path& file) {
                return released([&] { return io::load_camera_path(file); });
            },
            nb::arg("path"), "Reads a JSON file.")
        .def(
            "save",
            [](const CameraPath& p, const std::filesystem::path& file) {
                released([&] { io::save_camera_path(p, file); });
            },
            nb::arg("path"), "Writes a JSON file atomically; numbers are restored bit for bit.");
}

void bind_times(nb::class_<CameraPath>& path) {
    path.def_prop_ro("duration_s", &CameraPath::duration_s)
        .def_prop_ro("closed", &CameraPath::is_closed)
        .def_prop_ro("key_times_s", &CameraPath::key_times_s,
                     "Times of the keys, easing included; of an orbit its start and end.")
        .def_prop_ro(
            "keys",
            [](const CameraPath& p) {
                nb::list keys;
                for (const CameraKey& key : p.keys()) keys.append(matrix_to_numpy(key.T_world_cam.matrix()));
                return keys;
            },
            nb::sig("def keys(self) -> list[numpy.ndarray]"),
            "4 x 4 poses of the keys, OpenGL axes; none for an orbit.")
        .def("frame_times", &CameraPath::frame_times, nb::arg("fps"),
             "Times of the frames of a video: round(duration * fps) for a closed path, but at least 1, "
             "and one more for an open one.")
        .def("times", &CameraPath::times, nb::arg("count"),
             "That many evenly spaced times; of a closed path without the end.")
        .def("frame_rate", &CameraPath::frame_rate, nb::arg("count"),
             "Frames per second with which the frames at times(count) show the path in its duration.");
}

}  // namespace

void bind_camera_path(nb::module_& module) {
    nb::class_<CameraPath> path(module, "CameraPath", "Camera motion through key poses.");
    bind_camera_path_makers(path);
    bind_times(path);
    bind_pickle(path);
    path.def(
            "pose", [](const CameraPath& p, double time) { return matrix_to_numpy(p.pose(time).matrix()); },
            nb::arg("time_s"), nb::sig("def pose(self, time_s: float) -> numpy.ndarray"),
            "4 x 4 pose T_world_cam at a time, OpenGL axes.")
        .def(
            "camera",
            [](const CameraPath& p, double time, const std::optional<Camera>& like) {
                return p.camera(time, like.value_or(Camera()));
            },
            nb::arg("time_s"), nb::arg("like").none() = nb::none(),
            "Camera at a time, with the path's field of view if it has one, else like `like`.");
    module.def(
        "_camera_path",
        [](const CameraPath& p, const ArrayLike& size, double fov_y_deg, std::optional<double> depth) {
            return make_camera_path(p, to_size(size, "camera_path: size"), fov_y_deg, depth);
        },
        nb::arg("path"), nb::arg("size"), nb::arg("fov_y_deg"), nb::arg("depth").none());
}

}  // namespace easypbr::python

// Camera: poses and projections, in OpenGL's and in OpenCV's axes.
#include <fmt/format.h>
#include <nanobind/stl/vector.h>

#include "easypbr/core/ascii.h"
#include "easypbr/core/error.h"
#include "easypbr/python/convert.h"
#include "easypbr/python/pickle.h"
#include "easypbr/python/text.h"
#include "easypbr/scene/camera.h"

namespace easypbr::python {
namespace {

Camera look_at(const ArrayLike& position, const ArrayLike& target, const nb::object& up, double fov_y_deg) {
    const Vec3d up_vector = up.is_none() ? Vec3d::UnitY() : to_vector3(up, "up");
    Camera camera =
        Camera::look_at(to_vector3(position, "position"), to_vector3(target, "target"), up_vector);
    camera.fov_y_deg = fov_y_deg;
    return camera;
}

DistortionModel model_named(const std::string& name) {
    if (ascii::same_letters(name, "brown_conrady")) return DistortionModel::brown_conrady;
    if (ascii::same_letters(name, "fisheye")) return DistortionModel::fisheye;
    throw ArgumentError(fmt::format("model: expected brown_conrady or fisheye, got '{}'", name));
}

/// OpenCV's functions return them as n, 1 x n or n x 1.
std::vector<double> coefficients_of(const nb::object& distortion) {
    if (distortion.is_none()) return {};
    const nb::object values = numeric_object(distortion, "distortion").attr("astype")("float64");
    return nb::cast<std::vector<double>>(values.attr("ravel")().attr("tolist")());
}

Camera from_opencv(const ArrayLike& K, const ArrayLike& T_world_cam, const ArrayLike& size,
                   const nb::object& distortion, const std::string& model, const std::string& axes) {
    const Vec2i pixels = to_size(size, "size");
    Mat4d T = to_matrix4(T_world_cam, "T_world_cam");
    if (ascii::same_letters(axes, "opengl"))
        T.topLeftCorner<3, 3>() *= Vec3d(1, -1, -1).asDiagonal();
    else if (!ascii::same_letters(axes, "opencv"))
        throw ArgumentError(fmt::format("axes: expected opencv or opengl, got '{}'", axes));
    Camera camera = Camera::from_opencv(to_matrix3(K, "K"), T, pixels.x(), pixels.y());
    const DistortionModel known = model_named(model);
    const std::vector<double> coefficients = coefficients_of(distortion);
    if (!coefficients.empty()) camera.distortion = Distortion::from_coefficients(known, coefficients);
    return camera;
}

void set_pose(Camera& camera, const ArrayLike& T_world_cam) {
    camera.T_world_cam =
        Camera::from_opengl(to_matrix4(T_world_cam, "T_world_cam"), camera.fov_y_deg).T_world_cam;
}

void set_projection(Camera& camera, const std::string& name) {
    const bool is_perspective = ascii::same_letters(name, "perspective");
    if (!is_perspective && !ascii::same_letters(name, "orthographic"))
        throw ArgumentError(
            fmt::format("camera.projection: expected perspective or orthographic, got '{}'", name));
    camera.projection = is_perspective ? Projection::perspective : Projection::orthographic;
}

void bind_camera_makers(nb::class_<Camera>& camera) {
    camera
        .def_static("look_at", look_at, nb::arg("position"), nb::arg("target"),
                    nb::arg("up").none() = nb::none(), nb::arg("fov_y_deg") = 30.0,
                    nb::sig("def look_at(position: numpy.typing.ArrayLike, target: numpy.typing.ArrayLike, "
                            "up: numpy.typing.ArrayLike | None = None, fov_y_deg: float = 30.0) -> Camera"),
                    "Camera at a position that looks at a target; up defaults to (0, 1, 0).")
        .def_static("from_opencv", from_opencv, nb::arg("K"), nb::arg("T_world_cam"), nb::arg("size"),
                    nb::arg("distortion").none() = nb::none(), nb::arg("model") = "brown_conrady",
                    nb::arg("axes") = "opencv",
                    nb::sig("def from_opencv(K: numpy.typing.ArrayLike, T_world_cam: "
                            "numpy.typing.ArrayLike, size: numpy.typing.ArrayLike, distortion: "
                            "numpy.typing.ArrayLike | None = None, model: str = 'brown_conrady', axes: str "
                            "= 'opencv') -> Camera"),
                    "From OpenCV's K (pixel centres at integers), a camera-to-world pose with OpenCV axes "
                    "(or axes='opengl'), and the (width, height) of K. `distortion`: 4, 5 or 8 coefficients "
                    "in OpenCV's order, in an array of any shape, or 12 or 14 of which those after the "
                    "eighth are 0; 4 for the model 'fisheye'.")
        .def_static(
            "from_opengl",
            [](const ArrayLike& T, double fov_y_deg) {
                return Camera::from_opengl(to_matrix4(T, "T_world_cam"), fov_y_deg);
            },
            nb::arg("T_world_cam"), nb::arg("fov_y_deg") = 30.0,
            "From a camera-to-world pose with OpenGL axes (x right, y up, z backwards).");
}

}  // namespace

void bind_camera(nb::module_& module) {
    nb::class_<Camera> camera(module, "Camera", "A pinhole or orthographic camera with a pose.");
    camera.def(nb::init<>());
    bind_camera_makers(camera);
    bind_copies(camera, [](const Camera& c) { return c; });
    bind_pickle(camera);
    camera
        .def_prop_rw(
            "T_world_cam", [](const Camera& c) { return matrix_to_numpy(c.T_world_cam.matrix()); }, set_pose,
            nb::for_getter(nb::sig("def T_world_cam(self) -> numpy.ndarray")),
            "4 x 4 camera-to-world matrix, OpenGL axes.")
        .def_prop_ro(
            "position", [](const Camera& c) { return matrix_to_numpy(c.position().transpose()); },
            nb::sig("def position(self) -> numpy.ndarray"))
        .def_prop_rw(
            "projection",
            [](const Camera& c) {
                return c.projection == Projection::perspective ? "perspective" : "orthographic";
            },
            set_projection, "'perspective' or 'orthographic'.")
        .def_rw("fov_y_deg", &Camera::fov_y_deg,
                "Vertical field of view in degrees; perspective cameras without intrinsics.")
        .def_rw("ortho_height", &Camera::ortho_height,
                "Height of the view volume of an orthographic camera, world units.")
        .def_rw(
            "near", &Camera::near,
            "Distance to the near plane. A view that is given a camera infers its own, unless the setting "
            "camera.near says it.")
        .def(
            "opencv_K",
            [](const Camera& c, const ArrayLike& size) {
                const Vec2i pixels = to_size(size, "size");
                return matrix_to_numpy(c.opencv_K(pixels.x(), pixels.y()));
            },
            nb::arg("size"), nb::sig("def opencv_K(self, size: numpy.typing.ArrayLike) -> numpy.ndarray"),
            "OpenCV's K for an image of (width, height).")
        .def_prop_ro(
            "distortion",
            [](const Camera& c) {
                return c.distortion ? c.distortion->coefficients() : std::vector<double>();
            },
            "Lens distortion coefficients in OpenCV's order; empty: none.")
        .def_prop_ro(
            "opencv_T_world_cam", [](const Camera& c) { return matrix_to_numpy(c.opencv_T_world_cam()); },
            nb::sig("def opencv_T_world_cam(self) -> numpy.ndarray"),
            "4 x 4 camera-to-world matrix, OpenCV axes.");
}

}  // namespace easypbr::python

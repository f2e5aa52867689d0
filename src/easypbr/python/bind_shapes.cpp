// Shapes made in code: the module easypbr.shapes.
#include <fmt/format.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>

#include <optional>
#include <span>

#include "easypbr/core/error.h"
#include "easypbr/geometry/camera_shapes.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/geometry/voxels.h"
#include "easypbr/python/convert.h"
#include "easypbr/python/text.h"

namespace easypbr::python {
namespace {

/// One number for all three sides, or three.
Vec3 to_box_size(nb::handle object) {
    if (nb::isinstance<nb::float_>(object) || nb::isinstance<nb::int_>(object))
        return Vec3::Constant(nb::cast<float>(object));
    return to_vector3(object, "box: size").cast<float>();
}

Vec2i frustum_size(const Camera& camera, const nb::object& size, const Image& image) {
    if (!size.is_none()) return to_size(size, "camera_frustum: size");
    if (!image.empty()) return {image.width(), image.height()};
    if (camera.intrinsics) return {camera.intrinsics->width, camera.intrinsics->height};
    throw ArgumentError(
        "camera_frustum: expected a size, (width, height), or an image: this camera fits pictures of any "
        "shape");
}

Mesh camera_frustum(const Camera& camera, const nb::object& image, const nb::object& size, double depth) {
    const Image picture = image.is_none() ? Image() : to_image(image, "camera_frustum: image");
    const Vec2i pixels = frustum_size(camera, size, picture);
    return released([&] { return make_camera_frustum(camera, pixels, depth, picture); });
}

using CellValues = nb::ndarray<nb::ro, nb::device::cpu, nb::c_contig>;

template <class Scalar>
std::span<const Scalar> values_of(const CellValues& array) {
    return {static_cast<const Scalar*>(array.data()), array.size()};
}

/// `values`: a contiguous array of nx x ny x nz (x 3 or 4) uint8, int32 or float32 that easypbr.shapes
/// prepared.
Mesh voxels(const CellValues& values, const ArrayLike& origin, double cell_size, int32_t empty) {
    VoxelGrid grid;
    for (size_t axis = 0; axis < 3; ++axis) grid.cells[axis] = int(values.shape(axis));
    grid.origin = to_vector3(origin, "voxel_grid: origin");
    grid.cell_size = cell_size;
    return released([&] {
        if (values.dtype() == nb::dtype<uint8_t>()) return make_voxels(grid, values_of<uint8_t>(values));
        if (values.dtype() == nb::dtype<int32_t>())
            return make_voxels(grid, values_of<int32_t>(values), empty);
        const auto rows = Eigen::Index(values.shape(0) * values.shape(1) * values.shape(2));
        const auto* data = static_cast<const float*>(values.data());
        return make_voxels(grid, ArrayXf(nullptr, data, rows, Eigen::Index(values.shape(3))));
    });
}

using FieldRows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// The object's numbers as n x 3 in double precision.
FieldRows to_field(nb::handle object, const char* what) {
    const nb::object numbers = numeric_object(object, what);
    const AnyArray given = numeric_array(numbers, what);
    if (given.ndim() != 2 || given.shape(1) != 3)
        throw ArgumentError(fmt::format("{}: expected n x 3, got {}", what, shape_text(given)));
    const nb::object doubles = nb::module_::import_("numpy").attr("ascontiguousarray")(numbers, "float64");
    const auto rows = nb::cast<nb::ndarray<nb::ro, const double, nb::device::cpu, nb::c_contig>>(doubles);
    return Eigen::Map<const FieldRows>(rows.data(), Eigen::Index(rows.shape(0)), 3);
}

Mesh arrows(const ArrayLike& starts, const ArrayLike& vectors, std::optional<double> scale,
            std::optional<double> radius, int segments, const nb::object& values, const nb::object& colors,
            bool strict) {
    const Array3d from = to_field(starts, "arrows: starts"), along = to_field(vectors, "arrows: vectors");
    ArrowOptions options{.scale = scale, .radius = radius, .segments = segments, .strict = strict};
    RoundingCounts rounding;
    if (!values.is_none()) {
        const nb::object numbers = flags_as_numbers(values, "arrows: values");
        options.values = to_array<float, 1>(numbers, {"values", 1, 1});
        rounding = rounding_of(numbers, {"values", 1, 1});
    }
    if (!colors.is_none()) options.colors = to_colors(colors, {"colors", 3, 4});
    return released([&] {
        Mesh mesh = make_arrows(from, along, options);
        warn_of_rounding("", "value", rounding);
        return mesh;
    });
}

void bind_round_shapes(nb::module_& module) {
    module.def(
        "sphere",
        [](float radius, int segments) { return released([&] { return make_sphere(radius, segments); }); },
        nb::arg("radius") = 1.0f, nb::arg("segments") = 64, "A UV sphere.");
    module.def(
        "icosphere",
        [](float radius, int subdivisions) {
            return released([&] { return make_icosphere(radius, subdivisions); });
        },
        nb::arg("radius") = 1.0f, nb::arg("subdivisions") = 3,
        "A sphere of 20 * 4^subdivisions nearly equal triangles that share their vertices; without uv.");
    module.def(
        "cylinder",
        [](float radius, float height, int segments) {
            return released([&] { return make_cylinder(radius, height, segments); });
        },
        nb::arg("radius") = 0.5f, nb::arg("height") = 1.0f, nb::arg("segments") = 64, "A closed cylinder.");
    module.def(
        "cone",
        [](float radius, float height, int segments) {
            return released([&] { return make_cone(radius, height, segments); });
        },
        nb::arg("radius") = 0.5f, nb::arg("height") = 1.0f, nb::arg("segments") = 64,
        "A closed cone, its tip up.");
    module.def(
        "torus",
        [](float radius, float tube_radius, int segments, int tube_segments) {
            return released([&] { return make_torus(radius, tube_radius, segments, tube_segments); });
        },
        nb::arg("radius") = 1.0f, nb::arg("tube_radius") = 0.25f, nb::arg("segments") = 64,
        nb::arg("tube_segments") = 32,
        "A torus around the y axis; the radius is that of the tube's centre line.");
    module.def(
        "capsule",
        [](float radius, float height, int segments) {
            return released([&] { return make_capsule(radius, height, segments); });
        },
        nb::arg("radius") = 0.5f, nb::arg("height") = 1.0f, nb::arg("segments") = 64,
        "A capsule: a cylinder with hemispheres as caps, whose centres are `height` apart.");
}

void bind_flat_shapes(nb::module_& module) {
    module.def(
        "box", [](const ArrayLike& size) { return make_box(to_box_size(size)); }, nb::arg("size") = 1.0f,
        nb::sig("def box(size: float | numpy.typing.ArrayLike = 1.0) -> Mesh"),
        "An axis-aligned box; one side or (x, y, z).");
    module.def(
        "plane",
        [](float size, int divisions) { return released([&] { return make_plane(size, divisions); }); },
        nb::arg("size") = 1.0f, nb::arg("divisions") = 1,
        "A square in the xz plane, facing up, of divisions x divisions quads.");
    module.def(
        "grid",
        [](float size, int divisions) { return released([&] { return make_grid(size, divisions); }); },
        nb::arg("size") = 10.0f, nb::arg("divisions") = 10,
        "Lines of a square grid in the xz plane with divisions x divisions cells; edges only.");
    module.def(
        "teapot",
        [](float height, int subdivisions) {
            return released([&] { return make_teapot(height, subdivisions); });
        },
        nb::arg("height") = 1.0f, nb::arg("subdivisions") = 16, "Newell's teapot, standing on y = 0.");
}

void bind_signs(nb::module_& module) {
    module.def(
        "arrow",
        [](const ArrayLike& start, const ArrayLike& end, std::optional<float> radius, int segments) {
            return make_arrow(to_vector3(start, "arrow: start").cast<float>(),
                              to_vector3(end, "arrow: end").cast<float>(), radius, segments);
        },
        nb::arg("start"), nb::arg("end"), nb::arg("radius").none() = nb::none(), nb::arg("segments") = 32,
        "An arrow between two points; `radius` is that of the shaft, default 1/40 of the length.");
    module.def(
        "arrows", arrows, nb::arg("starts"), nb::arg("vectors"), nb::arg("scale") = nb::none(),
        nb::arg("radius") = nb::none(), nb::arg("segments") = 12, nb::arg("values").none() = nb::none(),
        nb::arg("colors").none() = nb::none(), nb::arg("strict") = false,
        nb::sig("def arrows(starts: numpy.typing.ArrayLike, vectors: numpy.typing.ArrayLike, scale: float | "
                "None = None, radius: float | None = None, segments: int = 12, values: "
                "numpy.typing.ArrayLike | None = None, colors: numpy.typing.ArrayLike | None = None, strict: "
                "bool = False) -> Mesh"),
        "Arrows of a vector field, n x 3 starts and vectors, as one mesh. Lengths are those of the vectors "
        "times `scale`: 1 for true lengths, by default such that the longest arrow is as long as "
        "neighbouring starts are apart, but at least a fiftieth of the diagonal of their box. "
        "`radius` is that of all shafts, default 1/40 of the longest arrow and at most 1/12 of each. "
        "Vectors of length 0 have no arrow. `values`, n, are scalars \"value\" that colour the arrows; "
        "the vectors' lengths are scalars \"length\", which do when asked for. "
        "Rows that are not finite are left out with a warning, or raise ArgumentError if strict.");
    module.def(
        "axes", [](float length, std::optional<float> radius) { return make_axes(length, radius); },
        nb::arg("length") = 1.0f, nb::arg("radius").none() = nb::none(),
        "Arrows along x, y and z from the origin, coloured red, green and blue.");
    module.def("_camera_frustum", camera_frustum, nb::arg("camera"), nb::arg("image").none(),
               nb::arg("size").none(), nb::arg("depth"));
    module.def("_voxels", voxels, nb::arg("values"), nb::arg("origin"), nb::arg("cell_size"),
               nb::arg("empty"));
}

}  // namespace

void bind_shapes(nb::module_& module) {
    bind_round_shapes(module);
    bind_flat_shapes(module);
    bind_signs(module);
}

}  // namespace easypbr::python

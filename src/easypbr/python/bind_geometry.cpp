// Methods of Mesh that make new meshes: placed, repaired, coarser, finer.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <optional>

#include "easypbr/core/ascii.h"
#include "easypbr/core/error.h"
#include "easypbr/core/suggest.h"
#include "easypbr/geometry/place.h"
#include "easypbr/geometry/remesh.h"
#include "easypbr/geometry/repair.h"
#include "easypbr/geometry/sample.h"
#include "easypbr/geometry/tubes.h"
#include "easypbr/python/convert.h"
#include "easypbr/python/text.h"

namespace easypbr::python {
namespace {

using MeshClass = nb::class_<Mesh>;

Mesh merge(const Mesh& first, const nb::args& others) {
    std::vector<Mesh> meshes{first};
    for (const nb::handle other : others) {
        if (!nb::isinstance<Mesh>(other)) throw ArgumentError("merge: expected meshes, got something else");
        meshes.push_back(nb::cast<Mesh>(other));
    }
    return released([&] { return merged(std::span<const Mesh>(meshes)); });
}

nb::object box_array(const Mesh& mesh, const nb::object& T) {
    const Eigen::Affine3d T_world_mesh = T.is_none() ? mesh.T_parent_mesh() : to_affine(T, "T_world_mesh");
    const Box3d box = released([&] { return bounding_box(mesh, T_world_mesh); });
    Eigen::MatrixXd corners(2, 3);
    corners << box.min().transpose(), box.max().transpose();
    return matrix_to_numpy(corners);
}

nb::tuple oriented_box(const Mesh& mesh) {
    const OrientedBox box = released([&] { return oriented_bounding_box(mesh); });
    return nb::make_tuple(matrix_to_numpy(box.T_world_box.matrix()), matrix_to_numpy(box.size.transpose()));
}

Mesh subsample(const Mesh& mesh, std::optional<int64_t> count, std::optional<double> fraction,
               std::optional<double> cell_size, uint64_t seed) {
    if (count.has_value() + fraction.has_value() + cell_size.has_value() != 1)
        throw ArgumentError("subsample: expected one of count, fraction and cell_size");
    if (fraction && !(*fraction >= 0 && *fraction <= 1))
        throw ArgumentError("subsample: fraction: expected a number from 0 to 1");
    return released([&] {
        if (cell_size) return subsample_voxels(mesh, *cell_size);
        const double share = fraction.value_or(0) * double(mesh.V().rows());
        return subsample_random(mesh, count ? *count : std::llround(share), seed);
    });
}

template <class Choice>
Choice chosen(const char* what, const std::string& name,
              const std::vector<std::pair<std::string, Choice>>& choices) {
    std::vector<std::string> names;
    for (const auto& [known, choice] : choices) {
        if (ascii::same_letters(known, name)) return choice;
        names.push_back(known);
    }
    throw ArgumentError(std::string(what) + ": expected '" + names[0] + "' or '" + names[1] + "', got '" +
                        name + "'" + did_you_mean(name, names));
}

void bind_placing(MeshClass& mesh) {
    mesh.def(
            "transform",
            [](const Mesh& m, const ArrayLike& T) {
                const Eigen::Affine3d affine = to_affine(T, "transform");
                return released([&] { return transformed(m, affine); });
            },
            nb::arg("T"),
            "A new mesh with vertices, offset included, transformed by T (4 x 4), and normals, "
            "winding order, tangents and children with them. T_parent_mesh is kept.")
        .def(
            "center", [](const Mesh& m) { return released([&] { return centered(m); }); },
            "A new mesh with the centre of its bounding box at its origin.")
        .def(
            "normalize_size",
            [](const Mesh& m, double size) { return released([&] { return with_size(m, size); }); },
            nb::arg("size") = 1.0,
            "A new mesh scaled about its origin, so that the longest side of its bounding box is `size`.")
        .def("merge", merge, nb::sig("def merge(self, *others: Mesh) -> Mesh"),
             "One new mesh of this and the others, children included, with their poses applied. Materials "
             "and parts are kept; missing attributes are filled in: normals as they are drawn, white, "
             "labels -1, scalars NaN, else 0.")
        .def("bounding_box", box_array, nb::arg("T_world_mesh").none() = nb::none(),
             nb::sig("def bounding_box(self, T_world_mesh: numpy.typing.ArrayLike | None = None) -> "
                     "numpy.ndarray"),
             "2 x 3: lowest and highest corner of all vertices, children included, after T_world_mesh "
             "(default: T_parent_mesh). The offset of the mesh is included: less scene.origin the box is in "
             "the scene's frame.")
        .def("oriented_bounding_box", oriented_box,
             nb::sig("def oriented_bounding_box(self) -> tuple[numpy.ndarray, numpy.ndarray]"),
             "A small oriented bounding box: its 4 x 4 pose (centre and axes; the offset of the mesh "
             "included) and its sizes along the axes, in descending order.");
}

void bind_repair(MeshClass& mesh) {
    mesh.def(
            "remove_unreferenced_vertices",
            [](const Mesh& m) { return released([&] { return remove_unreferenced_vertices(m); }); },
            "A new mesh without vertices that no face or edge references. A cloud is not changed.")
        .def(
            "remove_duplicate_vertices",
            [](const Mesh& m, double tolerance, bool keep_seams) {
                return released([&] { return remove_duplicate_vertices(m, {tolerance, keep_seams}); });
            },
            nb::arg("tolerance") = 0.0, nb::arg("keep_seams") = true,
            "A new mesh with vertices merged that have equal positions (within the tolerance) and "
            "attributes; with keep_seams=False with any attributes.")
        .def(
            "remove_degenerate_faces",
            [](const Mesh& m) { return released([&] { return remove_degenerate_faces(m); }); },
            "A new mesh without degenerate faces.")
        .def(
            "flip_winding", [](const Mesh& m) { return released([&] { return flip_winding(m); }); },
            "A new mesh with reversed winding order.")
        .def(
            "flip_normals", [](const Mesh& m) { return released([&] { return flip_normals(m); }); },
            "A new mesh with negated normals.")
        .def(
            "split", [](const Mesh& m) { return released([&] { return split(m); }); },
            "The connected components as new meshes.")
        .def(
            "vertex_components",
            [](const Mesh& m) { return view_of(released([&] { return vertex_components(m); })); },
            nb::sig("def vertex_components(self) -> numpy.ndarray"),
            "n int32: index of the connected component of each vertex.")
        .def(
            "face_components",
            [](const Mesh& m) { return view_of(released([&] { return face_components(m); })); },
            nb::sig("def face_components(self) -> numpy.ndarray"),
            "m int32: index of the connected component of each face.");
}

void bind_resolution(MeshClass& mesh) {
    mesh.def("subsample", subsample, nb::arg("count") = nb::none(), nb::arg("fraction") = nb::none(),
             nb::arg("cell_size") = nb::none(), nb::arg("seed") = 0,
             "A new cloud of fewer vertices: `count` or a `fraction` of them at random, or the mean of those "
             "in each grid cell of edge `cell_size`.")
        .def(
            "voxelize",
            [](const Mesh& m, double cell_size) { return released([&] { return voxelize(m, cell_size); }); },
            nb::arg("cell_size"), "The occupied cells of a grid as a new mesh of voxels.")
        .def(
            "decimate",
            [](const Mesh& m, std::optional<int> faces, std::optional<double> error) {
                return released([&] { return decimate(m, {faces, error}); });
            },
            nb::arg("faces") = nb::none(), nb::arg("error") = nb::none(),
            "A new mesh simplified to at most `faces`, or up to a surface error of `error`. Vertices keep "
            "their attributes.")
        .def(
            "upsample",
            [](const Mesh& m, int iterations, const std::string& method) {
                const Subdivision rule =
                    chosen<Subdivision>("upsample: method", method,
                                        {{"midpoint", Subdivision::midpoint}, {"loop", Subdivision::loop}});
                return released([&] { return upsample(m, iterations, rule); });
            },
            nb::arg("iterations") = 1, nb::arg("method") = "midpoint",
            "A new mesh with every face subdivided into four; method 'loop' smooths the surface.")
        .def(
            "smooth",
            [](const Mesh& m, int iterations, const std::string& method) {
                const Smoothing rule =
                    chosen<Smoothing>("smooth: method", method,
                                      {{"taubin", Smoothing::taubin}, {"laplacian", Smoothing::laplacian}});
                return released([&] { return smooth(m, iterations, rule); });
            },
            nb::arg("iterations") = 10, nb::arg("method") = "taubin",
            "A new mesh smoothed by moving vertices towards the mean of their neighbours; 'taubin' keeps the "
            "size, 'laplacian' shrinks. Borders are kept.");
}

Keep keep_of(bool invert) {
    return invert ? Keep::outside : Keep::inside;
}

void bind_cuts(MeshClass& mesh) {
    mesh.def(
            "crop_box",
            [](const Mesh& m, const ArrayLike& low, const ArrayLike& high, bool invert) {
                const Box3d box(to_vector3(low, "crop_box: low"), to_vector3(high, "crop_box: high"));
                return released([&] { return crop_box(m, box, keep_of(invert)); });
            },
            nb::arg("low"), nb::arg("high"), nb::arg("invert") = false,
            "A new mesh of the vertices between two corners, in the mesh's own frame, and of the faces and "
            "edges whose vertices all stay; with `invert` of those outside. Splats count by their means.")
        .def(
            "crop_sphere",
            [](const Mesh& m, const ArrayLike& center, double radius, bool invert) {
                const Vec3d c = to_vector3(center, "crop_sphere: center");
                return released([&] { return crop_sphere(m, c, radius, keep_of(invert)); });
            },
            nb::arg("center"), nb::arg("radius"), nb::arg("invert") = false,
            "A new mesh of the vertices within a sphere, as crop_box().");
}

void bind_splats(MeshClass& mesh) {
    const SplatLimits none;
    mesh.def(
            "prune_splats",
            [](const Mesh& m, double opacity, double min_size, double max_size) {
                return released([&] { return prune_splats(m, {opacity, min_size, max_size}); });
            },
            nb::arg("min_opacity") = none.least_opacity, nb::arg("min_size") = none.least_size,
            nb::arg("max_size") = none.most_size,
            "A new mesh of the splats of at least this opacity, whose standard deviation along the longest "
            "axis lies within the sizes.")
        .def(
            "decimate_splats",
            [](const Mesh& m, int64_t count) { return released([&] { return decimate_splats(m, count); }); },
            nb::arg("count"),
            "A new mesh of at most `count` splats: neighbours are merged, those first that look most alike.")
        .def(
            "to_cloud", [](const Mesh& m) { return released([&] { return cloud_from_splats(m); }); },
            "A new cloud of the means of splats, with their colours and, as alpha, opacities.")
        .def(
            "to_mesh",
            [](const Mesh& m, int resolution, double level) {
                return released([&] { return mesh_from_splats(m, {resolution, level}); });
            },
            nb::arg("resolution") = SplatMeshOptions{}.resolution,
            nb::arg("level") = SplatMeshOptions{}.level,
            "A new triangle mesh of the surface of splats: where their density, "
            "the sum of opacity exp(-d^2 / 2) with d in standard deviations, is `level`, "
            "above 0 and below 1. `resolution`: cells of the grid along the longest side, 8 to 512. "
            "With the splats' colours, and their labels if they have some.");
}

/// `radius`: None, a number, or one for each vertex.
Mesh to_tubes(const Mesh& mesh, const nb::object& radius, int sides, const std::string& ends) {
    TubeOptions options;
    options.sides = sides;
    options.ends =
        chosen<TubeEnds>("to_tubes: ends", ends, {{"round", TubeEnds::round}, {"flat", TubeEnds::flat}});
    if (!radius.is_none()) {
        const nb::object numbers = numeric_object(radius, "to_tubes: radius");
        if (numeric_array(numbers, "to_tubes: radius").ndim() == 0)
            options.radius = nb::cast<double>(numbers.attr("item")());
        else
            options.radii = to_array<float, 1>(numbers, {"radius", 1, 1});
    }
    return released([&] { return make_tubes(mesh, options); });
}

void bind_lines(MeshClass& mesh) {
    mesh.def(
        "to_tubes", to_tubes, nb::arg("radius").none() = nb::none(), nb::arg("sides") = 12,
        nb::arg("ends") = "round",
        nb::sig("def to_tubes(self, radius: numpy.typing.ArrayLike | None = None, sides: int = 12, ends: "
                "str = 'round') -> Mesh"),
        "A new mesh of closed tubes along the edges (E), with what the vertices have. `radius`: a number, "
        "one for each vertex, or by default 1/200 of the diagonal of the box. Lines are mitred at "
        "corners and end in half spheres at branches and sharp turns, and at their ends, which may be "
        "'flat'. Faces are kept, before the tubes; style.flat is not: faces that it draws flat get normals "
        "that look the same, and the tubes are smooth.");
}

}  // namespace

void bind_geometry(nb::module_&) {
    auto mesh = nb::borrow<MeshClass>(nb::type<Mesh>());
    bind_placing(mesh);
    bind_repair(mesh);
    bind_resolution(mesh);
    bind_cuts(mesh);
    bind_splats(mesh);
    bind_lines(mesh);
}

}  // namespace easypbr::python

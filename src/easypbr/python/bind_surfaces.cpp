// What measures surfaces: normals, points on the surface, distances, rays.
#include <nanobind/stl/optional.h>

#include "easypbr/core/error.h"
#include "easypbr/geometry/nearest.h"
#include "easypbr/geometry/rays.h"
#include "easypbr/geometry/sample.h"
#include "easypbr/python/convert.h"
#include "easypbr/python/pickle.h"
#include "easypbr/python/text.h"
#include "easypbr/scene/normals.h"

namespace easypbr::python {
namespace {

using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

nb::tuple closest_points(const Mesh& mesh, const ArrayLike& queries) {
    const Vec3d offset = mesh.offset();
    const Array3f points = to_local(queries, {"queries", 3, 3}, offset);
    Points found;
    SurfaceTree::Nearest nearest = released([&] {
        SurfaceTree::Nearest result = SurfaceTree(*mesh.snapshot()).nearest(points);
        found.resize(Eigen::Index(result.point.size()), 3);
        for (size_t i = 0; i < result.point.size(); ++i)
            found.row(Eigen::Index(i)) = (result.point[i] + offset).transpose();
        return result;
    });
    return nb::make_tuple(owning_array(std::move(nearest.distance)), owning_array(std::move(nearest.face)),
                          owning_array(std::move(found)));
}

nb::dict distance_to(const Mesh& mesh, const Mesh& other, int64_t samples, uint64_t seed) {
    const SurfaceDistance distance = released([&] { return surface_distance(mesh, other, samples, seed); });
    nb::dict result;
    result["max"] = distance.max;
    result["mean"] = distance.mean;
    result["rms"] = distance.root_mean_square;
    return result;
}

/// n x 3 numbers in double precision; three numbers are one row.
Array3d to_rows(nb::handle object, const char* name) {
    nb::object array = numeric_object(object, (std::string("mesh array ") + name).c_str());
    if (nb::cast<size_t>(array.attr("ndim")) == 1 && nb::len(array) == 3) array = array.attr("reshape")(1, 3);
    return to_array<double, 3>(array, {name, 3, 3});
}

nb::object rows_of_points(std::vector<Vec3d> points) {
    return owning_array(Points(Eigen::Map<const Points>(points.empty() ? nullptr : points[0].data(),
                                                        Eigen::Index(points.size()), 3)));
}

nb::object flags(std::vector<uint8_t> values) {
    return owning_array(std::move(values)).attr("view")("bool");
}

/// RayTree::Hits as arrays.
struct RayHits {
    nb::object distances, faces, barycentric, points, normals;
};

RayHits cast(const RayTree& tree, const ArrayLike& origins, const ArrayLike& directions,
             std::optional<double> max_distance) {
    const Array3d from = to_rows(origins, "origins"), towards = to_rows(directions, "directions");
    const double farthest = max_distance.value_or(std::numeric_limits<double>::infinity());
    RayTree::Hits hits = released([&] { return tree.cast(from, towards, farthest); });
    return {owning_array(std::move(hits.distances)), owning_array(std::move(hits.faces)),
            rows_of_points(std::move(hits.barycentric)), rows_of_points(std::move(hits.points)),
            rows_of_points(std::move(hits.normals))};
}

std::vector<uint8_t> visible_from(const Mesh& mesh, const nb::object& viewpoint, const nb::object& size,
                                  const nb::object& origin, std::optional<double> near) {
    const bool is_camera = nb::isinstance<Camera>(viewpoint);
    if (!is_camera && !(size.is_none() && origin.is_none() && !near))
        throw ArgumentError(
            "visible_from: expected size, origin and near with a Camera alone, got one with a point");
    if (!is_camera) {
        const Vec3d from = to_vector3(viewpoint, "viewpoint");
        return released([&] { return visible_vertices(mesh, from); });
    }
    const Camera camera = nb::cast<Camera>(viewpoint);
    std::optional<Vec2i> picture;
    std::optional<Vec3d> base;
    if (!size.is_none()) picture = to_size(size, "size");
    if (!origin.is_none()) base = to_vector3(origin, "origin");
    return released([&] { return visible_vertices(mesh, camera, picture, base, near); });
}

void bind_ray_hits(nb::module_& module) {
    nb::class_<RayHits>(module, "RayHits", "What each of n rays meets first: arrays with a row for each.")
        .def_prop_ro(
            "distances", [](const RayHits& hits) { return hits.distances; },
            nb::sig("def distances(self) -> numpy.ndarray"),
            "n: from the origin, whatever the direction's length; inf: nothing is met.")
        .def_prop_ro(
            "faces", [](const RayHits& hits) { return hits.faces; },
            nb::sig("def faces(self) -> numpy.ndarray"), "n: the face; -1: none, the rest is NaN.")
        .def_prop_ro(
            "barycentric", [](const RayHits& hits) { return hits.barycentric; },
            nb::sig("def barycentric(self) -> numpy.ndarray"), "n x 3: weights of the face's three corners.")
        .def_prop_ro(
            "points", [](const RayHits& hits) { return hits.points; },
            nb::sig("def points(self) -> numpy.ndarray"), "n x 3: where it is met.")
        .def_prop_ro(
            "normals", [](const RayHits& hits) { return hits.normals; },
            nb::sig("def normals(self) -> numpy.ndarray"),
            "n x 3: of the face by its winding; not turned towards the ray.");
}

void bind_ray_tree(nb::module_& module) {
    bind_ray_hits(module);
    nb::class_<RayTree>(
        module, "RayTree",
        "Rays against the faces of a mesh, or of what as_mesh() takes; "
        "in a list, of several. Poses and children are included: faces count in the order of merge(). "
        "Points include the offset. All is computed in double precision, so that coordinates "
        "far from zero, as of UTM, need nothing. Rays do not slip through between faces. "
        "Where a method takes two arrays, one row of either stands for all.")
        .def(
            "__init__",
            [](RayTree* self, const nb::object& mesh) {
                const nb::object made = nb::module_::import_("easypbr.convert").attr("as_mesh")(mesh);
                const Mesh& whole = nb::cast<const Mesh&>(made);
                released([&] { new (self) RayTree(whole); });
            },
            nb::arg("mesh"))
        .def("__len__", &RayTree::face_count)
        .def("__reduce__", [](const RayTree&) { refuse_pickle("RayTree"); })
        .def("cast", cast, nb::arg("origins"), nb::arg("directions"),
             nb::arg("max_distance").none() = nb::none(),
             nb::sig("def cast(self, origins: numpy.typing.ArrayLike, directions: numpy.typing.ArrayLike, "
                     "max_distance: float | None = None) -> RayHits"),
             "What each ray meets first, on either side of a face. Directions may have any length but zero.")
        .def(
            "occluded",
            [](const RayTree& tree, const ArrayLike& from, const ArrayLike& to) {
                const Array3d a = to_rows(from, "a"), b = to_rows(to, "b");
                return flags(released([&] { return tree.occluded(a, b); }));
            },
            nb::arg("a"), nb::arg("b"),
            nb::sig(
                "def occluded(self, a: numpy.typing.ArrayLike, b: numpy.typing.ArrayLike) -> numpy.ndarray"),
            "n booleans: whether a face lies between two points. Faces within a millionth of the bounding "
            "box's diagonal from either end do not count: a vertex does not hide itself.")
        .def(
            "contains",
            [](const RayTree& tree, const ArrayLike& points) {
                const Array3d rows = to_rows(points, "points");
                return flags(released([&] { return tree.contains(rows); }));
            },
            nb::arg("points"), nb::sig("def contains(self, points: numpy.typing.ArrayLike) -> numpy.ndarray"),
            "n booleans: whether the surface winds around a point. It must be closed, by shared vertices or "
            "equal positions, and wound consistently; bodies may overlap.");
}

}  // namespace

void bind_surfaces(nb::module_& module) {
    bind_ray_tree(module);
    nb::borrow<nb::class_<Mesh>>(nb::type<Mesh>())
        .def(
            "vertex_normals",
            [](const Mesh& m) { return view_of(released([&] { return smooth_normals(*m.snapshot()); })); },
            nb::sig("def vertex_normals(self) -> numpy.ndarray"),
            "n x 3: normals of the faces around each vertex, weighted by area and angle. Across seams they "
            "are smooth.")
        .def(
            "face_normals",
            [](const Mesh& m) {
                return view_of(released([&] {
                    const auto data = m.snapshot();
                    return face_normals(data->V, data->F);
                }));
            },
            nb::sig("def face_normals(self) -> numpy.ndarray"), "m x 3: normals of the faces.")
        .def(
            "sample_surface",
            [](const Mesh& m, int64_t count, uint64_t seed) {
                return released([&] { return sample_surface(m, count, seed); });
            },
            nb::arg("count"), nb::arg("seed") = 0,
            "A new cloud of points on the faces, uniform by area, with interpolated attributes.")
        .def("closest_points", closest_points, nb::arg("queries"),
             nb::sig("def closest_points(self, queries: numpy.typing.ArrayLike) -> tuple[numpy.ndarray, "
                     "numpy.ndarray, numpy.ndarray]"),
             "For each query the distance to the surface, the nearest face, and the nearest point on it; "
             "the nearest vertex for a mesh without faces. Queries and points are in the mesh's own frame, "
             "its offset included.")
        .def(
            "visible_from",
            [](const Mesh& mesh, const nb::object& viewpoint, const nb::object& size,
               const nb::object& origin, std::optional<double> near) {
                return flags(visible_from(mesh, viewpoint, size, origin, near));
            },
            nb::arg("viewpoint"), nb::arg("size").none() = nb::none(), nb::arg("origin").none() = nb::none(),
            nb::arg("near").none() = nb::none(),
            nb::sig("def visible_from(self, viewpoint: Camera | numpy.typing.ArrayLike, size: "
                    "numpy.typing.ArrayLike | None = None, origin: numpy.typing.ArrayLike | None = None, "
                    "near: float | None = None) -> numpy.ndarray"),
            "A boolean for each vertex: whether no face of the mesh hides it from a point or a Camera; "
            "with children those of merge(). Faces are needed. "
            "With the `size` (width, height) of a picture, vertices outside of it are not visible. "
            "A point includes the offset; a camera is relative to `origin`, as scene.origin, "
            "or else to the mesh's offset. "
            "What is before the near plane neither is seen nor hides: `near`, as the setting camera.near; "
            "by default as a view infers it, whatever near the camera has.")
        .def("distance_to", distance_to, nb::arg("other"), nb::arg("samples") = 100000, nb::arg("seed") = 0,
             "One-sided distances of this surface to the other: a dict of max (of vertices and samples), "
             "mean and rms (of the samples). Poses and children are included.")
        .def(
            "hausdorff_distance",
            [](const Mesh& m, const Mesh& other, int64_t samples, uint64_t seed) {
                return released([&] { return hausdorff_distance(m, other, samples, seed); });
            },
            nb::arg("other"), nb::arg("samples") = 100000, nb::arg("seed") = 0,
            "The Hausdorff distance: the larger of both one-sided maxima.");
}

}  // namespace easypbr::python

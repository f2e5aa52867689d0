// Neighbours, normals and surfels of points.
#include <nanobind/stl/optional.h>

#include "easypbr/geometry/nearest.h"
#include "easypbr/geometry/surfels.h"
#include "easypbr/python/convert.h"
#include "easypbr/python/text.h"

namespace easypbr::python {
namespace {

/// A tree of points less an offset, so that float32 tells those far from zero apart.
struct LocalTree {
    KdTree tree;
    Vec3d offset;
};

nb::tuple find_nearest(const LocalTree& local, const ArrayLike& queries, int k) {
    const Array3f points = to_local(queries, {"queries", 3, 3}, local.offset);
    const KdTree::Nearest found = released([&] { return local.tree.nearest(points, k); });
    return nb::make_tuple(owning_array(KdTree::Rows<float>::Dense(found.distances)),
                          owning_array(KdTree::Rows<int32_t>::Dense(found.indices)));
}

nb::tuple find_within(const LocalTree& local, const ArrayLike& queries, float radius) {
    const Array3f points = to_local(queries, {"queries", 3, 3}, local.offset);
    KdTree::Within found = released([&] { return local.tree.within(points, radius); });
    return nb::make_tuple(owning_array(std::move(found.distances)), owning_array(std::move(found.indices)),
                          owning_array(std::move(found.offsets)));
}

NeighborhoodOptions options(int k, const nb::object& viewpoint) {
    NeighborhoodOptions result{k, {}};
    if (!viewpoint.is_none()) result.viewpoint = to_vector3(viewpoint, "viewpoint");
    return result;
}

void bind_kd_tree(nb::module_& module) {
    nb::class_<LocalTree>(
        module, "KdTree",
        "Nearest neighbours among the rows of an n x 3 array. float64 points far from zero, as of UTM "
        "coordinates, are told apart: both points and queries are recentred in double precision. Distances "
        "are float32.")
        .def(
            "__init__",
            [](LocalTree* self, const ArrayLike& points) {
                const LocalPositions local = to_points(points, {"points", 3, 3});
                released([&] { new (self) LocalTree{KdTree(local.V), local.offset}; });
            },
            nb::arg("points"))
        .def("__len__", [](const LocalTree& local) { return local.tree.size(); })
        .def("nearest", find_nearest, nb::arg("queries"), nb::arg("k") = 1,
             nb::sig("def nearest(self, queries: numpy.typing.ArrayLike, k: int = 1) -> tuple[numpy.ndarray, "
                     "numpy.ndarray]"),
             "Distances and indices, both m x k, of the k nearest points of each query, nearest first.")
        .def("within", find_within, nb::arg("queries"), nb::arg("radius"),
             nb::sig(
                 "def within(self, queries: numpy.typing.ArrayLike, radius: float) -> tuple[numpy.ndarray, "
                 "numpy.ndarray, numpy.ndarray]"),
             "Distances, indices and m + 1 offsets: the points within `radius` of query i are "
             "indices[offsets[i]:offsets[i + 1]], nearest first.");
}

}  // namespace

void bind_neighbors(nb::module_& module) {
    bind_kd_tree(module);
    nb::borrow<nb::class_<Mesh>>(nb::type<Mesh>())
        .def(
            "estimate_normals",
            [](const Mesh& mesh, int k, const nb::object& viewpoint) {
                const NeighborhoodOptions chosen = options(k, viewpoint);
                return released([&] { return estimate_normals(mesh, chosen); });
            },
            nb::arg("k") = 16, nb::arg("viewpoint").none() = nb::none(),
            nb::sig(
                "def estimate_normals(self, k: int = 16, viewpoint: numpy.typing.ArrayLike | None = None) -> "
                "Mesh"),
            "A new mesh with normals estimated from the k nearest neighbours of each vertex. They are "
            "oriented towards the viewpoint, or consistently: closed shapes face outwards, ground up.")
        .def(
            "estimate_surfels",
            [](const Mesh& mesh, int k, const nb::object& viewpoint, bool keep_normals) {
                const NeighborhoodOptions chosen = options(k, viewpoint);
                return released([&] { return estimate_surfels(mesh, chosen, keep_normals); });
            },
            nb::arg("k") = 16, nb::arg("viewpoint").none() = nb::none(), nb::arg("keep_normals") = false,
            nb::sig(
                "def estimate_surfels(self, k: int = 16, viewpoint: numpy.typing.ArrayLike | None = None, "
                "keep_normals: bool = False) -> Mesh"),
            "The vertices as a new mesh of surfels that cover the surface: N as of estimate_normals(), "
            "or the mesh's own; T, one semi-axis; B, the length of the other.")
        .def(
            "to_surfels", [](const Mesh& mesh) { return released([&] { return surfels_from_mesh(mesh); }); },
            "One surfel for each vertex, with the mesh's normals, as large as its share of the faces around "
            "it; or for each splat, across its shortest axis, that covers what the splat does.");
}

}  // namespace easypbr::python

// Methods of Mesh that measure: normals, points on the surface, distances.

#include "easypbr/geometry/nearest.h"
#include "easypbr/geometry/sample.h"
#include "easypbr/python/convert.h"
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

}  // namespace

void bind_surfaces(nb::module_&) {
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
             "For each query the distance to the surface, the nearest face, and the nearest point on it; the "
             "nearest vertex for a mesh without faces. Queries and points are in the mesh's own frame, its "
             "offset "
             "included.")
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

#include "easypbr/python/mesh_pose.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include "easypbr/python/convert.h"
#include "easypbr/python/pickle.h"
#include "easypbr/python/text.h"

namespace easypbr::python {
namespace {

void scale(Mesh& mesh, nb::handle factors) {
    const bool one = nb::isinstance<nb::float_>(factors) || nb::isinstance<nb::int_>(factors);
    const Vec3d value =
        one ? Vec3d::Constant(nb::cast<double>(factors)) : to_vector3(factors, "scale: factors");
    released([&] { mesh.scale(value); });
}

void bind_poses(nb::class_<Mesh>& mesh) {
    mesh.def_prop_rw(
            "T_parent_mesh", [](const Mesh& m) { return matrix_to_numpy(m.T_parent_mesh().matrix()); },
            [](Mesh& m, const ArrayLike& T) { m.set_T_parent_mesh(to_affine(T, "T_parent_mesh")); },
            nb::for_getter(nb::sig("def T_parent_mesh(self) -> numpy.ndarray")),
            "4 x 4 pose relative to the parent, or to the world.")
        .def_prop_rw(
            "T_world_mesh", [](const Mesh& m) { return matrix_to_numpy(m.T_world_mesh().matrix()); },
            [](Mesh& m, const ArrayLike& T) { m.set_T_world_mesh(to_affine(T, "T_world_mesh")); },
            nb::for_getter(nb::sig("def T_world_mesh(self) -> numpy.ndarray")),
            "4 x 4 pose in world space, the product of those of all parents and T_parent_mesh.")
        .def_prop_rw(
            "offset", [](const Mesh& m) { return matrix_to_numpy(m.offset().transpose()); },
            [](Mesh& m, const ArrayLike& offset) {
                const Vec3d value = to_vector3(offset, "offset");
                released([&] { m.set_offset(value); });
            },
            nb::for_getter(nb::sig("def offset(self) -> numpy.ndarray")),
            "3 float64: offset + V are the original coordinates. Non-zero for data far from zero, beyond the "
            "precision of float32. Meshes of a scene are placed by it, see Scene.origin.");
}

void bind_motion(nb::class_<Mesh>& mesh) {
    mesh.def(
            "translate",
            [](Mesh& m, const ArrayLike& step) { m.translate(to_vector3(step, "translate: step")); },
            nb::arg("step"), nb::sig("def translate(self, step: numpy.typing.ArrayLike) -> None"),
            "Translates by (x, y, z) in the parent's frame, which is the world for a mesh without a parent. "
            "Children move too, as with every transform.")
        .def(
            "rotate_axis_angle",
            [](Mesh& m, const ArrayLike& axis, double angle_deg) {
                m.rotate_axis_angle(to_vector3(axis, "rotate_axis_angle: axis"), angle_deg);
            },
            nb::arg("axis"), nb::arg("angle_deg"),
            nb::sig("def rotate_axis_angle(self, axis: numpy.typing.ArrayLike, angle_deg: float) -> None"),
            "Rotates about the mesh's own origin, counter-clockwise seen against the axis.")
        .def(
            "orbit",
            [](Mesh& m, const ArrayLike& axis, const ArrayLike& center, double angle_deg) {
                m.orbit(to_vector3(axis, "orbit: axis"), to_vector3(center, "orbit: center"), angle_deg);
            },
            nb::arg("axis"), nb::arg("center"), nb::arg("angle_deg"),
            nb::sig(
                "def orbit(self, axis: numpy.typing.ArrayLike, center: numpy.typing.ArrayLike, angle_deg: "
                "float) -> None"),
            "Rotates about the line through `center` along the axis.")
        .def("scale", scale, nb::arg("factors"),
             nb::sig("def scale(self, factors: float | numpy.typing.ArrayLike) -> None"),
             "Scales by one factor or (x, y, z) along the mesh's own axes, about its own origin.");
}

void bind_hierarchy(nb::class_<Mesh>& mesh) {
    mesh.def(
            "add_child",
            [](Mesh& m, const Mesh& child, bool keep_world_pose) {
                released([&] { m.add_child(child, keep_world_pose); });
            },
            nb::arg("child"), nb::arg("keep_world_pose") = false,
            "Adds a mesh as a child: its pose becomes relative to this one's, and it moves with it. "
            "keep_world_pose keeps its world pose. A child that is also shown under a name of its own is "
            "drawn once.")
        .def(
            "remove_child",
            [](Mesh& m, const Mesh& child, bool keep_world_pose) {
                released([&] { m.remove_child(child, keep_world_pose); });
            },
            nb::arg("child"), nb::arg("keep_world_pose") = false,
            "Removes a child; keep_world_pose keeps its world pose.")
        .def_prop_ro("children", [](const Mesh& m) { return m.children(); })
        .def_prop_ro(
            "parent", [](const Mesh& m) { return m.parent(); }, nb::sig("def parent(self) -> Mesh | None"),
            "The parent mesh.")
        .def(
            "clone", [](const Mesh& m) { return released([&] { return m.clone(); }); },
            "A deep copy, children included.");
    bind_copies(mesh, [](const Mesh& m) { return released([&] { return m.clone(); }); });
    bind_pickle(mesh);
}

}  // namespace

void bind_mesh_pose(nb::class_<Mesh>& mesh) {
    bind_poses(mesh);
    bind_motion(mesh);
    bind_hierarchy(mesh);
}

}  // namespace easypbr::python

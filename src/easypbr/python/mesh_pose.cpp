#include "easypbr/python/mesh_pose.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include "easypbr/python/convert.h"
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
            "4 x 4 pose in the parent, or in the world.")
        .def_prop_rw(
            "T_world_mesh", [](const Mesh& m) { return matrix_to_numpy(m.T_world_mesh().matrix()); },
            [](Mesh& m, const ArrayLike& T) { m.set_T_world_mesh(to_affine(T, "T_world_mesh")); },
            nb::for_getter(nb::sig("def T_world_mesh(self) -> numpy.ndarray")),
            "4 x 4 pose in the world: those of all parents, applied to T_parent_mesh.")
        .def_prop_rw(
            "offset", [](const Mesh& m) { return matrix_to_numpy(m.offset().transpose()); },
            [](Mesh& m, const ArrayLike& offset) {
                const Vec3d value = to_vector3(offset, "offset");
                released([&] { m.set_offset(value); });
            },
            nb::for_getter(nb::sig("def offset(self) -> numpy.ndarray")),
            "3 float64: offset + V are the coordinates that the mesh was given. Not zero for data far from "
            "zero, which float32 would not hold. Meshes of one scene are placed by it, see Scene.origin.");
}

void bind_motion(nb::class_<Mesh>& mesh) {
    mesh.def(
            "translate",
            [](Mesh& m, const ArrayLike& step) { m.translate(to_vector3(step, "translate: step")); },
            nb::arg("step"), nb::sig("def translate(self, step: numpy.typing.ArrayLike) -> None"),
            "Moves by (x, y, z) in the parent's frame, which is the world for a mesh without a parent. "
            "Children "
            "move along, as with every step of motion.")
        .def(
            "rotate_axis_angle",
            [](Mesh& m, const ArrayLike& axis, double angle_deg) {
                m.rotate_axis_angle(to_vector3(axis, "rotate_axis_angle: axis"), angle_deg);
            },
            nb::arg("axis"), nb::arg("angle_deg"),
            nb::sig("def rotate_axis_angle(self, axis: numpy.typing.ArrayLike, angle_deg: float) -> None"),
            "Turns about the mesh's own origin, counter-clockwise seen against the axis.")
        .def(
            "orbit",
            [](Mesh& m, const ArrayLike& axis, const ArrayLike& center, double angle_deg) {
                m.orbit(to_vector3(axis, "orbit: axis"), to_vector3(center, "orbit: center"), angle_deg);
            },
            nb::arg("axis"), nb::arg("center"), nb::arg("angle_deg"),
            nb::sig(
                "def orbit(self, axis: numpy.typing.ArrayLike, center: numpy.typing.ArrayLike, angle_deg: "
                "float) -> None"),
            "Goes around the line through `center` along the axis, and turns with it.")
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
            "Hangs a mesh below this one: from now on its pose is relative to this one's, and it moves with "
            "it. "
            "With keep_world_pose it stays where it is. Shown under a name of its own, too, it is still "
            "drawn "
            "once.")
        .def(
            "remove_child",
            [](Mesh& m, const Mesh& child, bool keep_world_pose) {
                released([&] { m.remove_child(child, keep_world_pose); });
            },
            nb::arg("child"), nb::arg("keep_world_pose") = false,
            "Takes a child away; with keep_world_pose it stays where it is.")
        .def_prop_ro("children", [](const Mesh& m) { return m.children(); })
        .def_prop_ro(
            "parent", [](const Mesh& m) { return m.parent(); }, nb::sig("def parent(self) -> Mesh | None"),
            "The mesh that this one is a child of.")
        .def(
            "clone", [](const Mesh& m) { return released([&] { return m.clone(); }); },
            "A copy of its own, children included.");
}

}  // namespace

void bind_mesh_pose(nb::class_<Mesh>& mesh) {
    bind_poses(mesh);
    bind_motion(mesh);
    bind_hierarchy(mesh);
}

}  // namespace easypbr::python

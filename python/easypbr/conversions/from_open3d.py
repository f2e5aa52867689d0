"""Open3D, of both kinds: http://www.open3d.org/docs/release/python_api/open3d.geometry.html and open3d.t.geometry.html."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._easypbr import Material, Mesh
from ..errors import ArgumentError
from ..tensors import as_numpy
from .maker import Maker, colors, rows, separate_corners


def is_mesh(what: Any) -> bool:
    return all(hasattr(what, name) for name in ("vertices", "triangles", "vertex_normals"))


def of_mesh(what: Any, make: Maker) -> Mesh:
    V, F = np.asarray(what.vertices), np.asarray(what.triangles)
    N, C = np.asarray(what.vertex_normals), np.asarray(what.vertex_colors)
    corner_uv = np.asarray(getattr(what, "triangle_uvs", ()))
    if len(corner_uv) and len(corner_uv) == 3 * len(F):
        # One uv per corner: every corner becomes a vertex.
        corners = F.ravel()
        V, N, C = V[corners], N[corners] if len(N) else N, C[corners] if len(C) else C
        F = np.arange(len(corners)).reshape(-1, 3)
    count = len(V)
    mesh = make.mesh(V=V, F=F, N=rows(N, count), C=rows(C, count), UV=rows(corner_uv, count))
    textures = [image for image in map(np.asarray, getattr(what, "textures", ())) if image.size]
    if textures and len(mesh.UV):
        mesh.material.base_color_texture = textures[0]
    if len(textures) > 1:
        make.leave_out(f"{len(textures) - 1} of {len(textures)} textures of an Open3D mesh: the first is on all of its triangles")
    return mesh


def is_cloud(what: Any) -> bool:
    return all(hasattr(what, name) for name in ("points", "colors", "normals", "has_colors"))


def of_cloud(what: Any, make: Maker) -> Mesh:
    count = len(what.points)
    return make.mesh(V=np.asarray(what.points), N=rows(what.normals, count), C=rows(what.colors, count))


def is_lines(what: Any) -> bool:
    return all(hasattr(what, name) for name in ("points", "lines", "colors", "has_lines"))


def of_lines(what: Any, make: Maker) -> Mesh:
    return _lines(what.points, what.lines, what.colors, make)


def _lines(points: Any, lines: Any, line_colors: Any, make: Maker) -> Mesh:
    """Lines, each with a colour of its own if there are colours."""
    V, E = np.asarray(as_numpy(points)), np.asarray(as_numpy(lines))
    C = None if line_colors is None else colors(line_colors, len(E))
    if C is None:
        return make.mesh(V=V, E=E)
    corners, E, C = separate_corners(E, C)
    return make.mesh(V=V[corners], E=E, C=C)


def is_voxels(what: Any) -> bool:
    return hasattr(what, "get_voxels") and hasattr(what, "voxel_size") and hasattr(what, "origin")


def of_voxels(what: Any, make: Maker) -> Mesh:
    found = what.get_voxels()
    if not found:
        raise ArgumentError("an Open3D VoxelGrid: expected voxels, got none")
    cells = np.array([voxel.grid_index for voxel in found], dtype=np.float64)
    size = float(what.voxel_size)
    # A grid may be turned about its origin.
    turn = np.asarray(getattr(what, "rotation", np.eye(3)), dtype=np.float64)
    C = np.array([voxel.color for voxel in found]) if what.has_colors() else None
    mesh = make.mesh(V=(cells + 0.5) * size, C=C)
    mesh.style.mode = "voxels"
    mesh.style.voxel_size = size
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = turn, np.asarray(what.origin)
    mesh.T_parent_mesh = T
    return mesh


def is_box(what: Any) -> bool:
    return hasattr(what, "get_box_points") and hasattr(what, "color")


def of_box(what: Any, make: Maker) -> Mesh:
    """The twelve edges of a bounding box, in its colour."""
    corners = np.asarray(what.get_box_points())
    C = np.tile(np.asarray(what.color, dtype=np.float64), (8, 1))
    return make.mesh(V=corners, E=box_edges(corners), C=C)


def box_edges(corners: NDArray[Any]) -> NDArray[Any]:
    """Pairs of the eight corners of a box that are the ends of its edges, in whatever order the corners are."""
    middle = corners.mean(axis=0)
    # From one corner the three nearest of those that edges lead to are the shortest independent directions.
    axes = _axes(corners)
    side = np.sign(((corners - middle) @ axes).round(12))
    return np.array([(i, j) for i in range(8) for j in range(i + 1, 8) if (side[i] != side[j]).sum() == 1])


def _axes(corners: NDArray[Any]) -> NDArray[Any]:
    """Directions along the edges of a box, as columns."""
    away = corners[1:] - corners[0]
    away = away[np.argsort(np.linalg.norm(away, axis=1))]
    first = away[0] / np.linalg.norm(away[0])
    across = [d for d in away if abs(d @ first) < 1e-6 * np.linalg.norm(d)]
    second = across[0] / np.linalg.norm(across[0])
    return np.stack([first, second, np.cross(first, second)], axis=1)


def is_model(what: Any) -> bool:
    """open3d.visualization.rendering.TriangleMeshModel: meshes, each with the number of its material."""
    return all(hasattr(what, name) for name in ("meshes", "materials")) and all(
        hasattr(info, "mesh") and hasattr(info, "material_idx") for info in what.meshes
    )


def of_model(what: Any, make: Maker) -> Mesh:
    children = []
    for info in what.meshes:
        child = make.any(info.mesh)
        child.name = str(getattr(info, "mesh_name", "") or "")
        if 0 <= info.material_idx < len(what.materials):
            take_material(child.material, what.materials[info.material_idx])
        children.append(child)
    if not children:
        raise ArgumentError("an Open3D TriangleMeshModel: expected meshes, got none")
    return make.parts(children)


_RECORD_NUMBERS = {
    "metallic": "base_metallic",
    "roughness": "base_roughness",
    "clearcoat": "base_clearcoat",
    "clearcoat_roughness": "base_clearcoat_roughness",
    "anisotropy_strength": "base_anisotropy",
}
_RECORD_IMAGES = {"base_color_texture": "albedo_img", "normal_texture": "normal_img", "occlusion_texture": "ao_img"}


def take_material(material: Material, record: Any) -> None:
    """A MaterialRecord: base_color is linear, as glTF's."""
    color = np.asarray(record.base_color, dtype=np.float64)
    material.base_color = color[:3]
    if getattr(record, "has_alpha", False) and len(color) == 4:
        material.opacity = color[3]
    for name, given in _RECORD_NUMBERS.items():
        if hasattr(record, given) and hasattr(material, name):
            setattr(material, name, float(getattr(record, given)))
    for name, given in _RECORD_IMAGES.items():
        image = getattr(record, given, None)
        if image is not None and np.asarray(image).size:
            setattr(material, name, np.asarray(image))


# open3d.t.geometry: attributes are tensors in maps.


def is_tensor_mesh(what: Any) -> bool:
    return all(hasattr(what, name) for name in ("vertex", "triangle", "to_legacy"))


def _attribute(attributes: Any, name: str) -> NDArray[Any] | None:
    return np.asarray(_cpu(attributes[name])) if name in attributes else None


def _cpu(tensor: Any) -> Any:
    return tensor.cpu().numpy() if hasattr(tensor, "cpu") and hasattr(tensor, "numpy") else as_numpy(tensor)


def _scalars(attributes: Any, known: tuple[str, ...], count: int, make: Maker) -> dict[str, NDArray[Any]]:
    """Attributes with a number per row; of others it is said that they are left out."""
    found, others = {}, []
    for name in list(attributes):  # Its keys are attributes, too: "keys" may be one of them.
        value = np.asarray(_cpu(attributes[name]))
        if name in known:
            continue
        flat = value[:, 0] if value.ndim == 2 and value.shape[1] == 1 else value
        if flat.ndim == 1 and len(flat) == count and flat.dtype.kind in "biuf":
            found[name] = flat.astype(np.float32) if flat.dtype.kind == "b" else flat
        else:
            others.append(name)
    if others:
        make.leave_out(f"attributes of an Open3D tensor geometry: {', '.join(sorted(others))}")
    return found


def of_tensor_mesh(what: Any, make: Maker) -> Mesh:
    V, F = _attribute(what.vertex, "positions"), _attribute(what.triangle, "indices")
    if V is None:
        raise ArgumentError("an Open3D tensor mesh: expected vertex.positions")
    N, C = _attribute(what.vertex, "normals"), _attribute(what.vertex, "colors")
    UV = _attribute(what.vertex, "texture_uvs")
    scalars = _scalars(what.vertex, ("positions", "normals", "colors", "texture_uvs"), len(V), make)
    scalars |= _scalars(what.triangle, ("indices", "normals", "texture_uvs", "colors"), len(() if F is None else F), make)
    corner_uv, face_colors = _attribute(what.triangle, "texture_uvs"), _attribute(what.triangle, "colors")
    if F is not None and (corner_uv is not None or (face_colors is not None and C is None)):
        corners = F.ravel()
        count = len(V)
        V, N = V[corners], None if N is None else N[corners]
        C = np.repeat(face_colors, 3, axis=0) if C is None and face_colors is not None else None if C is None else C[corners]
        UV = corner_uv.reshape(-1, 2) if corner_uv is not None else None if UV is None else UV[corners]
        scalars = {name: values[corners] if len(values) == count else values for name, values in scalars.items()}
        F = np.arange(len(corners)).reshape(-1, 3)
    mesh = make.mesh(V=V, F=F, N=N, C=None if C is None else colors(C, len(V)), UV=UV, scalars=scalars)
    if getattr(what, "has_valid_material", bool)():
        _take_tensor_material(mesh.material, what.material)
    return mesh


def _take_tensor_material(material: Material, given: Any) -> None:
    """open3d.visualization.Material: named properties and texture maps."""
    vectors, scalars, maps = given.vector_properties, given.scalar_properties, given.texture_maps
    if "base_color" in vectors:
        material.base_color = np.asarray(vectors["base_color"], dtype=np.float64)[:3]
    for name in ("metallic", "roughness"):
        if name in scalars:
            setattr(material, name, float(scalars[name]))
    for name, use in (("albedo", "base_color_texture"), ("normal", "normal_texture"), ("ambient_occlusion", "occlusion_texture")):
        if name in maps and np.asarray(_cpu(maps[name].as_tensor())).size:
            setattr(material, use, np.asarray(_cpu(maps[name].as_tensor())))


def is_tensor_cloud(what: Any) -> bool:
    return hasattr(what, "point") and hasattr(what, "to_legacy") and not hasattr(what, "line")


def of_tensor_cloud(what: Any, make: Maker) -> Mesh:
    V = _attribute(what.point, "positions")
    if V is None:
        raise ArgumentError("an Open3D tensor cloud: expected point.positions")
    N, C = _attribute(what.point, "normals"), _attribute(what.point, "colors")
    intensity, labels = _attribute(what.point, "intensity"), _attribute(what.point, "labels")
    known = ("positions", "normals", "colors", "intensity", "labels")
    return make.mesh(
        V=V,
        N=N,
        C=None if C is None else colors(C, len(V)),
        I=None if intensity is None else intensity.reshape(-1),
        L=None if labels is None else labels.reshape(-1),
        scalars=_scalars(what.point, known, len(V), make),
    )


def is_tensor_lines(what: Any) -> bool:
    return hasattr(what, "point") and hasattr(what, "line") and hasattr(what, "to_legacy")


def of_tensor_lines(what: Any, make: Maker) -> Mesh:
    V, E = _attribute(what.point, "positions"), _attribute(what.line, "indices")
    if V is None or E is None:
        raise ArgumentError("an Open3D tensor line set: expected point.positions and line.indices")
    return _lines(V, E, _attribute(what.line, "colors"), make)


CONVERSIONS = [
    (is_mesh, of_mesh),
    (is_lines, of_lines),
    (is_cloud, of_cloud),
    (is_voxels, of_voxels),
    (is_box, of_box),
    (is_model, of_model),
    (is_tensor_mesh, of_tensor_mesh),
    (is_tensor_lines, of_tensor_lines),
    (is_tensor_cloud, of_tensor_cloud),
]

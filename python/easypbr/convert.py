"""Meshes from objects of other libraries, which are recognised by their attributes; none is imported."""

import os
from typing import Any

import numpy as np

from ._easypbr import Mesh
from .errors import ArgumentError


def as_mesh(what: Any) -> Mesh:
    """A Mesh of a path, a Mesh, (V, F), a dict of arrays, or a trimesh, Open3D or PyVista object.

    A Mesh is returned as it is; arrays are copied once.
    """
    if isinstance(what, Mesh):
        return what
    if isinstance(what, (str, os.PathLike)):
        return Mesh(what)
    if isinstance(what, dict):
        return _from_arrays(**what)
    if isinstance(what, (tuple, list)) and len(what) == 2:
        return _from_arrays(V=what[0], F=what[1])
    for recognises, convert in _CONVERSIONS:
        if recognises(what):
            return convert(what)
    raise ArgumentError(
        f"cannot show a {type(what).__module__}.{type(what).__qualname__}: expected a path, an easypbr.Mesh, "
        "(V, F), a dict of arrays, or a trimesh, Open3D or PyVista object"
    )


def _from_arrays(name: str = "", **arrays: Any) -> Mesh:
    mesh = Mesh()
    mesh.assign(**arrays)
    mesh.name = name
    return mesh


def _rows(array: Any, count: int) -> np.ndarray | None:
    """The array if it has `count` rows, else None."""
    array = None if array is None else np.asarray(array)
    return array if array is not None and count and len(array) == count else None


# trimesh: https://trimesh.org/trimesh.base.html


def _is_trimesh(what: Any) -> bool:
    return all(hasattr(what, name) for name in ("vertices", "faces", "visual"))


def _from_trimesh(what: Any) -> Mesh:
    V, F, count = what.vertices, what.faces, len(what.vertices)
    kind = getattr(what.visual, "kind", None)
    if kind == "face":
        return _with_face_colors(V, F, what.visual.face_colors)
    colors = what.visual.vertex_colors if kind == "vertex" else None
    uv = getattr(what.visual, "uv", None) if kind == "texture" else None
    # Normals that trimesh has to compute are better computed here.
    cached = getattr(what, "_cache", {})
    normals = what.vertex_normals if "vertex_normals" in cached else None
    mesh = _from_arrays(V=V, F=F, N=_rows(normals, count), C=_rows(colors, count), UV=_rows(uv, count))
    if kind == "texture" and getattr(what.visual, "material", None) is not None:
        _take_trimesh_material(mesh.material, what.visual.material)
    return mesh


def _with_face_colors(V: Any, F: Any, colors: Any) -> Mesh:
    """Splits the mesh into separate corners, so that each face has its own colour."""
    F = np.asarray(F)
    return _from_arrays(
        V=np.asarray(V)[F.ravel()], F=np.arange(F.size).reshape(-1, 3), C=np.repeat(np.asarray(colors), 3, axis=0)
    )


def _take_trimesh_material(material: Any, given: Any) -> None:
    """https://trimesh.org/trimesh.visual.material.html: PBRMaterial has glTF's fields, SimpleMaterial diffuse and image."""
    image = getattr(given, "baseColorTexture", None) or getattr(given, "image", None)
    if image is not None:
        material.base_color_texture = np.asarray(image.convert("RGBA"))
    if hasattr(given, "baseColorFactor"):
        factor = given.baseColorFactor
        material.base_color = (1, 1, 1) if factor is None else np.asarray(factor)[:3] / 255
        material.metallic = 1 if given.metallicFactor is None else given.metallicFactor
        material.roughness = 1 if given.roughnessFactor is None else given.roughnessFactor
    elif getattr(given, "diffuse", None) is not None:
        red, green, blue = np.asarray(given.diffuse)[:3]
        material.base_color = f"#{red:02x}{green:02x}{blue:02x}"


def _is_trimesh_scene(what: Any) -> bool:
    return hasattr(what, "geometry") and hasattr(what, "graph") and hasattr(what.graph, "nodes_geometry")


def _from_trimesh_scene(what: Any) -> Mesh:
    root = Mesh()
    for node in what.graph.nodes_geometry:
        T_world_mesh, geometry = what.graph[node]
        child = as_mesh(what.geometry[geometry])
        child.name = str(node)
        child.T_parent_mesh = T_world_mesh
        root.add_child(child)
    return root


def _is_trimesh_cloud(what: Any) -> bool:
    return hasattr(what, "vertices") and hasattr(what, "colors") and not hasattr(what, "faces")


def _from_trimesh_cloud(what: Any) -> Mesh:
    return _from_arrays(V=what.vertices, C=_rows(what.colors, len(what.vertices)))


# Open3D: http://www.open3d.org/docs/release/python_api/open3d.geometry.TriangleMesh.html


def _is_open3d_mesh(what: Any) -> bool:
    return all(hasattr(what, name) for name in ("vertices", "triangles", "vertex_normals"))


def _from_open3d_mesh(what: Any) -> Mesh:
    V, F = np.asarray(what.vertices), np.asarray(what.triangles)
    N, C = np.asarray(what.vertex_normals), np.asarray(what.vertex_colors)
    corner_uv = np.asarray(getattr(what, "triangle_uvs", ()))
    if len(corner_uv) and len(corner_uv) == 3 * len(F):
        # One uv per corner: every corner becomes a vertex.
        corners = F.ravel()
        V, N, C = V[corners], N[corners] if len(N) else N, C[corners] if len(C) else C
        F = np.arange(len(corners)).reshape(-1, 3)
    count = len(V)
    return _from_arrays(V=V, F=F, N=_rows(N, count), C=_rows(C, count), UV=_rows(corner_uv, count))


def _is_open3d_cloud(what: Any) -> bool:
    return all(hasattr(what, name) for name in ("points", "colors", "normals", "has_colors"))


def _from_open3d_cloud(what: Any) -> Mesh:
    count = len(what.points)
    return _from_arrays(V=np.asarray(what.points), N=_rows(what.normals, count), C=_rows(what.colors, count))


# PyVista: https://docs.pyvista.org/api/core/_autosummary/pyvista.PolyData.html


def _is_pyvista(what: Any) -> bool:
    return hasattr(what, "points") and hasattr(what, "point_data") and hasattr(what, "n_points")


def _from_pyvista(what: Any) -> Mesh:
    # Only surfaces can tell whether they are made of triangles.
    if not hasattr(what, "is_all_triangles"):
        what = _surface(what)
    if len(what.faces) and not _called(what.is_all_triangles):
        what = what.triangulate()
    faces = np.asarray(what.faces)
    data, count = what.point_data, what.n_points
    return _from_arrays(
        V=what.points,
        F=faces.reshape(-1, 4)[:, 1:] if len(faces) else None,
        N=_rows(data["Normals"] if "Normals" in data else None, count),
        C=_rows(data["RGB"] if "RGB" in data else None, count),
        UV=_rows(getattr(what, "active_texture_coordinates", None), count),
    )


def _surface(grid: Any) -> Any:
    try:
        return grid.extract_surface(algorithm=None)
    except TypeError:
        # Older versions have nothing to choose.
        return grid.extract_surface()


def _called(flag: Any) -> Any:
    # A property in newer versions, a method in older ones.
    return flag() if callable(flag) else flag


_CONVERSIONS = [
    (_is_trimesh_scene, _from_trimesh_scene),
    (_is_trimesh, _from_trimesh),
    (_is_open3d_mesh, _from_open3d_mesh),
    (_is_open3d_cloud, _from_open3d_cloud),
    (_is_pyvista, _from_pyvista),
    (_is_trimesh_cloud, _from_trimesh_cloud),
]

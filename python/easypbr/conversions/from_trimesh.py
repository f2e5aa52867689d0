"""trimesh: https://trimesh.org/trimesh.base.html."""

from typing import Any

import numpy as np

from .._easypbr import Material, Mesh
from .maker import Maker, colors, rows, separate_corners


def is_mesh(what: Any) -> bool:
    return all(hasattr(what, name) for name in ("vertices", "faces", "visual"))


def of_mesh(what: Any, make: Maker) -> Mesh:
    V, F, count = what.vertices, what.faces, len(what.vertices)
    kind = getattr(what.visual, "kind", None)
    if kind == "face":
        corners, split, corner_colors = separate_corners(np.asarray(F), what.visual.face_colors)
        return make.mesh(V=np.asarray(V)[corners], F=split, C=corner_colors)
    C = what.visual.vertex_colors if kind == "vertex" else None
    uv = getattr(what.visual, "uv", None) if kind == "texture" else None
    # Normals that trimesh has to compute are better computed here.
    cached = getattr(what, "_cache", {})
    normals = what.vertex_normals if "vertex_normals" in cached else None
    mesh = make.mesh(V=V, F=F, N=rows(normals, count), C=rows(C, count), UV=rows(uv, count))
    if kind == "texture" and getattr(what.visual, "material", None) is not None:
        take_material(mesh.material, what.visual.material)
    return mesh


def take_material(material: Material, given: Any) -> None:
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


def is_scene(what: Any) -> bool:
    return hasattr(what, "geometry") and hasattr(what, "graph") and hasattr(what.graph, "nodes_geometry")


def of_scene(what: Any, make: Maker) -> Mesh:
    root = Mesh()
    for node in what.graph.nodes_geometry:
        T_world_mesh, geometry = what.graph[node]
        child = make.any(what.geometry[geometry])
        child.name = str(node)
        child.T_parent_mesh = T_world_mesh
        root.add_child(child)
    return root


def is_cloud(what: Any) -> bool:
    return hasattr(what, "vertices") and hasattr(what, "colors") and not hasattr(what, "faces")


def of_cloud(what: Any, make: Maker) -> Mesh:
    return make.mesh(V=what.vertices, C=colors(what.colors, len(what.vertices)))


def is_path(what: Any) -> bool:
    return hasattr(what, "vertices") and hasattr(what, "vertex_nodes") and hasattr(what, "entities")


def of_path(what: Any, make: Maker) -> Mesh:
    """Curves, as lines between the vertices of trimesh's discretisation; flat ones lie in the xy plane."""
    V = np.asarray(what.vertices)
    flat = np.zeros((len(V), 3 - V.shape[1]))
    return make.mesh(V=np.hstack([V, flat]), E=np.asarray(what.vertex_nodes))


CONVERSIONS = [(is_scene, of_scene), (is_mesh, of_mesh), (is_path, of_path)]
#: What looks like other libraries' objects too is asked last.
LAST = [(is_cloud, of_cloud)]

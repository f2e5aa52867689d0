"""Meshes: primitives of arrays, each with a material."""

import copy
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ... import _easypbr
from ...conversions.maker import finite_rows
from ...errors import ArgumentError
from .bounded import Bounded
from .changes import Noted
from .colors import colors, encoded
from .constants import GLTF
from .material import Material, MetallicRoughnessMaterial


def _floats(array: ArrayLike) -> NDArray[Any]:
    return np.ascontiguousarray(array, dtype=np.float32)


def _texcoords(array: ArrayLike) -> NDArray[Any]:
    return _floats(np.asarray(array)[:, :2])


#: What attributes of a Primitive are turned into when they are assigned.
_TAKEN_AS: dict[str, Callable[[Any], Any]] = {
    "positions": lambda array: np.asarray(array, dtype=np.float64),
    "normals": _floats,
    "tangents": _floats,
    "texcoord_0": _texcoords,
    "texcoord_1": _texcoords,
    "indices": lambda array: np.asarray(array).astype(np.int64, copy=False),
    "poses": lambda array: np.asarray(array, dtype=np.float64).reshape(-1, 4, 4),
    "mode": int,
}


class Primitive(Noted, Bounded):
    """Arrays that are drawn at once. `indices` are m x 3 of triangles, or flat; `mode` is glTF's; `poses` (k x 4 x 4) draws
    it k times."""

    positions: NDArray[Any]
    normals: NDArray[Any] | None
    tangents: NDArray[Any] | None
    texcoord_0: NDArray[Any] | None
    texcoord_1: NDArray[Any] | None
    color_0: NDArray[Any] | None
    joints_0: ArrayLike | None
    weights_0: ArrayLike | None
    targets: Any
    indices: NDArray[Any] | None
    material: Material
    mode: int
    poses: NDArray[Any] | None

    def __init__(
        self,
        positions: ArrayLike,
        normals: ArrayLike | None = None,
        tangents: ArrayLike | None = None,
        texcoord_0: ArrayLike | None = None,
        texcoord_1: ArrayLike | None = None,
        color_0: ArrayLike | None = None,
        joints_0: ArrayLike | None = None,
        weights_0: ArrayLike | None = None,
        indices: ArrayLike | None = None,
        material: Material | None = None,
        mode: int | None = None,
        targets: Any = None,
        poses: ArrayLike | None = None,
    ) -> None:
        given: dict[str, Any] = {
            "positions": positions, "normals": normals, "tangents": tangents, "texcoord_0": texcoord_0, "texcoord_1": texcoord_1,
            "color_0": color_0, "indices": indices, "poses": poses, "material": material,
            "mode": GLTF.TRIANGLES if mode is None else mode,
        }  # fmt: skip
        for name, value in given.items():
            setattr(self, name, value)
        self.joints_0, self.weights_0, self.targets = joints_0, weights_0, targets

    def __setattr__(self, name: str, value: Any) -> None:
        if name == "material":
            value = MetallicRoughnessMaterial() if value is None else value
            if not isinstance(value, Material):
                raise TypeError(f"a Primitive's material: expected a Material, got a {type(value).__name__}")
        elif name == "color_0" and value is not None:
            value = colors(value, len(self.positions))
        elif name in _TAKEN_AS and value is not None:
            value = _TAKEN_AS[name](value)
        super().__setattr__(name, value)

    @property
    def bounds(self) -> NDArray[Any]:
        """Lower and upper corner, 2 x 3."""
        if len(self.positions) == 0 or (self.poses is not None and len(self.poses) == 0):
            return np.zeros((2, 3))
        corners = np.array([self.positions.min(axis=0), self.positions.max(axis=0)])
        if self.poses is None:
            return corners
        places = self.poses[:, :3, 3]
        return np.array([(corners[0] + places).min(axis=0), (corners[1] + places).max(axis=0)])

    @property
    def is_transparent(self) -> bool:
        """Whether something of it is seen through: its material, or colours with an alpha below 1."""
        return self.material.is_transparent or (self.color_0 is not None and bool((self.color_0[:, 3] < 1).any()))

    def _order(self) -> NDArray[Any]:
        return np.arange(len(self.positions)) if self.indices is None else self.indices.ravel()

    def _points(self) -> NDArray[Any] | None:
        """Indices of the points that are drawn, None: all of them. Those without a finite position are left out with a warning;
        OpenGL does not draw them either."""
        order = self._order()
        if len(order) and not (order.min() >= 0 and order.max() < len(self.positions)):
            last = len(self.positions) - 1
            raise ArgumentError(f"a Primitive: expected indices from 0 to {last}, got {order.min()} to {order.max()}")
        kept = finite_rows(self.positions[order], False)
        return order[kept] if kept is not None else None if self.indices is None else order

    def elements(self) -> tuple[str, NDArray[Any] | None]:
        """ "F", "E" or "V", and the indices of triangles or lines."""
        order = self._order()
        if self.mode == GLTF.TRIANGLES:
            return "F", order.reshape(-1, 3)
        if self.mode == GLTF.TRIANGLE_STRIP:
            F = np.stack([order[:-2], order[1:-1], order[2:]], axis=1)
            F[1::2, :2] = F[1::2, 1::-1]
            return "F", F
        if self.mode == GLTF.TRIANGLE_FAN:
            return "F", np.stack([np.full(len(order) - 2, order[0]), order[1:-1], order[2:]], axis=1)
        if self.mode == GLTF.LINES:
            return "E", order.reshape(-1, 2)
        if self.mode in (GLTF.LINE_STRIP, GLTF.LINE_LOOP):
            E = np.stack([order[:-1], order[1:]], axis=1)
            return "E", np.vstack([E, [order[-1], order[0]]]) if self.mode == GLTF.LINE_LOOP else E
        if self.mode == GLTF.POINTS:
            return "V", None
        raise ArgumentError(f"a Primitive: expected a mode from 0 (points) to 6 (triangle fan), got {self.mode}")

    def made(self, is_flat: bool = False) -> "_easypbr.Mesh":
        """The mesh that is drawn: of its own without poses, else with a child for each. `is_flat`: its colours are shown as they
        are, without light; else they are linear factors of what is lit."""
        kind, elements = self.elements()
        arrays: dict[str, Any] = {"V": self.positions, "UV": self.texcoord_0}
        if self.color_0 is not None:
            color = self.color_0 if is_flat else encoded(self.color_0)
            arrays["C"] = np.column_stack([color[:, :3], self.color_0[:, 3]])
        if self.normals is not None and len(self.normals) == len(self.positions):
            arrays["N"] = self.normals
        if elements is not None:
            arrays[kind] = elements
        else:
            drawn = self._points()
            arrays = {name: array if array is None or drawn is None else array[drawn] for name, array in arrays.items()}
        if elements is not None and len(elements) == 0:
            arrays = {}  # Vertices alone would be drawn as points.
        mesh = _easypbr.Mesh()
        mesh.assign(**{name: array for name, array in arrays.items() if array is not None})
        self.material.put(mesh.material, is_flat)
        self.material.put_textures(mesh.material)
        mesh.style.flat = kind == "F" and not self.material.smooth
        if kind == "V":
            mesh.style.mode = "points"
        if self.poses is None:
            return mesh
        root = _easypbr.Mesh()
        for pose in self.poses:
            child = mesh.clone()
            child.T_parent_mesh = pose
            root.add_child(child)
        return root


class Mesh(Noted, Bounded):
    """Primitives under one name."""

    primitives: list[Primitive]
    name: str | None
    weights: ArrayLike | None
    is_visible: bool

    def __init__(
        self, primitives: Sequence[Primitive], name: str | None = None, weights: ArrayLike | None = None, is_visible: bool = True
    ) -> None:
        self.primitives = list(primitives)
        self.name, self.weights, self.is_visible = name, weights, is_visible

    @property
    def bounds(self) -> NDArray[Any]:
        """Lower and upper corner, 2 x 3."""
        if not self.primitives:
            return np.zeros((2, 3))
        corners = np.array([primitive.bounds for primitive in self.primitives])
        return np.array([corners[:, 0].min(axis=0), corners[:, 1].max(axis=0)])

    @property
    def is_transparent(self) -> bool:
        return any(primitive.is_transparent for primitive in self.primitives)

    @staticmethod
    def from_points(
        points: ArrayLike,
        colors: ArrayLike | None = None,
        normals: ArrayLike | None = None,
        is_visible: bool = True,
        poses: ArrayLike | None = None,
    ) -> "Mesh":
        """A cloud of n x 3 points."""
        return Mesh([Primitive(points, normals=normals, color_0=colors, mode=GLTF.POINTS, poses=poses)], is_visible=is_visible)

    @staticmethod
    def from_trimesh(
        mesh: Any,
        material: Material | None = None,
        is_visible: bool = True,
        poses: ArrayLike | None = None,
        wireframe: bool = False,
        smooth: bool = True,
    ) -> "Mesh":
        """A mesh of a trimesh.Trimesh, or of a list of them. Without `material` it has that of the trimesh."""
        parts = list(mesh) if isinstance(mesh, (list, tuple, set, np.ndarray)) else [mesh]
        primitives = []
        for part in parts:
            if not all(hasattr(part, name) for name in ("vertices", "faces", "visual")):
                raise ArgumentError(f"from_trimesh: expected a trimesh.Trimesh or a list of them, got a {type(part).__name__}")
            primitives.append(_primitive_of(part, material, poses, wireframe, smooth))
        return Mesh(primitives, is_visible=is_visible)


def _primitive_of(mesh: Any, material: Material | None, poses: Any, wireframe: bool, smooth: bool) -> Primitive:
    V, F = np.asarray(mesh.vertices, dtype=np.float64), np.asarray(mesh.faces)
    kind = getattr(mesh.visual, "kind", None)
    color, uv, normals = None, None, np.asarray(mesh.vertex_normals)
    if kind == "vertex":
        color = np.asarray(mesh.visual.vertex_colors)
    elif kind == "texture" and getattr(mesh.visual, "uv", None) is not None:
        uv = np.asarray(mesh.visual.uv)
    elif kind == "face":
        color = np.repeat(np.asarray(mesh.visual.face_colors), 3, axis=0)
    if kind == "face" or not smooth:
        corners = F.ravel()
        normals = np.repeat(np.asarray(mesh.face_normals), 3, axis=0) if not smooth else normals[corners]
        if kind != "face":
            color, uv = (None if array is None else array[corners] for array in (color, uv))
        V, F = V[corners], np.arange(len(corners)).reshape(-1, 3)
    # As in pyrender, a material that is given replaces colours, too, and is copied.
    own = _material_of(mesh, kind) if material is None else copy.copy(material)
    own.smooth, own.wireframe = smooth, wireframe
    color = color if material is None else None
    return Primitive(V, normals=normals, color_0=color, texcoord_0=uv, indices=F, material=own, poses=poses)


def _material_of(mesh: Any, kind: str | None) -> Material:
    """That of a textured trimesh; else a grey one. What they have is what pyrender 0.1.45 gives them."""
    given: Any = getattr(mesh.visual, "material", None) if kind == "texture" else None
    if isinstance(given, Material):
        return copy.copy(given)
    if hasattr(given, "baseColorFactor"):
        names = ("normalTexture", "occlusionTexture", "emissiveTexture", "emissiveFactor", "baseColorFactor", "baseColorTexture",
                 "metallicFactor", "roughnessFactor", "metallicRoughnessTexture", "doubleSided", "alphaCutoff")  # fmt: skip
        values: dict[str, Any] = {name: getattr(given, name, None) for name in names}
        values["doubleSided"] = bool(values["doubleSided"])
        return MetallicRoughnessMaterial(alphaMode="BLEND", **values)
    if hasattr(given, "diffuse"):
        exponent = np.ravel(getattr(given, "kwargs", {}).get("Ns", 1.0))[0]  # Of the highlight of Phong's model.
        roughness = (2 / (max(float(exponent), 0) + 2)) ** 0.25
        return MetallicRoughnessMaterial(
            alphaMode="BLEND", baseColorFactor=given.diffuse, baseColorTexture=getattr(given, "image", None), roughnessFactor=roughness,
        )  # fmt: skip
    grey = (1.0, 1.0, 1.0, 1.0) if kind in ("vertex", "face") else (0.3, 0.3, 0.3, 1.0)
    return MetallicRoughnessMaterial(alphaMode="BLEND", baseColorFactor=grey, metallicFactor=0.2, roughnessFactor=0.8)

"""Maker: what a conversion makes its mesh with."""

import logging
import os
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _easypbr
from .._easypbr import Mesh
from ..errors import ArgumentError
from ..tensors import array_of, as_numpy, rows_of

_log = logging.getLogger("easypbr")

#: Arrays of a mesh with a row per vertex.
PER_VERTEX = ("V", "N", "C", "UV", "T", "B", "I")


def warn(message: str) -> None:
    """What is left out is said: a warning of the logger "easypbr", as the library's own ones."""
    _log.warning(message)


class Maker:
    """Makes meshes from arrays. `any_mesh` converts what an object holds, such as the meshes of a scene."""

    has_colorbar: bool

    def __init__(self, any_mesh: "Callable[[Any, Maker], Mesh]", strict: bool = False) -> None:
        self._any_mesh = any_mesh
        self.strict = strict
        #: Whether something is coloured by values that the other library shows with a colour bar.
        self.has_colorbar = False
        #: Lights and cameras of files, by their names there.
        self.lights: dict[str, _easypbr.Light] = {}
        self.cameras: dict[str, _easypbr.Camera] = {}

    def file(self, path: str | os.PathLike[str]) -> Mesh:
        """The mesh of a file."""
        loaded = _easypbr.load_scene(path, strict=self.strict)
        for name, light in loaded.lights.items():
            self.lights[name if name not in self.lights else f"{loaded.mesh.name}/{name}"] = light
        for name, camera in loaded.cameras.items():
            self.cameras[name if name not in self.cameras else f"{loaded.mesh.name}/{name}"] = camera
        return loaded.mesh

    def any(self, what: Any) -> Mesh:
        """A mesh of anything that can be drawn."""
        return self._any_mesh(what, self)

    def mesh(self, name: str = "", scalars: dict[str, Any] | None = None, **arrays: Any) -> Mesh:
        """A mesh of arrays by their names in Mesh. Points of a cloud without a finite position are left out with a warning,
        or raise ArgumentError if `strict`."""
        given = {key: as_numpy(value) for key, value in arrays.items() if value is not None}
        given, scalars = self._finite(given, {key: as_numpy(value) for key, value in (scalars or {}).items()})
        mesh = Mesh()
        mesh.assign(**given, **({"scalars": scalars} if scalars else {}))
        mesh.name = name
        return mesh

    def _finite(self, arrays: dict[str, Any], scalars: dict[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
        """The rows of a cloud whose positions are finite; a mesh keeps all of its vertices, for its faces count them."""
        kept = None if _has(arrays, "F") or _has(arrays, "E") else finite_rows(arrays.get("V"), self.strict)
        if kept is None:
            return arrays, scalars
        per_point = (*PER_VERTEX, "L")
        arrays = {key: np.asarray(as_numpy(value))[kept] if key in per_point and _counts(value, kept) else value
                  for key, value in arrays.items()}
        return arrays, {key: np.asarray(as_numpy(value))[kept] if _counts(value, kept) else value
                        for key, value in scalars.items()}

    def leave_out(self, what: str) -> None:
        """Says what has no place in a mesh."""
        warn(f"left out: {what}")

    def parts(self, children: list[Mesh], name: str = "") -> Mesh:
        """A mesh with these children; a single one stands for itself."""
        if len(children) == 1 and not name:
            return children[0]
        root = Mesh()
        root.name = name
        for child in children:
            root.add_child(child)
        return root

    def show_scalars(self, mesh: Mesh, name: str, limits: Any = None) -> None:
        """Colours the mesh by this scalar field, as the library does that it comes from."""
        mesh.style.color_by = "scalar"
        mesh.style.scalar = name
        if limits is not None:
            mesh.style.color_min, mesh.style.color_max = (float(limit) for limit in limits)
        self.has_colorbar = True


def _has(arrays: dict[str, Any], name: str) -> bool:
    return name in arrays and len(arrays[name]) > 0


def _counts(value: Any, kept: NDArray[Any]) -> bool:
    return hasattr(value, "__len__") and len(value) == len(kept)


def finite_rows(points: Any, strict: bool = False) -> NDArray[Any] | None:
    """Which rows of n x 3 positions are finite, with a warning that counts the others; None: all of them, or the array is of
    another kind. Raises ArgumentError if none is, or if not all are and `strict` is set."""
    points = None if points is None else array_of(points, "points")
    if points is None or points.dtype.kind != "f" or points.ndim != 2 or len(points) == 0:
        return None
    kept: NDArray[Any] = np.isfinite(points).all(axis=1)
    lost = int(len(kept) - np.count_nonzero(kept))
    if lost == 0:
        return None
    if lost == len(kept):
        raise ArgumentError(f"points: none of {len(kept)} has a finite position")
    if strict:
        row = int(np.argmin(kept))
        raise ArgumentError(
            f"points: expected finite positions, got ({', '.join(f'{x:g}' for x in points[row])}) in row {row} of "
            f"{len(kept)}; without strict=True the {lost} that have none are left out"
        )
    warn(f"{lost} of {len(kept)} points have no finite position and are left out")
    return kept


def rows(array: Any, count: int, name: str = "mesh arrays") -> NDArray[Any] | None:
    """The array if it has `count` rows, else None."""
    array = None if array is None else array_of(array, name)
    return array if array is not None and count and array.ndim > 0 and len(array) == count else None


def colors(array: Any, count: int) -> NDArray[Any] | None:
    """Colours of `count` rows as a mesh takes them: uint8 and uint16 as they are; of other types 0 to 1 if none is above 1,
    else 0 to 255. None: the array has another number of rows. Raises ArgumentError for other values."""
    found = rows(array, count, "colours")
    if found is None:
        return None
    if found.ndim == 1 or found.shape[1] not in (3, 4):
        raise ArgumentError(f"colours: expected n x 3 or n x 4, got {' x '.join(map(str, found.shape))}")
    if found.dtype in (np.uint8, np.uint16):
        return found
    if found.dtype.kind not in "fiu":
        raise ArgumentError(f"colours: expected numbers, got {found.dtype}")
    return np.asarray(_easypbr.unit_colors(found))


def triangles(faces: Any, V: Any) -> tuple[NDArray[Any] | None, NDArray[Any] | None]:
    """m x 3 vertex indices of faces (m x k, or a sequence of polygons of any number of corners), and the polygon that each
    belongs to; None: each is a triangle already. Polygons of the vertices V are cut as those of files are, concave ones too."""
    if faces is None:
        return None, None
    faces = _sequence(as_numpy(faces))
    if isinstance(faces, np.ndarray) and faces.dtype == object:
        faces = faces.tolist()  # Polygons of different numbers of corners.
    if not isinstance(faces, np.ndarray):
        polygons = rows_of(list(faces), "faces")
        if not isinstance(polygons, np.ndarray):
            return _cut(_corners(polygons), [len(face) for face in polygons], V)
        faces = polygons
    if faces.ndim != 2 or faces.shape[1] <= 3:
        return (faces if faces.size else None), None
    return _cut(faces.ravel(), np.full(len(faces), faces.shape[1]), V)


def _sequence(faces: Any) -> Any:
    if not isinstance(faces, Iterable) or getattr(faces, "ndim", 1) == 0:
        raise ArgumentError(f"faces: expected m x 3 vertex indices, or polygons, got a {type(faces).__name__}")
    return faces


def _corners(polygons: list[NDArray[Any]]) -> NDArray[Any]:
    if any(face.ndim != 1 or len(face) < 3 for face in polygons):
        raise ArgumentError("faces: expected m x 3 vertex indices, or polygons of at least 3 corners each")
    return np.concatenate(polygons)


def _cut(corners: NDArray[Any], sizes: Any, V: Any) -> tuple[NDArray[Any], NDArray[Any]]:
    F, polygon_of = _easypbr.cut_polygons(None if V is None else as_numpy(V), corners, sizes)
    return np.asarray(F), np.asarray(polygon_of)


def separate_corners(faces: NDArray[Any], values: Any) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
    """Of values per face: the vertex of each corner, faces of separate corners, and a value per corner."""
    count = faces.shape[1]
    return faces.ravel(), np.arange(faces.size).reshape(-1, count), np.repeat(np.asarray(values), count, axis=0)

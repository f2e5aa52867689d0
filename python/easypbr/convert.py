"""Meshes of whatever people have: files, arrays, tables, and objects of other libraries."""

import os
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._easypbr import Mesh
from .conversions import from_arrays, from_open3d, from_trimesh, from_vtk
from .conversions.faces import Faces
from .conversions.maker import Maker
from .errors import ArgumentError
from .tensors import array_of, as_numpy, is_array

ACCEPTED = (
    "a path, an easypbr.Mesh, points (n x 3, or n x 6 with colours), (V, F), a dict or a table of arrays, "
    "an object of trimesh, Open3D, PyVista or VTK, or a list of these"
)
#: Pairs of functions: whether an object is of a kind, and its mesh.
_CONVERSIONS = [
    (from_arrays.is_structured, from_arrays.of_fields),
    *from_trimesh.CONVERSIONS,
    *from_open3d.CONVERSIONS,
    *from_vtk.CONVERSIONS,
    *from_trimesh.LAST,
    (from_arrays.is_table, from_arrays.of_table),
]


def as_mesh(what: Any, strict: bool = False) -> Mesh:
    """A Mesh of a path; a Mesh; points, n x 3 or with further columns as in a text file, n x 6 with colours, h x w x 3; a tuple
    (V, F); a dict of arrays (V, F, C, ..., or points, vertices, faces, colors, ...); a table or a structured array with
    columns x, y and z; an object of trimesh, Open3D, PyVista or VTK; or a list of these, whose meshes become children. Arrays
    may be any library's with DLPack, `__array__` or `__array_interface__`.

    A Mesh is returned as it is, in a list a copy of it; arrays are copied once. Points without a finite position are left out
    with a warning, or raise ArgumentError if `strict`, of a file FormatError. Raises ArgumentError for what cannot be drawn,
    and for a list of arrays whose first two may be clouds as well as the vertices and faces of one mesh."""
    return converted(what, strict)[0]


def converted(what: Any, strict: bool = False) -> tuple[Mesh, Maker]:
    """as_mesh(), and what came with it: lights and cameras of files, and whether it is coloured by values that its own
    library shows with a colour bar."""
    make = Maker(_any_mesh, strict)
    return _any_mesh(what, make), make


def _any_mesh(what: Any, make: Maker) -> Mesh:
    if isinstance(what, Mesh):
        return what
    if isinstance(what, (str, os.PathLike)):
        return make.file(what)
    if isinstance(what, Mapping):
        return from_arrays.of_dict(what, make)
    if isinstance(what, (tuple, list)):
        return _of_sequence(what, make)
    for recognises, convert in _CONVERSIONS:
        if recognises(what):
            return _checked(convert, what, make)
    if is_array(what):
        return from_arrays.of_points(what, make)
    raise ArgumentError(f"cannot show a {type(what).__module__}.{type(what).__qualname__}: expected {ACCEPTED}")


def _checked(convert: Callable[[Any, Maker], Mesh], what: Any, make: Maker) -> Mesh:
    """What goes wrong inside an object of another library names that object."""
    try:
        return convert(what, make)
    except (AttributeError, IndexError, TypeError) as error:
        kind = f"{type(what).__module__}.{type(what).__qualname__}"
        raise ArgumentError(f"cannot show a {kind}, which has not the expected form: {error}") from error


def _of_sequence(what: "tuple[Any, ...] | list[Any]", make: Maker) -> Mesh:
    """Rows of numbers, (V,), (V, F), or what can be drawn: two arrays are (V, F) in a tuple, and two clouds in a list."""
    if len(what) == 0:
        raise ArgumentError(f"an empty {type(what).__name__}: there is nothing to show; expected {ACCEPTED}")
    if _is_rows(what):
        return from_arrays.of_rows(what, make)
    parts = [_with_numpy(part) for part in what]
    V = _matrix(parts[0]) if len(parts) > 1 else None
    if V is not None and (parts[1] is None or _is_numbers(parts[1])):
        if isinstance(what, tuple) and len(parts) == 2:
            return _of_vertices_and_faces(V, parts[1], make)
        _refuse_vertices_and_faces(V, parts, isinstance(what, tuple))
    # A mesh has one parent: those that are given stay as they are.
    children = [part.clone() if isinstance(part, Mesh) and len(parts) > 1 else make.any(part) for part in parts]
    return make.parts(children)


def _is_rows(what: "tuple[Any, ...] | list[Any]") -> bool:
    """Whether this is the rows of an array, each of three or more numbers."""
    first = _with_numpy(what[0])
    if isinstance(first, (tuple, list)):
        return len(first) >= 3 and all(isinstance(x, (int, float, np.number)) for x in first)
    return isinstance(first, np.ndarray) and first.ndim == 1 and not from_arrays.is_structured(first)


def _with_numpy(part: Any) -> Any:
    """An array of another library as one of numpy's; anything else as it is."""
    return part if any(recognises(part) for recognises, _ in _CONVERSIONS) else as_numpy(part)


def _matrix(what: Any) -> NDArray[Any] | None:
    """An array of numbers, or a list or table of them, as n x k; None for anything else."""
    is_list = isinstance(what, (tuple, list))
    if not (len(what) > 0 and _is_rows(what) if is_list else is_array(what)):
        return None
    array = array_of(what, "points")
    return array if array.ndim == 2 and array.dtype.kind in "iuf" else None


def _is_numbers(what: Any) -> bool:
    """Whether this is an array, or a list of numbers or of rows of them, which may differ in length."""
    if isinstance(what, np.ndarray) and what.dtype == object:
        return _is_numbers(what.tolist())
    if isinstance(what, (tuple, list)):
        return all(_is_row(row) for row in what)
    return is_array(what) and not from_arrays.is_structured(what)


def _is_row(what: Any) -> bool:
    if isinstance(what, (tuple, list)):
        return all(isinstance(x, (int, float, np.number)) for x in what)
    return isinstance(what, (int, float, np.number)) or (is_array(what) and array_of(what, "faces").ndim == 1)


def _of_vertices_and_faces(V: NDArray[Any], given: Any, make: Maker) -> Mesh:
    faces = Faces(given)
    got = f"({_described(V)}, {_described(given)}): expected (V, F)"
    if faces.are_colors(len(V)):
        raise ArgumentError(f"{got}, got what look like colours; give them in a dict: {{'V': V, 'C': C}}")
    if not (faces.are_rows() and faces.are_whole()):
        raise ArgumentError(
            f"{got}, with m x 3 vertex indices or polygons; give two clouds as a list, [a, b], and further arrays in a dict: "
            "{'V': V, 'C': C}"
        )
    return from_arrays.of_vertices_and_faces(V, faces.rows, make)


def _refuse_vertices_and_faces(V: NDArray[Any], parts: list[Any], is_tuple: bool) -> None:
    """Raises ArgumentError for a list, or for more than two parts, that may be meant as the arrays of one mesh. Of points with
    whole numbers the second part is a cloud where one row has a number twice, as points of a grid have and no face has."""
    faces = Faces(parts[1])
    if parts[1] is None or V.shape[1] != 3 or not (faces.are_rows() and faces.are_integers()):
        return
    if V.dtype.kind != "f" and not faces.have_distinct_corners():
        return
    are_of_vertices = faces.are_below(len(V))
    got = ", ".join(_described(part) for part in parts)
    if len(parts) > 2 and (is_tuple or are_of_vertices):
        raise ArgumentError(
            f"{f'({got})' if is_tuple else f'[{got}]'}: expected (V, F); give further arrays in a dict: "
            "{'V': V, 'F': F, 'C': C}, and clouds as a list of dicts, [{'V': a}, {'V': b}]"
        )
    if are_of_vertices:
        raise ArgumentError(
            f"[{got}], a mesh or two clouds: expected a tuple, (V, F), for a mesh of vertices and faces, or a list of dicts, "
            "[{'V': a}, {'V': b}], for clouds"
        )


def _described(part: Any) -> str:
    shape = getattr(part, "shape", None)
    return type(part).__name__ if shape is None else " x ".join(map(str, shape))

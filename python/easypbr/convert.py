"""Meshes of whatever people have: files, arrays, tables, and objects of other libraries."""

import os
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from . import _easypbr
from ._easypbr import Mesh
from .conversions import from_arrays, from_open3d, from_trimesh, from_vtk
from .conversions.maker import Maker
from .errors import ArgumentError
from .tensors import as_numpy

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
    """A Mesh of a path; a Mesh; points, n x 3 or with further columns as in a text file, n x 6 with colours, h x w x 3; (V, F); a
    dict of arrays (V, F, C, ..., or points, vertices, faces, colors, ...); a table or a structured array with columns x, y and z;
    an object of trimesh, Open3D, PyVista or VTK; or a list of these, whose meshes become children. Arrays may be any library's
    with DLPack.

    A Mesh is returned as it is, in a list a copy of it; arrays are copied once. Points without a finite position are left out with a warning, or
    raise ArgumentError if `strict`, of a file FormatError. Raises ArgumentError for what cannot be drawn."""
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
    if _is_array(what):
        return from_arrays.of_points(what, make)
    raise ArgumentError(f"cannot show a {type(what).__module__}.{type(what).__qualname__}: expected {ACCEPTED}")


def _checked(convert: Callable[[Any, Maker], Mesh], what: Any, make: Maker) -> Mesh:
    """What goes wrong inside an object of another library names that object."""
    try:
        return convert(what, make)
    except (AttributeError, IndexError, TypeError) as error:
        kind = f"{type(what).__module__}.{type(what).__qualname__}"
        raise ArgumentError(f"cannot show a {kind}, which has not the expected form: {error}") from error


def _is_array(what: Any) -> bool:
    return isinstance(what, np.ndarray) or any(
        hasattr(what, name) for name in ("__array__", "__array_interface__", "__dlpack__", "__cuda_array_interface__")
    )


def _of_sequence(what: "tuple[Any, ...] | list[Any]", make: Maker) -> Mesh:
    """Rows of numbers, (V,), (V, F), or a list of what can be drawn."""
    if len(what) == 0:
        raise ArgumentError(f"an empty {type(what).__name__}: there is nothing to show; expected {ACCEPTED}")
    if _is_rows(what):
        return from_arrays.of_rows(what, make)
    if len(what) == 2 and _is_matrix(what[0]) and _is_faces(what[1], may_be_floats=isinstance(what, tuple)):
        return from_arrays.of_vertices_and_faces(what[0], what[1], make)
    if len(what) > 2 and _is_matrix(what[0]) and _is_faces(what[1], may_be_floats=False) and _dtype(what[0]) == "f":
        raise ArgumentError(
            f"({', '.join(_described(part) for part in what)}): expected (V, F); give further arrays in a dict: "
            "{'V': V, 'F': F, 'C': C}"
        )
    # A mesh has one parent: those that are given stay as they are.
    children = [part.clone() if isinstance(part, Mesh) and len(what) > 1 else make.any(part) for part in what]
    return make.parts(children)


def _described(part: Any) -> str:
    shape = getattr(part, "shape", None)
    return type(part).__name__ if shape is None else " x ".join(map(str, shape))


def _is_rows(what: "tuple[Any, ...] | list[Any]") -> bool:
    """Whether this is the rows of an array, each of three or more numbers."""
    first = what[0]
    if isinstance(first, (str, os.PathLike, Mapping, Mesh)):
        return False
    if isinstance(first, (tuple, list)):
        return len(first) >= 3 and all(isinstance(x, (int, float, np.number)) for x in first)
    if from_arrays.is_structured(first) or hasattr(first, "vertices"):
        return False
    return _is_array(first) and len(getattr(first, "shape", ())) == 1


def _dtype(array: Any) -> str:
    return np.asarray(as_numpy(array)).dtype.kind


def _is_matrix(what: Any) -> bool:
    """Whether this is an array of numbers with rows."""
    if isinstance(what, (tuple, list)):
        return len(what) > 0 and _is_rows(what)
    return _is_array(what) and len(getattr(what, "shape", ())) == 2


def _is_faces(what: Any, may_be_floats: bool) -> bool:
    """Whether this may be the second of (V, F): vertex indices, as floats only if `may_be_floats`."""
    if what is None:
        return True
    if isinstance(what, np.ndarray) and what.dtype == object:
        return _is_faces(what.tolist(), may_be_floats)
    if isinstance(what, (tuple, list)):
        return all(_is_corners(face, may_be_floats) for face in what)
    return _is_array(what) and len(getattr(what, "shape", ())) == 2 and _are_indices(what, may_be_floats)


def _is_corners(face: Any, may_be_floats: bool) -> bool:
    """Whether this may be one of a list of faces."""
    if isinstance(face, (tuple, list)):
        return all(_is_index(i, may_be_floats) for i in face)
    return _is_array(face) and len(getattr(face, "shape", ())) == 1 and _are_indices(face, may_be_floats)


def _are_indices(what: Any, may_be_floats: bool) -> bool:
    array = np.asarray(as_numpy(what))
    if array.dtype.kind in "iu":
        return True
    return may_be_floats and array.dtype.kind == "f" and bool((array == np.floor(array)).all())


def _is_index(value: Any, may_be_float: bool) -> bool:
    if isinstance(value, (int, np.integer)):
        return True
    return may_be_float and isinstance(value, (float, np.floating)) and float(value).is_integer()

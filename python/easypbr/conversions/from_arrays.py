"""Arrays by themselves, in dicts and in tables."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._easypbr import Mesh
from ..errors import ArgumentError, UnknownNameError
from ..tensors import array_of, as_numpy
from .maker import Maker, colors, triangles

#: What arrays of a mesh are called: here, in NPZ files, in pandas and in Polyscope. The first is Mesh's own name.
NAMES: dict[str, tuple[str, ...]] = {
    "V": ("V", "v", "points", "xyz", "vertices", "verts", "positions", "position", "pos", "coords", "coordinates", "nodes"),
    "F": ("F", "f", "faces", "triangles", "tris", "simplices"),
    "N": ("N", "normals", "normal", "vertex_normals"),
    "C": ("C", "colors", "colours", "color", "rgb", "rgba", "vertex_colors"),
    "UV": ("UV", "uv", "uvs", "texcoords", "texture_coordinates"),
    "T": ("T", "tangents"),
    "B": ("B", "bitangents"),
    "E": ("E", "edges", "lines"),
    "L": ("L", "labels", "label", "semantic", "segmentation"),
    "I": ("I", "intensity", "intensities", "remission", "reflectance"),
}
_CALLED = {word: name for name, words in NAMES.items() for word in words}
#: What a dict may hold beside arrays.
_OTHERS = ("name", "label_map", "scalars", "offset", "source_face")
_COLUMNS = {
    "x": "x", "y": "y", "z": "z",
    "nx": "nx", "ny": "ny", "nz": "nz", "normal_x": "nx", "normal_y": "ny", "normal_z": "nz",
    "r": "r", "g": "g", "b": "b", "a": "a", "red": "r", "green": "g", "blue": "b", "alpha": "a",
    **{word: "I" for word in NAMES["I"]},
    **{word: "L" for word in (*NAMES["L"], "class", "classification")},
}  # fmt: skip
#: What the values of a field of several are called, in tables.
_PARTS: dict[str, list[tuple[str, ...]]] = {
    "V": [("x", "y", "z")], "N": [("nx", "ny", "nz")], "C": [("r", "g", "b"), ("r", "g", "b", "a")],
}  # fmt: skip
#: Points that decide what the columns of an array hold.
_SAMPLES = 1000


def of_dict(arrays: Mapping[str, Any], make: Maker) -> Mesh:
    """A mesh of arrays by their names. Other arrays with a value for each vertex or face are scalars."""
    given: dict[str, Any] = {}
    others: dict[str, Any] = {}
    for word, value in arrays.items():
        value = value if word in _OTHERS else as_numpy(value)
        name = _CALLED.get(str(word))
        if name in given:
            raise ArgumentError(f"a dict of arrays: '{word}' is {name}, which is given already: expected one of them")
        if name is not None:
            given[name] = value
        else:
            others[str(word)] = value
    count = _vertex_count(given)
    F, face_of = triangles(given.get("F"), given.get("V"))
    given["F"] = F
    if face_of is not None:
        if others.get("source_face") is not None:
            raise ArgumentError("source_face: expected triangles beside it, got faces of other numbers of corners")
        others["source_face"] = face_of
    if given.get("E") is not None:
        given["E"] = edges(given["E"], count)
    if given.get("C") is not None:
        found = colors(given["C"], count)
        given["C"] = given["C"] if found is None else found
    named = {name: others.pop(name) for name in _OTHERS if name in others}
    counts = (count, *_face_counts(F, face_of, named.get("source_face")))
    scalars = dict(named.pop("scalars", None) or {})
    scalars.update({word: _scalar(word, value, counts) for word, value in others.items()})
    return make.mesh(scalars=scalars, **given, **named)


def _vertex_count(given: Mapping[str, Any]) -> int:
    """The rows of V. Raises ArgumentError if they are missing beside faces or edges."""
    if given.get("V") is not None:
        V = array_of(given["V"], "points")
        return len(V) if V.ndim else 0
    other = next((name for name in ("F", "E") if given.get(name) is not None), None)
    if other is not None:
        raise ArgumentError(f"a dict of arrays: expected V (or {', '.join(NAMES['V'][2:5])}, ...) beside {other}, got none")
    return 0


def _face_counts(F: Any, split: Any, polygon_of: Any) -> tuple[int, ...]:
    """How many values may belong to faces: as many as the faces that were given, or polygons of these. `split`: the polygon
    of each triangle, where the triangles F were none of those given."""
    if F is None:
        return ()
    triangles = (len(F),) if split is None else ()
    return triangles if polygon_of is None else (int(np.max(as_numpy(polygon_of), initial=-1)) + 1, *triangles)


def _scalar(word: str, value: Any, counts: tuple[int, ...]) -> NDArray[Any]:
    """`counts`: of vertices, and of faces if there are any."""
    vertices, *others = counts
    array = array_of(value, f"scalars '{word}'") if not isinstance(value, str) else np.empty(0, str)
    if array.ndim == 2 and array.shape[1] == 1:
        array = array[:, 0]
    if array.dtype.kind in "biuf" and array.ndim == 1 and len(array) in counts and len(array):
        return array.astype(np.float32) if array.dtype.kind == "b" else array
    if array.dtype.kind in "biuf" and array.ndim == 1 and vertices:
        of_faces = f", or {others[0]}, one for each face" if others else ""
        raise ArgumentError(f"scalars '{word}': expected {vertices} values, one for each vertex{of_faces}, got {len(array)}")
    raise UnknownNameError(
        f"a mesh has no array '{word}'; a dict may hold {', '.join(NAMES)} (points, vertices, faces, normals, colors, ...), "
        f"{', '.join(_OTHERS)}, and scalars: arrays with a number for each vertex or face"
    )


def edges(given: Any, count: int) -> Any:
    """k x 2 vertex indices; "line", "loop" and "segments" as Polyscope has them for its curve networks."""
    if not isinstance(given, str):
        pairs = array_of(given, "edges")
        if pairs.ndim == 0:
            raise ArgumentError(f"edges: expected k x 2 vertex indices, 'line', 'loop' or 'segments', got {given!r}")
        return pairs
    first = np.arange(count)
    shape = given.lower()
    if shape == "line":
        return np.stack([first[:-1], first[1:]], axis=1)
    if shape == "loop":
        return np.stack([first, np.roll(first, -1)], axis=1)
    if shape == "segments":
        return first[: count // 2 * 2].reshape(-1, 2)
    raise ArgumentError(f"edges: expected k x 2 vertex indices, 'line', 'loop' or 'segments', got '{given}'")


def of_rows(given: Sequence[Any], make: Maker) -> Mesh:
    """A cloud of a list of rows, which may be arrays of other libraries."""
    rows = [array_of(row, "points") for row in given]
    other = next((i for i, row in enumerate(rows) if row.shape != rows[0].shape), None)
    if other is not None:
        lengths = f"{len(rows[0])} in row 0 and {len(rows[other]) if rows[other].ndim else 'a single number'} in row {other}"
        raise ArgumentError(
            f"points: expected as many numbers in each row, got {lengths}; rows of faces may differ, and hold whole numbers"
        )
    return of_points(np.asarray(rows), make)


def of_points(array: Any, make: Maker) -> Mesh:
    """A cloud of n x 3 positions, or h x w x 3; further columns are recognised as those of a text file without names are."""
    points = array_of(array, "points")
    if points.dtype.kind not in "fiu":
        raise ArgumentError(f"points: expected numbers, got {points.dtype}")
    if points.ndim < 2 or points.shape[-1] < 3:
        raise ArgumentError(
            f"points: expected n x 3 positions, or n x 6 with colours, got {' x '.join(map(str, points.shape)) or 'a number'}"
        )
    points = points.reshape(-1, points.shape[-1])
    found: dict[str, Any] = {"V": points[:, :3]}
    scalars: dict[str, NDArray[Any]] = {}
    at, lost = 3, False
    while at < points.shape[1]:
        block = points[:, at : at + 3]
        left = points.shape[1] - at
        if "N" not in found and _is_normal(block):
            found["N"], at = block, at + 3
        elif "C" not in found and _is_color(block, alone=points.shape[1] == 6):
            found["C"], at = colors(block, len(block)), at + 3
        elif not lost and left == 1 and at > 3 and _is_whole(block):
            found["L"], at = block[:, 0], at + 1
        elif not lost and "I" not in found and (left == 1 or left >= 4):
            found["I"], at = block[:, 0], at + 1
        else:
            scalars[f"column_{at + 1}"], at, lost = block[:, 0], at + 1, True
    return make.mesh(scalars=scalars, **found)


def _sample(block: NDArray[Any]) -> NDArray[Any]:
    step = max(1, len(block) // _SAMPLES)
    sample = np.asarray(block[::step], dtype=np.float64)
    return sample[np.isfinite(sample).all(axis=1)]


def _is_normal(block: NDArray[Any]) -> bool:
    """Whether three columns are unit vectors, or zero for points without a normal."""
    if block.shape[1] != 3 or block.dtype.kind != "f":
        return False
    length = np.linalg.norm(_sample(block), axis=1)
    return bool(length.any() and ((length == 0) | (np.abs(length - 1) < 0.02)).all())


def _is_color(block: NDArray[Any], alone: bool) -> bool:
    """Whether three columns are 0 to 1, or whole numbers from 0 to 255; where there are no others any numbers up to 255."""
    sample = _sample(block)
    if block.shape[1] != 3 or not ((sample >= 0) & (sample <= 255)).all():
        return False
    return alone or bool((sample <= 1).all() or (sample == np.floor(sample)).all())


def _is_whole(block: NDArray[Any]) -> bool:
    sample = _sample(block)
    return bool(((sample == np.floor(sample)) & (np.abs(sample) < 1e6)).all())


def of_vertices_and_faces(V: Any, F: Any, make: Maker) -> Mesh:
    """A mesh of (V, F)."""
    corners, face_of = triangles(F, V)
    return make.mesh(V=as_numpy(V), F=corners, source_face=face_of)


def is_table(what: Any) -> bool:
    """A pandas or Polars frame, or another table with columns by name."""
    return hasattr(what, "columns") and hasattr(what, "__getitem__") and hasattr(what, "shape")


def of_table(what: Any, make: Maker) -> Mesh:
    """A cloud of a table's columns by their names."""
    return _of_columns([(str(word), np.asanyarray(what[word])) for word in what.columns], make)


def is_structured(what: Any) -> bool:
    """A numpy array with fields by name."""
    return isinstance(what, np.ndarray) and bool(what.dtype.names)


def of_fields(array: NDArray[Any], make: Maker) -> Mesh:
    """A cloud of the fields of a structured array, of any shape; a field of several values is as many columns."""
    points = as_numpy(array).reshape(-1)
    columns: list[tuple[str, NDArray[Any]]] = []
    for word in points.dtype.names or ():
        kind = points.dtype[word]
        values = points[word].reshape(len(points), int(np.prod(kind.shape)))
        columns += zip(_part_names(word, values.shape[1]), values.T)
    return _of_columns(columns, make)


def _part_names(word: str, count: int) -> tuple[str, ...]:
    """The same as files of structured arrays have them."""
    if count == 1:
        return (word,)
    kind = _CALLED.get(word, _CALLED.get(word.lower(), ""))
    whole = (f"{word}_{i}" for i in range(count))
    return next((parts for parts in _PARTS.get(kind, []) if len(parts) == count), tuple(whole))


def _of_columns(given: list[tuple[str, NDArray[Any]]], make: Maker) -> Mesh:
    """A cloud of columns x, y and z; r, g, b (0 to 1 or 0 to 255), nx, ny, nz, intensity and label by their names; others of
    numbers are scalars. A column rgb or rgba of four bytes is a packed colour, as PCL and ROS have it."""
    columns: dict[str, NDArray[Any]] = {}
    scalars: dict[str, NDArray[Any]] = {}
    packed: dict[str, NDArray[Any]] = {}
    words = []
    for word, values in _without_masks(given):
        if values.dtype.kind == "b":
            values = values.astype(np.float32)
        name = _COLUMNS.get(word.strip().lower())
        if values.dtype.kind not in "iuf":
            words.append(word)
        elif _is_packed_color(word, values):
            packed = packed or _unpacked(word, values)
        elif name is not None and name not in columns:
            columns[name] = values
        else:
            scalars[word] = values
    if not {"x", "y", "z"} <= set(columns):
        names = ", ".join(word for word, _ in given) or "none"
        raise ArgumentError(f"a table: expected columns x, y and z, got {names}")
    if words:
        make.leave_out(f"columns that hold no numbers: {', '.join(words)}")
    if not {"r", "g", "b"} <= set(columns):
        columns |= packed
    return make.mesh(scalars=scalars | _incomplete(columns), **_arrays(columns))


def _without_masks(given: list[tuple[str, NDArray[Any]]]) -> list[tuple[str, NDArray[Any]]]:
    """Masked numbers become NaN. Labels and colours have no such value: they may be masked only where the position is, whose
    point is left out."""
    masks = [np.ma.getmask(values) for _, values in given]
    positions = [mask for mask, (word, _) in zip(masks, given) if _COLUMNS.get(word.strip().lower()) in ("x", "y", "z")]
    left_out = np.logical_or.reduce(positions) if positions else False
    return [(word, _without_mask(word, values, mask, left_out)) for (word, values), mask in zip(given, masks)]


def _without_mask(word: str, values: NDArray[Any], mask: Any, left_out: Any) -> NDArray[Any]:
    kind = _COLUMNS.get(word.strip().lower(), "")
    if not np.any(mask) or values.dtype.kind not in "iufb":
        return np.ma.getdata(values)
    if kind not in ("r", "g", "b", "a", "L") and not _is_packed_color(word, values):
        floats = values.dtype if values.dtype.kind == "f" else np.float64
        return np.asarray(np.ma.filled(values.astype(floats), np.nan))
    count = int(np.count_nonzero(mask & ~np.broadcast_to(left_out, mask.shape)))
    if count:
        what = "labels" if kind == "L" else "colours"
        raise ArgumentError(
            f"{word}: expected {what} of all points, got {count} masked values: fill them, as by array.filled(value)"
        )
    return np.ma.getdata(values)


def _is_packed_color(word: str, values: NDArray[Any]) -> bool:
    return word.strip().lower() in ("rgb", "rgba") and values.dtype.itemsize == 4


def _unpacked(word: str, values: NDArray[Any]) -> dict[str, NDArray[Any]]:
    """The columns r, g, b (and a) of the bits 0xAARRGGBB, whatever type of number they pass for."""
    bits = values.astype(values.dtype.newbyteorder("=")).view(np.uint32)
    shifts = {"r": 16, "g": 8, "b": 0, "a": 24}
    return {name: (bits >> shifts[name]).astype(np.uint8) for name in word.strip().lower()}


def _arrays(columns: dict[str, NDArray[Any]]) -> dict[str, Any]:
    arrays: dict[str, Any] = {"V": np.stack([columns[axis] for axis in "xyz"], axis=1)}
    if all(name in columns for name in ("nx", "ny", "nz")):
        arrays["N"] = np.stack([columns[name] for name in ("nx", "ny", "nz")], axis=1)
    if all(name in columns for name in "rgb"):
        parts = [columns[name] for name in "rgba" if name in columns]
        arrays["C"] = colors(np.stack(parts, axis=1), len(parts[0]))
    return arrays | {name: columns[name] for name in "IL" if name in columns}


def _incomplete(columns: dict[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """Parts of colours and normals whose others are missing are scalars like any column."""
    found: dict[str, NDArray[Any]] = {}
    for group in (("r", "g", "b", "a"), ("nx", "ny", "nz")):
        if not all(name in columns for name in group[:3]):
            found.update({name: columns[name] for name in group if name in columns})
    return found

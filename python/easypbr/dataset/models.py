"""Models of objects as files, for annotations that refer to them."""

import io
from collections.abc import Collection
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _easypbr
from .extents import bounds, without_offset
from .tables import DatasetTables


def single_model(spec: DatasetTables, class_name: str, outputs: Collection[Path] = ()) -> tuple[str, float] | None:
    """The file and size of a class whose objects are all of one model; None for the others. `outputs` as
    ObjectSpec.files()."""
    found = set()
    for entry in spec.objects:
        if entry.distractor or entry.name() != class_name:
            continue
        low, high = entry.size if isinstance(entry.size, tuple) else (entry.size, entry.size)
        files = entry.files(outputs)
        found.add((files[0], low) if low == high and len(files) == 1 else None)
    return found.pop() if len(found) == 1 else None


def model_ply(path: str, size: float) -> bytes:
    """The mesh as large as it is shown (its longest side is `size` metres), in millimetres, as text PLY with normals and,
    where each vertex has one, colours."""
    mesh = without_offset(_easypbr.Mesh(path))
    low, high = bounds(mesh)
    mesh.T_parent_mesh = np.diag([*[1000 * size / max(float((high - low).max()), 1e-12)] * 3, 1.0])
    mesh = mesh.merge()
    columns = [mesh.V + mesh.offset, mesh.N if len(mesh.N) == len(mesh.V) else vertex_normals(mesh.V, mesh.F)]
    names = ["float x", "float y", "float z", "float nx", "float ny", "float nz"]
    formats = ["%.6f"] * 6
    if len(mesh.C) == len(mesh.V):
        columns.append(np.clip(np.rint(255 * mesh.C[:, :3]), 0, 255))
        names += ["uchar red", "uchar green", "uchar blue"]
        formats += ["%d"] * 3
    text = io.StringIO()
    text.write(f"ply\nformat ascii 1.0\nelement vertex {len(mesh.V)}\n" + "".join(f"property {name}\n" for name in names)
               + f"element face {len(mesh.F)}\nproperty list uchar int vertex_indices\nend_header\n")
    np.savetxt(text, np.concatenate(columns, 1), fmt=formats)
    np.savetxt(text, np.insert(mesh.F, 0, 3, axis=1) if len(mesh.F) else mesh.F, fmt="%d")
    return text.getvalue().encode()


def vertex_normals(V: NDArray[Any], F: NDArray[Any]) -> NDArray[Any]:
    """Sums of the faces' normals, weighted by their angles at the vertex (Thuermer and Wuethrich 1998)."""
    corners = V[F].astype(float)
    normals = np.zeros((len(V), 3))
    for k in range(3):
        a, b = corners[:, (k + 1) % 3] - corners[:, k], corners[:, (k + 2) % 3] - corners[:, k]
        across = np.cross(a, b)
        length = np.linalg.norm(across, axis=1)
        angle = np.arctan2(length, (a * b).sum(1))
        np.add.at(normals, F[:, k], across * (angle / np.maximum(length, 1e-300))[:, None])
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)

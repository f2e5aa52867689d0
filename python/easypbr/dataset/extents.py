"""The extent of meshes."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._easypbr import Mesh


def bounds(mesh: Mesh) -> tuple[NDArray[Any], NDArray[Any]]:
    """Least and largest coordinates of a mesh and its children in its own frame."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    if len(mesh.V):
        low, high = mesh.V.min(0).astype(float), mesh.V.max(0).astype(float)
    for child in mesh.children:
        a, b = bounds(child)
        if not np.isfinite(a).all():
            continue
        corners = np.array([[x, y, z] for x in (a[0], b[0]) for y in (a[1], b[1]) for z in (a[2], b[2])])
        corners = corners @ child.T_parent_mesh[:3, :3].T + child.T_parent_mesh[:3, 3]
        low, high = np.minimum(low, corners.min(0)), np.maximum(high, corners.max(0))
    return low, high


def vertices_of(mesh: Mesh) -> NDArray[Any]:
    """All vertices of a mesh and its children in its own frame."""
    V = [np.asarray(mesh.V, float).reshape(-1, 3)]
    for child in mesh.children:
        V.append(vertices_of(child) @ child.T_parent_mesh[:3, :3].T + child.T_parent_mesh[:3, 3])
    return np.concatenate(V)


def diameter_of(V: NDArray[Any]) -> float:
    """The largest distance between two points. Those far from the middle come first, and the search ends when no pair that is
    left can be farther apart, by the triangle inequality."""
    V = np.unique(V, axis=0)
    V = V - (V.min(0) + V.max(0)) / 2
    radii = np.linalg.norm(V, axis=1)
    order = np.argsort(-radii)
    V, radii = V[order], radii[order]
    most = 0.0
    for i in range(1, len(V)):
        if radii[i] + radii[0] <= most:
            break
        most = max(most, float(np.sqrt(((V[:i] - V[i]) ** 2).sum(1).max())))
    return most

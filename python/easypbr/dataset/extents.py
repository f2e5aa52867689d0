"""The extent of meshes."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._easypbr import Mesh


_SAMPLES = 1024


def without_offset(mesh: Mesh) -> Mesh:
    """The mesh with offsets of zero, its own and those of its children: as a scene places it alone, whose origin is the first
    offset of a node with vertices. Poses of children that lead far from zero, as those of georeferenced GLB files, are brought
    near by the rule that offsets of point files follow; not where the mesh has vertices of its own, which stay."""
    origin = next((np.array(node.offset) for node in _nodes(mesh) if len(node.V)), np.zeros(3))
    _move_offsets(mesh, np.zeros(3), origin)
    if not len(mesh.V):
        far = _offset_of(mesh)
        for child in mesh.children:
            T = child.T_parent_mesh
            T[:3, 3] -= far
            child.T_parent_mesh = T
    return mesh


def _offset_of(mesh: Mesh) -> NDArray[Any]:
    """What the offset of a point file with these vertices would be."""
    samples = Mesh()
    samples.V = np.concatenate([np.empty((0, 3)), *(V[:: -(-len(V) // _SAMPLES)] for V in _vertices_by_node(mesh, np.eye(4)))])
    return np.array(samples.offset)


def _nodes(mesh: Mesh) -> Iterator[Mesh]:
    yield mesh
    for child in mesh.children:
        yield from _nodes(child)


def is_lines(mesh: Mesh) -> bool:
    """Whether a mesh with its children is drawn as nothing but lines."""
    shown = [node for node in _nodes(mesh) if len(node.V)]
    return bool(shown) and all(len(node.E) and not len(node.F) for node in shown)


def _move_offsets(mesh: Mesh, moved: NDArray[Any], origin: NDArray[Any]) -> None:
    """Moves the offsets of all children into their poses; the mesh itself stands `moved` from its own origin."""
    for child in mesh.children:
        own = child.offset - origin if len(child.V) else np.zeros(3)
        T = child.T_parent_mesh
        T[:3, 3] += T[:3, :3] @ own - moved
        child.T_parent_mesh = T
        _move_offsets(child, own, origin)
    mesh.offset = (0, 0, 0)


def bounds(mesh: Mesh) -> tuple[NDArray[Any], NDArray[Any]]:
    """Least and largest coordinates of a mesh and its children in its own frame; infinite without vertices."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for V in _vertices_by_node(mesh, np.eye(4)):
        low, high = np.minimum(low, V.min(0)), np.maximum(high, V.max(0))
    return low, high


def _vertices_by_node(mesh: Mesh, T: NDArray[Any]) -> Iterator[NDArray[Any]]:
    if len(mesh.V):
        yield mesh.V.astype(float) @ T[:3, :3].T + T[:3, 3]
    for child in mesh.children:
        yield from _vertices_by_node(child, T @ child.T_parent_mesh)


def least_along(mesh: Mesh, direction: NDArray[Any]) -> float:
    """The least product of a direction with a vertex of a mesh and its children, in its own frame; infinite without vertices."""
    least = float((mesh.V @ direction).min()) if len(mesh.V) else np.inf
    for child in mesh.children:
        T = child.T_parent_mesh
        least = min(least, least_along(child, T[:3, :3].T @ direction) + float(direction @ T[:3, 3]))
    return least


def vertices_of(mesh: Mesh) -> NDArray[Any]:
    """All vertices of a mesh and its children in its own frame."""
    return np.concatenate([np.empty((0, 3)), *_vertices_by_node(mesh, np.eye(4))])


def fitted(mesh: Mesh, size: float, up: str) -> NDArray[Any]:
    """The 4 x 4 pose that brings a mesh to the origin with an axis of its own ("-y") upwards; the longest side of the box
    around all but the outermost hundredth of its vertices becomes `size`."""
    V = vertices_of(mesh)
    low, high = np.quantile(V, (0.005, 0.995), axis=0)
    axis = np.zeros(3)
    axis["xyz".index(up[-1].lower())] = -1.0 if up.startswith("-") else 1.0
    # The shortest turn, and for what is upside down half a turn about x.
    turn = np.diag([1.0, -1, -1])
    if axis[1] > -0.5:
        across = np.cross(axis, [0.0, 1, 0])
        K = np.array([[0, -across[2], across[1]], [across[2], 0, -across[0]], [-across[1], across[0], 0]])
        turn = np.eye(3) + K + K @ K / (1 + axis[1])
    T = np.eye(4)
    T[:3, :3] = turn * (size / max(float((high - low).max()), 1e-12))
    T[:3, 3] = -T[:3, :3] @ ((low + high) / 2)
    return T


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

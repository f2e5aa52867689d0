"""Numbers, directions and rotations drawn at random, and the extent of meshes."""

import numpy as np

from .._easypbr import Mesh
from .spec import ObjectSpec, Range


def draw(random: np.random.Generator, value: Range) -> float:
    """The number, or one of the uniform distribution."""
    return float(random.uniform(*value)) if isinstance(value, tuple) else float(value)


def direction(random) -> np.ndarray:
    towards = random.normal(size=3)
    return towards / np.linalg.norm(towards)


def turn_about(axis: np.ndarray, angle: float) -> np.ndarray:
    """The rotation about a unit axis (Rodrigues)."""
    x, y, z = axis
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def rotation(entry: ObjectSpec, random) -> np.ndarray:
    quaternion = random.normal(size=4)
    yaw, tilt, towards = random.uniform(0, 2 * np.pi), np.radians(entry.tilt_deg) * random.uniform(-1, 1), random.uniform(0, 2 * np.pi)
    if entry.rotation == "none":
        return np.eye(3)
    if entry.rotation == "any":
        w, x, y, z = quaternion / np.linalg.norm(quaternion)
        return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                         [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                         [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
    c, s = np.cos(yaw), np.sin(yaw)
    upright = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    return turn_about(np.array([np.cos(towards), 0, np.sin(towards)]), tilt) @ upright  # tilted about a level axis


def bounds(mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
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


def vertices_of(mesh: Mesh) -> np.ndarray:
    """All vertices of a mesh and its children in its own frame."""
    V = [np.asarray(mesh.V, float).reshape(-1, 3)]
    for child in mesh.children:
        V.append(vertices_of(child) @ child.T_parent_mesh[:3, :3].T + child.T_parent_mesh[:3, 3])
    return np.concatenate(V)


def diameter_of(V: np.ndarray) -> float:
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

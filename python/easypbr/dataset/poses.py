"""Numbers, directions and rotations drawn at random."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .tables import ObjectSpec, Range


def draw(random: np.random.Generator, value: Range) -> float:
    """The number, or one of the uniform distribution."""
    return float(random.uniform(*value)) if isinstance(value, tuple) else float(value)


def direction(random: np.random.Generator) -> NDArray[Any]:
    towards = random.normal(size=3)
    return towards / np.linalg.norm(towards)


def turn_about(axis: NDArray[Any], angle: float) -> NDArray[Any]:
    """The rotation about a unit axis (Rodrigues)."""
    x, y, z = axis
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def rotation(entry: ObjectSpec, random: np.random.Generator) -> NDArray[Any]:
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

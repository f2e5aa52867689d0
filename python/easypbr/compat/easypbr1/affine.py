"""Affine3d and Affine3f: poses that say so when they are changed."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...errors import ArgumentError


def rotation(axis: ArrayLike, angle_deg: float) -> NDArray[Any]:
    """3 x 3 rotation, counter-clockwise seen against the axis (Rodrigues' formula)."""
    a = np.asarray(axis, dtype=np.float64).ravel()
    length = np.linalg.norm(a)
    if a.shape != (3,) or length == 0:
        raise ArgumentError(f"axis: expected three numbers that are not all zero, got {axis!r}")
    x, y, z = a / length
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(angle_deg)
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def from_quaternion(q: ArrayLike) -> NDArray[Any]:
    """3 x 3 rotation of a quaternion x, y, z, w."""
    v = np.asarray(q, dtype=np.float64).ravel()
    length = np.linalg.norm(v)
    if v.shape != (4,) or not np.isfinite(length) or length == 0:
        raise ArgumentError(f"quaternion: expected x, y, z, w, got {q!r}")
    x, y, z, w = v / length
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])  # fmt: skip


def to_quaternion(R: NDArray[Any]) -> NDArray[Any]:
    """x, y, z, w of a rotation, w from 0 on: the eigenvector of the largest eigenvalue (Bar-Itzhack 2000)."""
    K = np.array([[R[0, 0] - R[1, 1] - R[2, 2], 0, 0, 0], [R[0, 1] + R[1, 0], R[1, 1] - R[0, 0] - R[2, 2], 0, 0],
                  [R[0, 2] + R[2, 0], R[1, 2] + R[2, 1], R[2, 2] - R[0, 0] - R[1, 1], 0],
                  [R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1], R.trace()]]) / 3  # fmt: skip
    vector = np.linalg.eigh(K)[1][:, -1]
    return vector if vector[3] >= 0 else -vector


class Affine3d:
    """A 4 x 4 matrix with the first EasyPBR's methods, which change it in place and return a copy of the result."""

    def __init__(self, matrix: ArrayLike | None = None, changed: Callable[[], None] | None = None) -> None:
        self._m = np.eye(4) if matrix is None else np.array(matrix, dtype=np.float64).reshape(4, 4)
        self._changed = changed or (lambda: None)

    def matrix(self) -> NDArray[Any]:
        return self._m.copy()

    def translation(self) -> NDArray[Any]:
        return self._m[:3, 3].copy()

    def linear(self) -> NDArray[Any]:
        return self._m[:3, :3].copy()

    def quat(self) -> NDArray[Any]:
        """x, y, z, w."""
        return to_quaternion(self._m[:3, :3])

    def inverse(self) -> "Affine3d":
        return Affine3d(np.linalg.inv(self._m))

    def from_matrix(self, matrix: ArrayLike) -> "Affine3d":
        self._m[:] = np.asarray(matrix, dtype=np.float64).reshape(4, 4)
        self._changed()
        return self.clone()

    def set_identity(self) -> "Affine3d":
        return self.from_matrix(np.eye(4))

    def set_translation(self, translation: ArrayLike) -> "Affine3d":
        self._m[:3, 3] = translation
        self._changed()
        return self.clone()

    def set_linear(self, linear: ArrayLike) -> "Affine3d":
        self._m[:3, :3] = linear
        self._changed()
        return self.clone()

    def set_quat(self, quaternion: ArrayLike) -> "Affine3d":
        """x, y, z, w."""
        return self.set_linear(from_quaternion(quaternion))

    def translate(self, step: ArrayLike) -> "Affine3d":
        return self.set_translation(self._m[:3, 3] + np.asarray(step, dtype=np.float64))

    def rotate_axis_angle(self, axis: ArrayLike, angle_deg: float) -> "Affine3d":
        """About an axis of the world, in place."""
        return self.set_linear(rotation(axis, angle_deg) @ self._m[:3, :3])

    def rotate_axis_angle_local(self, axis: ArrayLike, angle_deg: float) -> "Affine3d":
        return self.set_linear(self._m[:3, :3] @ rotation(axis, angle_deg))

    def orbit_y_around_point(self, point: ArrayLike, angle_deg: float) -> "Affine3d":
        """Around the vertical line through a point of the world."""
        R, center = rotation((0, 1, 0), angle_deg), np.asarray(point, dtype=np.float64)
        self._m[:3, :3] = R @ self._m[:3, :3]
        return self.set_translation(R @ (self._m[:3, 3] - center) + center)

    def flip_x(self) -> "Affine3d":
        return self._flip(0)

    def flip_y(self) -> "Affine3d":
        return self._flip(1)

    def flip_z(self) -> "Affine3d":
        return self._flip(2)

    def _flip(self, axis: int) -> "Affine3d":
        self._m[:3, axis] *= -1
        self._changed()
        return self.clone()

    def to_float(self) -> "Affine3d":
        return self.clone()

    def to_double(self) -> "Affine3d":
        return self.clone()

    def clone(self) -> "Affine3d":
        return Affine3d(self._m)

    def __mul__(self, other: "Affine3d") -> "Affine3d":
        return Affine3d(self._m @ other._m)

    def __array__(self, dtype: object = None, copy: object = None) -> NDArray[Any]:
        return self._m.astype(dtype) if dtype else self._m.copy()  # type: ignore[call-overload]

    def __repr__(self) -> str:
        return f"Affine3d({self._m.tolist()})"


def pose_from_string(text: str) -> NDArray[Any]:
    """4 x 4 of "x y z qx qy qz qw"."""
    numbers = numbers_of(text, 7, "pose")
    T = np.eye(4)
    T[:3, 3], T[:3, :3] = numbers[:3], from_quaternion(numbers[3:7])
    return T


def numbers_of(text: str, count: int, what: str) -> Sequence[float]:
    try:
        numbers = [float(word) for word in text.split()]
    except ValueError:
        numbers = []
    if len(numbers) != count:
        raise ArgumentError(f"{what}: expected {count} numbers, got '{text}'")
    return numbers

"""Nodes: what stands where."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...errors import ArgumentError
from .camera import Camera
from .changes import Children, Noted, note
from .light import Light
from .mesh import Mesh


def _rotation_matrix(quaternion: NDArray[Any]) -> NDArray[Any]:
    """3 x 3 of (x, y, z, w), of length 1."""
    x, y, z, w = quaternion
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip


def _quaternion(R: NDArray[Any]) -> NDArray[Any]:
    """(x, y, z, w) of a rotation: the eigenvector of the largest eigenvalue of Bar-Itzhack's matrix."""
    K = np.array([
        [R[0, 0] - R[1, 1] - R[2, 2], R[0, 1] + R[1, 0], R[0, 2] + R[2, 0], R[2, 1] - R[1, 2]],
        [R[0, 1] + R[1, 0], R[1, 1] - R[0, 0] - R[2, 2], R[1, 2] + R[2, 1], R[0, 2] - R[2, 0]],
        [R[0, 2] + R[2, 0], R[1, 2] + R[2, 1], R[2, 2] - R[0, 0] - R[1, 1], R[1, 0] - R[0, 1]],
        [R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1], R[0, 0] + R[1, 1] + R[2, 2]],
    ])  # fmt: skip
    values, vectors = np.linalg.eigh(K / 3)
    found = vectors[:, np.argmax(values)]
    return np.asarray(found if found[3] >= 0 else -found)


class Node(Noted):
    """A pose with a mesh, a camera or a light, and children. The pose is a matrix, or translation, rotation (x, y, z, w) and
    scale."""

    name: str | None
    camera: Camera | None
    mesh: Mesh | None
    light: Light | None
    skin: Any
    weights: ArrayLike | None

    def __init__(
        self,
        name: str | None = None,
        camera: Camera | None = None,
        children: "list[Node] | None" = None,
        skin: Any = None,
        matrix: ArrayLike | None = None,
        mesh: Mesh | None = None,
        rotation: ArrayLike | None = None,
        scale: ArrayLike | None = None,
        translation: ArrayLike | None = None,
        weights: ArrayLike | None = None,
        light: Light | None = None,
    ) -> None:
        self.name, self.camera, self.mesh, self.light, self.skin, self.weights = name, camera, mesh, light, skin, weights
        self._children: list[Node] = Children(children or ())
        self._translation, self._rotation, self._scale = np.zeros(3), np.array([0.0, 0, 0, 1]), np.ones(3)
        self._matrix: NDArray[Any] | None = np.eye(4)
        if matrix is not None:
            self.matrix = np.asarray(matrix)
        else:
            for attribute, value in (("translation", translation), ("rotation", rotation), ("scale", scale)):
                if value is not None:
                    setattr(self, attribute, value)

    @property
    def children(self) -> "list[Node]":
        """The list may be changed, too: the node's scene follows."""
        return self._children

    @children.setter
    def children(self, nodes: "list[Node]") -> None:
        self._children = Children(nodes)
        note(is_tree=True)

    @property
    def matrix(self) -> NDArray[Any]:
        """4 x 4, to the parent's frame: a copy, assign one to change it."""
        if self._matrix is None:
            T = np.eye(4)
            T[:3, :3] = _rotation_matrix(self._rotation) * self._scale
            T[:3, 3] = self._translation
            self._matrix = T
        return self._matrix.copy()

    @matrix.setter
    def matrix(self, value: ArrayLike) -> None:
        T = np.asarray(value, dtype=np.float64)
        if T.shape != (4, 4) or not np.isfinite(T).all() or not np.allclose(T[3], (0, 0, 0, 1)):
            expected = "expected 4 x 4 finite numbers with a last row of (0, 0, 0, 1)"
            raise ArgumentError(f"a Node's matrix: {expected}, got {T.tolist()}")
        self._matrix = T.copy()
        self._translation = T[:3, 3].copy()
        self._scale = np.linalg.norm(T[:3, :3], axis=0)
        self._rotation = _quaternion(T[:3, :3] / np.where(self._scale > 0, self._scale, 1))

    @property
    def translation(self) -> NDArray[Any]:
        return self._translation

    @translation.setter
    def translation(self, value: ArrayLike) -> None:
        self._translation, self._matrix = np.array(value, dtype=np.float64).reshape(3), None

    @property
    def rotation(self) -> NDArray[Any]:
        """A quaternion, (x, y, z, w)."""
        return self._rotation

    @rotation.setter
    def rotation(self, value: ArrayLike) -> None:
        quaternion = np.array(value, dtype=np.float64).reshape(4)
        length = np.linalg.norm(quaternion)
        if abs(length - 1) > 1e-3:
            raise ArgumentError(f"a Node's rotation: expected a quaternion of length 1, got length {length:g}")
        self._rotation, self._matrix = quaternion / length, None

    @property
    def scale(self) -> NDArray[Any]:
        return self._scale

    @scale.setter
    def scale(self, value: ArrayLike) -> None:
        self._scale, self._matrix = np.full(3, value) if np.ndim(value) == 0 else np.array(value, dtype=np.float64), None

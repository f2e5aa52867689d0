"""Cameras: they look along -z of their node, as OpenGL's."""

from abc import ABC, abstractmethod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import ArgumentError
from .changes import Noted
from .constants import DEFAULT_Z_FAR, DEFAULT_Z_NEAR


class Camera(Noted, ABC):
    """What all cameras have: a name and the depths that they see, in metres. A class of your own says by
    get_projection_matrix() what is drawn: an orthographic or a perspective view; its depths are what pyrender computes
    of znear and zfar."""

    znear: float
    zfar: float | None

    def __init__(self, znear: float = DEFAULT_Z_NEAR, zfar: float | None = DEFAULT_Z_FAR, name: str | None = None) -> None:
        self.name = name
        self.znear = float(znear)
        self.zfar = None if zfar is None else float(zfar)

    @abstractmethod
    def get_projection_matrix(self, width: int | None = None, height: int | None = None) -> NDArray[Any]:
        """OpenGL's 4 x 4 projection matrix for an image of this size: the camera is drawn by it."""

    def _depth_rows(self, P: NDArray[Any]) -> NDArray[Any]:
        """Completes the matrix of a perspective camera."""
        near, far = self.znear, self.zfar
        P[3][2] = -1.0
        P[2][2] = -1.0 if far is None else (far + near) / (near - far)
        P[2][3] = -2.0 * near if far is None else 2 * far * near / (near - far)
        return P


class PerspectiveCamera(Camera):
    """`yfov`: vertical field of view in radians; `aspectRatio`: width / height, by default that of the image."""

    yfov: float

    def __init__(
        self,
        yfov: float,
        znear: float = DEFAULT_Z_NEAR,
        zfar: float | None = None,
        aspectRatio: float | None = None,
        name: str | None = None,
    ) -> None:
        super().__init__(znear, zfar, name)
        self.yfov = float(yfov)
        self.aspectRatio = aspectRatio

    def _aspect(self, width: int | None, height: int | None) -> float:
        if self.aspectRatio is not None:
            return float(self.aspectRatio)
        if width is None or height is None:
            raise ArgumentError("a PerspectiveCamera without an aspectRatio: expected width and height")
        return width / height

    def get_projection_matrix(self, width: int | None = None, height: int | None = None) -> NDArray[Any]:
        P = np.zeros((4, 4))
        P[1][1] = 1 / np.tan(self.yfov / 2)
        P[0][0] = P[1][1] / self._aspect(width, height)
        return self._depth_rows(P)


class OrthographicCamera(Camera):
    """`ymag`: half of the view volume's height in metres; its width follows from the image."""

    xmag: float
    ymag: float

    def __init__(
        self,
        xmag: float,
        ymag: float,
        znear: float = DEFAULT_Z_NEAR,
        zfar: float = DEFAULT_Z_FAR,
        name: str | None = None,
    ) -> None:
        super().__init__(znear, zfar, name)
        self.xmag, self.ymag = float(xmag), float(ymag)

    def get_projection_matrix(self, width: int | None = None, height: int | None = None) -> NDArray[Any]:
        xmag = self.xmag if width is None or height is None else width / height * self.ymag
        near, far = self.znear, DEFAULT_Z_FAR if self.zfar is None else self.zfar
        P = np.zeros((4, 4))
        P[0][0], P[1][1] = 1 / xmag, 1 / self.ymag
        P[2][2] = 2.0 / (near - far)
        P[2][3] = (far + near) / (near - far)
        P[3][3] = 1.0
        return P


class IntrinsicsCamera(Camera):
    """A pinhole in pixels: the principal point counts from the corner of the upper left pixel."""

    fx: float
    fy: float
    cx: float
    cy: float

    def __init__(
        self,
        fx: float,
        fy: float,
        cx: float,
        cy: float,
        znear: float = DEFAULT_Z_NEAR,
        zfar: float | None = DEFAULT_Z_FAR,
        name: str | None = None,
    ) -> None:
        super().__init__(znear, zfar, name)
        self.fx, self.fy, self.cx, self.cy = float(fx), float(fy), float(cx), float(cy)

    def get_projection_matrix(self, width: int | None = None, height: int | None = None) -> NDArray[Any]:
        if width is None or height is None:
            raise ArgumentError("an IntrinsicsCamera: expected width and height")
        P = np.zeros((4, 4))
        P[0][0], P[1][1] = 2 * self.fx / width, 2 * self.fy / height
        P[0][2] = 1 - 2 * self.cx / width
        P[1][2] = 2 * self.cy / height - 1
        return self._depth_rows(P)

"""What a projection matrix draws: EasyPBR's camera for it, and pyrender's depths."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ... import _easypbr
from ...errors import ArgumentError
from .camera import Camera, OrthographicCamera

#: Largest shear of a pose that counts as rounding: that of a rotation of two decimals.
_SHEAR = 0.01
#: Pixels by which columns and rows may differ at an edge of the image and count as squares.
_SQUARE = 0.1
#: Most times that pixels may be as long as they are wide, or as wide as long: the image that is drawn is as much larger.
_MOST_STRETCH = 16


@dataclass(frozen=True, eq=False)
class Projection:
    """A camera with its pose, for an image of a size. Depths are metres along the optical axis."""

    #: What EasyPBR draws with, and the size of its image: `size`, or larger where pixels are not square.
    own: "_easypbr.Camera"
    drawn: tuple[int, int]
    size: tuple[int, int]
    #: 4 x 4: from the frame of `pose`, which is rigid, to clip coordinates.
    matrix: NDArray[Any]
    pose: NDArray[Any]
    is_parallel: bool
    near: float
    far: float | None
    #: How far behind `pose` EasyPBR's camera is.
    back: float
    #: Rows and columns of the drawn image that are shown, None: all.
    rows: NDArray[Any] | None
    columns: NDArray[Any] | None
    #: What depths are divided by; None: they follow from znear and zfar.
    unit: float | None
    planes: tuple[float, float | None]

    def picked(self, image: NDArray[Any]) -> NDArray[Any]:
        """Height x width (x channels) of an image that was drawn."""
        image = image if self.rows is None else image[self.rows]
        return image if self.columns is None else image[:, self.columns]

    def depths(self, depth: NDArray[Any]) -> NDArray[Any]:
        """pyrender's depths of those that EasyPBR draws, float32, 0 where there is nothing."""
        if self.unit == 1 and self.back == 0:
            return depth
        metres = depth.astype(np.float64) - self.back
        if self.unit is not None:
            found = metres / self.unit
        else:
            near, far = self.planes
            z = self.matrix[2, 3] - self.matrix[2, 2] * metres
            with np.errstate(divide="ignore", invalid="ignore"):
                z = z if self.is_parallel else z / metres
                found = 2 * near / (1 - z) if far is None else 2 * near * far / (far + near - z * (far - near))
        return np.where(depth > 0, found, 0).astype(np.float32)


def projection_of(camera: Camera, pose: NDArray[Any], width: int, height: int) -> Projection:
    """Raises ArgumentError for a matrix that is neither perspective nor orthographic, and for a pose that is
    singular, mirrored or sheared."""
    pose, scale = _rigid(pose)
    who = f"{type(camera).__name__}.get_projection_matrix()"
    P = _checked(camera.get_projection_matrix(width=width, height=height), who) / np.append(scale, 1)
    is_parallel = P[3, 3] != 0
    P = P / (P[3, 3] if is_parallel else -P[3, 2])
    if P[0, 0] < 0 and P[1, 1] < 0:  # Half a turn about the optical axis.
        turn = np.diag([-1.0, -1, 1, 1])
        P, pose = P @ turn, pose @ turn
    if not (P[0, 0] > 0 and P[1, 1] > 0):
        signs = f"got {P[0, 0]:g} and {P[1, 1]:g}: a mirrored image"
        raise ArgumentError(f"{who}: expected P[0, 0] and P[1, 1] of the same sign, {signs}")
    near, far = _planes(P, is_parallel, who)
    back = max(far - 2 * near, 0.0) if is_parallel and far is not None and near <= 0 else 0.0
    place = pose.copy()
    place[:3, 3] += pose[:3, :3] @ (-P[0, 3] / P[0, 0], -P[1, 3] / P[1, 1], back)
    size = drawn = (width, height)
    rows = columns = None
    if is_parallel:
        own = _easypbr.Camera.from_opengl(place)
        own.projection = "orthographic"
        own.ortho_height, drawn, rows, columns = _squares(P, width, height, who)
    elif P[0, 2] == P[1, 2] == 0 and abs(P[0, 0] * width / (P[1, 1] * height) - 1) <= 1e-9:
        # Without intrinsics in pixels, which a window of another shape would stretch.
        own = _easypbr.Camera.from_opengl(place, float(np.degrees(2 * np.arctan(1 / P[1, 1]))))
    else:
        K = np.array([[P[0, 0] * width / 2, 0, (1 - P[0, 2]) * width / 2 - 0.5],
                      [0, P[1, 1] * height / 2, (1 + P[1, 2]) * height / 2 - 0.5], [0, 0, 1]])  # fmt: skip
        own = _easypbr.Camera.from_opencv(K, place, size, axes="opengl")
    own.near = near + back
    # pyrender turns depths into metres by znear and zfar; they are metres already where the matrix has these planes.
    depth_scale = float(scale[2])
    is_plain = isinstance(camera, OrthographicCamera) or not is_parallel and _is_same((near, far), camera, depth_scale)
    return Projection(own, drawn, size, P, pose, is_parallel, near, far, back, rows, columns,
                      depth_scale if is_plain else None, (camera.znear, camera.zfar))  # fmt: skip


def _rigid(pose: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """The nearest pose without scale and shear, and the scale of each axis."""
    M = np.asarray(pose, dtype=np.float64)[:3, :3]
    U, stretch, V = np.linalg.svd(M)
    if stretch[2] <= 1e-9 * stretch[0]:
        raise ArgumentError(f"a camera's pose: expected an invertible matrix, got {np.asarray(pose).tolist()}")
    R = U @ V
    if np.linalg.det(R) < 0:
        raise ArgumentError(f"a camera's pose: expected a rotation with a scale, got a reflection: {np.asarray(pose).tolist()}")
    stretched = R.T @ M
    scale = np.diag(stretched).copy()
    if np.abs(stretched - np.diag(scale)).max() > _SHEAR * stretch[0]:
        raise ArgumentError(f"a camera's pose: expected axes at right angles, got {np.asarray(pose).tolist()}")
    scale[np.abs(scale - 1) < 1e-5] = 1  # Rounding of float32.
    rigid = np.eye(4)
    rigid[:3, :3], rigid[:3, 3] = R, np.asarray(pose)[:3, 3]
    return rigid, scale


def _checked(given: Any, who: str) -> NDArray[Any]:
    """The matrix, if it is one that can be drawn."""
    P = np.asarray(given, dtype=np.float64)
    if P.shape != (4, 4) or not np.isfinite(P).all():
        raise ArgumentError(f"{who}: expected 4 x 4 finite numbers, got {P.tolist()}")
    # Where a number may differ from 0: the scales of x and y, the principal point, a shift, the depths.
    allowed = np.array([[1, 0, 1, 1], [0, 1, 1, 1], [0, 0, 1, 1], [0, 0, P[3, 2] < 0, P[3, 3] > 0]], bool)
    if allowed[3].sum() == 1 and allowed[3, 3]:
        allowed[:2, 2] = False  # Oblique lines of sight.
    if allowed[3].sum() != 1 or (np.abs(P[~allowed]) > 1e-9 * np.abs(P).max()).any():
        raise ArgumentError(
            f"{who}: expected a last row of (0, 0, -1, 0) for a perspective camera, P[:2] of [[a, 0, b, c], [0, d, e, f]], "
            f"or of (0, 0, 0, 1) for an orthographic one, P[:2] of [[a, 0, 0, b], [0, c, 0, d]], "
            f"and P[2] of (0, 0, a, b); got {P.tolist()}"
        )
    return np.where(allowed, P, 0)


def _planes(P: NDArray[Any], is_parallel: bool, who: str) -> tuple[float, float | None]:
    """Depths of the near and the far plane, where z is -1 and 1; None: no far plane."""
    e, f = P[2, 2], P[2, 3]
    if is_parallel:
        if not e < 0:
            raise ArgumentError(f"{who}: expected P[2, 2] below 0 (what is nearer hides what is farther), got {e:g}")
        return float((f + 1) / e), float((f - 1) / e)
    if not (e < 1 and f <= 0):
        expected = "expected P[2, 2] below 1 and P[2, 3] of at most 0 (a near plane before the camera)"
        raise ArgumentError(f"{who}: {expected}, got {e:g} and {f:g}")
    return float(f / (e - 1)), float(f / (e + 1)) if e < -1 - 1e-12 else None


def _squares(P: NDArray[Any], width: int, height: int, who: str) -> tuple[float, tuple[int, int], Any, Any]:
    """Height of the view volume, the size of an image with square pixels, and which of its rows and columns are shown."""
    columns, rows = width * P[0, 0], height * P[1, 1]  # Twice as many as are a metre.
    if not 1 / _MOST_STRETCH <= columns / rows <= _MOST_STRETCH:
        expected = f"expected pixels at most {_MOST_STRETCH} times as long as wide, or as wide as long"
        sizes = f"got {2 / columns:g} x {2 / rows:g} m in an image of {width} x {height}"
        raise ArgumentError(f"{who}: {expected}; {sizes}, of P[0, 0] = {P[0, 0]:g} and P[1, 1] = {P[1, 1]:g}")
    if abs(columns / rows - 1) * max(width, height) / 2 < _SQUARE:
        return 2 / P[1, 1], (width, height), None, None
    if columns > rows:
        count = max(round(height * columns / rows), 1)
        return 2 * count / columns, (width, count), _nearest(height, count, columns / rows), None
    count = max(round(width * rows / columns), 1)
    return 2 / P[1, 1], (count, height), None, _nearest(width, count, rows / columns)


def _nearest(shown: int, drawn: int, ratio: float) -> NDArray[Any]:
    """Which of `drawn` pixels hold the centres of `shown` ones, each as long as `ratio` of them; the middles agree."""
    centres = (np.arange(shown) + 0.5 - shown / 2) * ratio + drawn / 2
    return np.clip(np.floor(centres), 0, drawn - 1).astype(int)


def _is_same(planes: tuple[float, float | None], camera: Camera, scale: float) -> bool:
    """Whether a camera's znear and zfar are these planes, but for rounding."""
    given = (camera.znear * scale, None if camera.zfar is None else camera.zfar * scale)
    if (given[1] is None) != (planes[1] is None):
        return False
    pairs = zip(given, planes)
    return all(a is None or b is None or abs(a - b) <= 1e-6 * max(abs(a), abs(b)) for a, b in pairs)

"""Camera and SpotLight."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ... import _easypbr, shapes
from ...errors import ArgumentError
from .affine import Affine3d, from_quaternion, numbers_of, rotation, to_quaternion
from .mesh import Mesh


def _vector(values: ArrayLike) -> NDArray[Any]:
    found = np.asarray(values, dtype=np.float64).ravel()
    if found.shape != (3,):
        raise ArgumentError(f"expected three numbers, got {values!r}")
    return found


class Camera:
    """A pose that looks at a point `dist_to_lookat()` ahead. m_fov is horizontal, in degrees, and the vertical one is m_fov divided by the
    aspect ratio, as the first EasyPBR had it, so that its saved viewpoints look the same."""

    m_near: float
    m_far: float

    def __init__(self) -> None:
        self._T = np.eye(4)
        self._T[:3, 3] = 0, 0.5, 5
        self._distance = 5.0
        self._is_changed = False
        self._fov, self._is_fov_changed = 30.0, False
        self.m_near, self.m_far = 0.01, 5000.0
        self.m_exposure: float | None = None
        self.m_use_fixed_proj_matrix = False
        self._K: NDArray[Any] | None = None
        self._K_size = (1, 1)

    # What it is.

    @property
    def m_fov(self) -> float:
        return self._fov

    @m_fov.setter
    def m_fov(self, degrees: float) -> None:
        self._fov, self._is_fov_changed = float(degrees), True

    @property
    def m_model_matrix(self) -> Affine3d:
        def changed() -> None:
            self._move(pose.matrix())

        pose = Affine3d(self._T, changed)
        return pose

    def model_matrix(self) -> NDArray[Any]:
        return self._T.copy()

    def model_matrix_affine(self) -> Affine3d:
        return Affine3d(self._T)

    def view_matrix(self) -> NDArray[Any]:
        return np.linalg.inv(self._T)

    def view_matrix_affine(self) -> Affine3d:
        return Affine3d(self.view_matrix())

    def position(self) -> NDArray[Any]:
        return self._T[:3, 3].copy()

    def direction(self) -> NDArray[Any]:
        return -self._T[:3, 2]

    def up(self) -> NDArray[Any]:
        return self._T[:3, 1].copy()

    def cam_axes(self) -> NDArray[Any]:
        return self._T[:3, :3].copy()

    def lookat(self) -> NDArray[Any]:
        return self.position() + self._distance * self.direction()

    def dist_to_lookat(self) -> float:
        return self._distance

    def intrinsics(self, width: float, height: float) -> NDArray[Any]:
        """3 x 3, OpenCV's."""
        return self.camera(width / height).opencv_K((int(width), int(height)))

    # Changes.

    def _move(self, T: NDArray[Any]) -> None:
        self._T = np.array(T, dtype=np.float64)
        self._is_changed = True

    def _look(self, position: NDArray[Any], target: NDArray[Any]) -> None:
        if np.allclose(position, target):
            raise ArgumentError("a camera cannot look at the point where it is")
        up = (0.0, 1.0, 0.0) if abs((target - position)[[0, 2]]).max() > 1e-9 * abs(target - position).max() else (0.0, 0.0, -1.0)
        self._distance = float(np.linalg.norm(target - position))
        self._move(_easypbr.Camera.look_at(position, target, up).T_world_cam)

    def set_model_matrix(self, T: Any) -> None:
        self._move(np.asarray(T, dtype=np.float64).reshape(4, 4))

    def set_position(self, position: ArrayLike) -> None:
        """Keeps looking at the same point."""
        self._look(_vector(position), self.lookat())

    def set_lookat(self, target: ArrayLike) -> None:
        self._look(self.position(), _vector(target))

    def set_quat(self, quaternion: ArrayLike) -> None:
        """x, y, z, w."""
        T = self._T.copy()
        T[:3, :3] = from_quaternion(quaternion)
        self._move(T)

    def set_dist_to_lookat(self, distance: float) -> None:
        """Moves the point that is looked at."""
        self._distance = float(distance)

    def push_away(self, factor: float) -> None:
        """Multiplies the distance to the point that is looked at."""
        self.push_away_by_dist(self._distance * factor - self._distance)

    def push_away_by_dist(self, step: float) -> None:
        target = self.lookat()
        self._look(target - (self._distance + step) * self.direction(), target)

    def _orbit(self, axis: ArrayLike, angle_deg: float) -> None:
        R, target, T = rotation(axis, angle_deg), self.lookat(), self._T.copy()
        T[:3, :3] = R @ T[:3, :3]
        T[:3, 3] = R @ (T[:3, 3] - target) + target
        self._move(T)

    def orbit_x(self, angle_deg: float) -> None:
        self._orbit(self._T[:3, 0], angle_deg)

    def orbit_y(self, angle_deg: float) -> None:
        self._orbit((0, 1, 0), angle_deg)

    def orbit_z(self, angle_deg: float) -> None:
        self._orbit(self._T[:3, 2], angle_deg)

    def orbit_axis_angle(self, axis: ArrayLike, angle_deg: float) -> None:
        self._orbit(axis, angle_deg)

    def rotate(self, quaternion: ArrayLike) -> None:
        T = self._T.copy()
        T[:3, :3] = from_quaternion(quaternion) @ T[:3, :3]
        self._move(T)

    def rotate_axis_angle(self, axis: ArrayLike, angle_deg: float) -> None:
        T = self._T.copy()
        T[:3, :3] = rotation(axis, angle_deg) @ T[:3, :3]
        self._move(T)

    def flip_around_x(self) -> None:
        self.rotate_axis_angle(self._T[:3, 0], 180)

    def transform_model_matrix(self, T: Any) -> None:
        self._move(np.asarray(T, dtype=np.float64).reshape(4, 4) @ self._T)

    def from_frame(self, frame: Any) -> None:
        """Of a posed image: pose and lens."""
        if frame.K is None or frame.tf_cam_world is None:
            raise ArgumentError("from_frame: the frame has no K or no tf_cam_world")
        self._K, self._K_size = np.array(frame.K, dtype=np.float64), (int(frame.width), int(frame.height))
        self._move(np.linalg.inv(np.asarray(frame.tf_cam_world)) @ np.diag([1.0, -1, -1, 1]))

    def from_string(self, text: str) -> None:
        """tx ty tz qx qy qz qw lookx looky lookz fov near far, as Ctrl+C in the first EasyPBR's window wrote it."""
        numbers = numbers_of(text, 13, "camera")
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = from_quaternion(numbers[3:7]), numbers[:3]
        self._distance = float(np.linalg.norm(np.array(numbers[7:10]) - T[:3, 3])) or 1.0
        self.m_fov, self.m_near, self.m_far = numbers[10:]
        self._move(T)

    def to_string(self) -> str:
        numbers = [*self.position(), *to_quaternion(self._T[:3, :3]), *self.lookat(), self.m_fov, self.m_near, self.m_far]
        return " ".join(f"{number:.9g}" for number in numbers)

    def clone(self) -> "Camera":
        other = Camera()
        other.__dict__.update({key: value.copy() if isinstance(value, np.ndarray) else value for key, value in self.__dict__.items()})
        return other

    def create_frustum_mesh(self, scale: float = 1.0, viewport: ArrayLike = (1920, 1080)) -> Mesh:
        width, height = (int(side) for side in np.asarray(viewport).ravel())
        return Mesh._of(shapes.camera_frustum(self.camera(width / height), size=(width, height), depth=scale))

    def camera(self, aspect: float) -> "_easypbr.Camera":
        """EasyPBR's camera for an image of this aspect ratio."""
        if self._K is not None:
            return _easypbr.Camera.from_opencv(self._K, self._T, self._K_size, axes="opengl")
        return _easypbr.Camera.from_opengl(self._T, fov_y_deg=self.m_fov / aspect)


class SpotLight(Camera):
    """A light: it lights all around, as the first EasyPBR's did. `light` is what EasyPBR has of it."""

    def __init__(self, light: Any) -> None:
        super().__init__()
        self._light = light
        self._place()

    def _place(self) -> None:
        position, target = np.asarray(self._light.position, dtype=np.float64), np.zeros(3)
        if np.linalg.norm(position) > 0:
            self._look(position, target)

    def _move(self, T: NDArray[Any]) -> None:
        before = self._T[:3, 3].copy()
        super()._move(T)
        if hasattr(self, "_light") and not np.allclose(before, self._T[:3, 3]):
            self._light.position = tuple(self._T[:3, 3])

    @property
    def m_power(self) -> float:
        """Radiant intensity; irradiance at a distance d is power / d^2."""
        return float(self._light.intensity)

    @m_power.setter
    def m_power(self, power: float) -> None:
        self._light.intensity = float(power)

    @property
    def m_color(self) -> NDArray[Any]:
        return np.asarray(self._light.color)

    @m_color.setter
    def m_color(self, color: ArrayLike) -> None:
        self._light.color = tuple(float(c) for c in _vector(color))

    def set_power_for_point(self, point: ArrayLike, power: float) -> None:
        """So that the irradiance at the point is `power`."""
        self.m_power = power * float(np.sum((self.position() - _vector(point)) ** 2))

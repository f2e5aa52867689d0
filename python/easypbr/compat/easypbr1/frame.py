"""Frame: a posed image."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ... import _easypbr, shapes
from ...errors import ArgumentError
from .camera import Camera
from .mat import Mat
from .mesh import Mesh


class Frame:
    """A posed image: OpenCV's K, and tf_cam_world, the world in the camera's frame with OpenCV's axes."""

    rgb_32f: Mat
    rgb_8u: Mat
    gray_32f: Mat
    depth: Mat
    mask: Mat
    width: int
    height: int

    def __init__(self) -> None:
        self.rgb_32f = self.rgb_8u = self.gray_32f = self.depth = self.mask = Mat()
        self.K: NDArray[Any] | None = None
        self.tf_cam_world: Any = None
        self.width = self.height = 0
        self.cam_id = self.frame_idx = -1
        self.name = ""

    def from_camera(self, camera: Camera, width: int, height: int, flip_z: bool = True, flip_y: bool = True) -> None:
        self.width, self.height = int(width), int(height)
        self.K = camera.intrinsics(width, height)
        axes = np.diag([1.0, -1 if flip_y else 1, -1 if flip_z else 1, 1])
        self.tf_cam_world = np.linalg.inv(camera.model_matrix() @ axes)

    def pos_in_world(self) -> NDArray[Any]:
        return np.linalg.inv(np.asarray(self.tf_cam_world))[:3, 3]

    def look_dir(self) -> NDArray[Any]:
        return np.linalg.inv(np.asarray(self.tf_cam_world))[:3, 2]

    def project(self, point: ArrayLike) -> NDArray[Any]:
        """Pixel of a point of the world."""
        p = self._lens() @ (np.asarray(self.tf_cam_world) @ np.append(np.asarray(point, dtype=np.float64), 1))[:3]
        return p[:2] / p[2]

    def unproject(self, x: float, y: float, depth: float) -> NDArray[Any]:
        p = np.linalg.solve(self._lens(), [x, y, 1.0]) * depth
        return (np.linalg.inv(np.asarray(self.tf_cam_world)) @ np.append(p, 1))[:3]

    def subsample(self, factor: float, subsample_imgs: bool = True) -> "Frame":
        """Smaller by a factor."""
        other = Frame()
        other.__dict__.update(self.__dict__)
        step = int(factor)
        # Pixel centres lie at integers: the new centre 0 is the mean of `factor` old ones.
        other.K = np.diag([1 / factor, 1 / factor, 1]) @ (self._lens() + np.array([[0, 0, 0.5], [0, 0, 0.5], [0, 0, 0]]))
        other.K -= np.array([[0, 0, 0.5], [0, 0, 0.5], [0, 0, 0]])
        other.width, other.height = int(self.width / factor), int(self.height / factor)
        if subsample_imgs and step > 1:
            for name in ("rgb_32f", "rgb_8u", "gray_32f", "depth", "mask"):
                setattr(other, name, Mat(getattr(self, name).data[::step, ::step]))
        return other

    def create_frustum_mesh(self, scale_multiplier: float = 1.0, show_texture: bool = True, texture_max_size: int = 256) -> Mesh:
        image = next((mat for mat in (self.rgb_8u, self.rgb_32f) if not mat.empty()), None) if show_texture else None
        pixels = None
        if image is not None:
            step = max(1, -(-max(image.rows, image.cols) // texture_max_size))
            pixels = np.ascontiguousarray(image.rgb2bgr().data[::step, ::step])
        pose = np.linalg.inv(np.asarray(self.tf_cam_world))
        made = shapes.camera_frustum(_easypbr.Camera.from_opencv(self._lens(), pose, (self.width, self.height)), pixels,
                                     size=(self.width, self.height), depth=0.1 * scale_multiplier)  # fmt: skip
        return Mesh._of(made)

    def _lens(self) -> NDArray[Any]:
        if self.K is None:
            raise ArgumentError("the frame has no K")
        return np.asarray(self.K, dtype=np.float64)

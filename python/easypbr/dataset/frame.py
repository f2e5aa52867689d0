"""A frame of a data set as values: what writers write."""

import dataclasses
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclasses.dataclass
class Frame:
    """What writers write."""

    index: int
    picture: NDArray[Any]  #: height x width x 3, uint8
    depth: NDArray[Any]
    normal: NDArray[Any]
    instance_id: NDArray[Any]  #: int32: place in `objects` + 1, 0 for all else
    K: NDArray[Any]
    T_world_cam: NDArray[Any]  #: OpenCV's axes
    distortion: list[Any]
    distortion_model: str
    objects: list[dict[str, Any]]
    next: "NextFrame | None" = None  #: where things are a moment later, when the spec has motion

    def record(self) -> dict[str, Any]:
        """All but the pixels, as JSON takes it: None for numbers that are none, as of a corner behind the camera."""
        height, width = self.depth.shape
        record: dict[str, Any] = _without_nan({
            "index": self.index, "width": width, "height": height, "K": self.K.tolist(), "T_world_cam": self.T_world_cam.tolist(),
            "distortion": self.distortion, "distortion_model": self.distortion_model, "objects": self.objects,
        })
        return record


def _without_nan(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _without_nan(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_without_nan(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def visible_corners(corners_px: NDArray[Any], corners_cam: NDArray[Any], depth: NDArray[Any]) -> list[bool]:
    """Which corners of a box are in the picture and not behind what it shows. Hidden is a corner that is behind all four pixels
    around it: of a plane through the corner one of them is as far, and beyond a convex outline that ends there lies another."""
    height, width = depth.shape
    last = np.array([width - 1, height - 1])
    inside = ((corners_px >= -0.5) & (corners_px < last + 0.5)).all(1)
    first = np.floor(np.where(inside[:, None], corners_px, 0)).astype(int)
    free = np.zeros(len(first), bool)
    for step in ((0, 0), (1, 0), (0, 1), (1, 1)):
        x, y = np.clip(first + step, 0, last).T
        free |= (depth[y, x] == 0) | (depth[y, x] >= corners_cam[:, 2] * (1 - 1e-5))
    visible: list[bool] = (inside & free).tolist()
    return visible


@dataclasses.dataclass
class NextFrame:
    """The picture a moment later, and how this one's pixels move until then."""

    picture: NDArray[Any]
    flow: NDArray[Any]  #: height x width x 2, pixels
    occluded: NDArray[Any]  #: the point is not seen in the next picture

"""A frame of a data set as values: what writers write."""

import dataclasses
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
        """All but the pixels, as JSON takes it."""
        height, width = self.depth.shape
        return {"index": self.index, "width": width, "height": height, "K": self.K.tolist(),
                "T_world_cam": self.T_world_cam.tolist(), "distortion": self.distortion,
                "distortion_model": self.distortion_model, "objects": self.objects}


@dataclasses.dataclass
class NextFrame:
    """The picture a moment later, and how this one's pixels move until then."""

    picture: NDArray[Any]
    flow: NDArray[Any]  #: height x width x 2, pixels
    occluded: NDArray[Any]  #: the point is not seen in the next picture

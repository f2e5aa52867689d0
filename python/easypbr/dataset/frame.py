"""A frame of a data set as values: what writers write."""

import dataclasses

import numpy as np


@dataclasses.dataclass
class Frame:
    """What writers write."""

    index: int
    picture: np.ndarray  #: height x width x 3, uint8
    depth: np.ndarray
    normal: np.ndarray
    instance_id: np.ndarray  #: int32: place in `objects` + 1, 0 for all else
    K: np.ndarray
    T_world_cam: np.ndarray  #: OpenCV's axes
    distortion: list
    distortion_model: str
    objects: list[dict]
    next: "NextFrame | None" = None  #: where things are a moment later, when the spec has motion

    def record(self) -> dict:
        """All but the pixels, as JSON takes it."""
        height, width = self.depth.shape
        return {"index": self.index, "width": width, "height": height, "K": self.K.tolist(),
                "T_world_cam": self.T_world_cam.tolist(), "distortion": self.distortion,
                "distortion_model": self.distortion_model, "objects": self.objects}


@dataclasses.dataclass
class NextFrame:
    """The picture a moment later, and how this one's pixels move until then."""

    picture: np.ndarray
    flow: np.ndarray  #: height x width x 2, pixels
    occluded: np.ndarray  #: the point is not seen in the next picture

"""OffscreenRenderer: images and depths of a scene."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import ArgumentError
from .constants import RenderFlags
from .drawing import Drawing
from .node import Node
from .scene import Scene

__all__ = ["OffscreenRenderer", "RenderFlags"]


class OffscreenRenderer:
    """Renders without a window. What was made of a scene is kept for the next image, as long as the renderer lives."""

    viewport_width: int
    viewport_height: int
    point_size: float

    def __init__(self, viewport_width: int, viewport_height: int, point_size: float = 1.0) -> None:
        self.viewport_width, self.viewport_height = int(viewport_width), int(viewport_height)
        self.point_size = float(point_size)
        self._drawing: Drawing | None = None

    def render(self, scene: Scene, flags: int = RenderFlags.NONE, seg_node_map: "Mapping[Node, Any] | None" = None) -> Any:
        """Colours (height x width x 3 uint8, x 4 with RenderFlags.RGBA) and depths (height x width float32: metres along the
        optical axis, 0 where there is nothing) of the scene. With RenderFlags.DEPTH_ONLY the depths alone; with
        RenderFlags.SEG the colours are those of `seg_node_map`, whose nodes alone are drawn.

        Raises ValueError if the scene has no camera."""
        node = scene.main_camera_node
        if node is None or node.camera is None:
            raise ArgumentError("render: the scene has no camera: add one with scene.add(PerspectiveCamera(yfov=1.0), pose=...)")
        is_map = bool(flags & RenderFlags.SEG)
        if is_map and seg_node_map is None:
            raise ArgumentError("render: RenderFlags.SEG needs seg_node_map, a dict of nodes to colours")
        drawing = self._drawing = self._drawing or Drawing()
        drawing.update(scene, flags, seg_node_map if is_map else None, self.point_size)
        size = (self.viewport_width, self.viewport_height)
        if not drawing.shown:
            return self._of_nothing(scene, flags)
        drawing.set_camera(node.camera, scene.get_pose(node), *size)
        found = drawing.view.layers(["depth", "object_id"] if is_map else ["depth"], size)
        depth = found["depth"]
        if node.camera.zfar is not None:
            depth = np.where(depth <= node.camera.zfar, depth, np.float32(0))
        if flags & RenderFlags.DEPTH_ONLY:
            return depth
        if is_map:
            return _segments(found["object_id"], depth, drawing, dict(seg_node_map or {})), depth
        return self._colors(scene, flags, depth, found["depth"]), depth

    def _colors(self, scene: Scene, flags: int, depth: NDArray[Any], seen: NDArray[Any]) -> NDArray[Any]:
        """The image over the background, which is sRGB as it is given."""
        assert self._drawing is not None
        view = self._drawing.view
        is_whole = depth is seen or np.array_equal(depth, seen)  # Nothing is left behind zfar.
        if is_whole and not flags & RenderFlags.RGBA:
            view.settings["background.mode"] = "color"
            view.settings["background.color"] = [float(part) for part in np.clip(scene.bg_color[:3], 0, 1)]
            picture = view.render((self.viewport_width, self.viewport_height))
            color = np.empty((*picture.shape[:2], 3), np.uint8)
            for channel in range(3):  # Four times as fast as copying pixel by pixel.
                color[:, :, channel] = picture[:, :, channel]
            return color
        view.settings["background.mode"] = "transparent"
        picture = view.render((self.viewport_width, self.viewport_height)).astype(np.float32) / 255
        alpha = picture[:, :, 3:] * ((depth > 0) | (seen == 0))[:, :, None]
        ground = scene.bg_color.astype(np.float32)
        color = picture[:, :, :3] * alpha + ground[:3] * (1 - alpha)
        if flags & RenderFlags.RGBA:
            color = np.concatenate([color, alpha + ground[3] * (1 - alpha)], axis=2)
        return (np.clip(color, 0, 1) * 255 + 0.5).astype(np.uint8)

    def _of_nothing(self, scene: Scene, flags: int) -> Any:
        shape = (self.viewport_height, self.viewport_width)
        depth = np.zeros(shape, np.float32)
        if flags & RenderFlags.DEPTH_ONLY:
            return depth
        channels = 4 if flags & RenderFlags.RGBA else 3
        ground = np.zeros(3) if flags & RenderFlags.SEG else scene.bg_color[:channels]
        return np.broadcast_to((np.clip(ground, 0, 1) * 255 + 0.5).astype(np.uint8), (*shape, len(ground))).copy(), depth

    def delete(self) -> None:
        """Frees what was made of the scene."""
        if self._drawing is not None:
            self._drawing.close()
        self._drawing = None


def _segments(object_id: NDArray[Any], depth: NDArray[Any], drawing: Drawing, colors: "Mapping[Node, Any]") -> NDArray[Any]:
    """Height x width x 3 uint8: the colour of each pixel's node, black where there is none."""
    table = np.zeros((len(drawing.view.object_names()) + 1, 3), np.uint8)
    for place, name in enumerate(drawing.view.object_names(), 1):
        color = np.asarray(colors[drawing.shown[name]])
        table[place] = color if color.ndim == 0 else color[:3]
    return table[np.where(depth > 0, object_id, 0).astype(int)]

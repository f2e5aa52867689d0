"""Renderer and OffscreenRenderer: images and depths of a scene."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import ArgumentError
from .colors import decoded, encoded
from .constants import RenderFlags
from .drawing import Drawing
from .lines import depths_of_lines
from .node import Node
from .projection import Projection, projection_of
from .scene import Scene

__all__ = ["OffscreenRenderer", "RenderFlags", "Renderer"]


class Renderer:
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
        colors = {shown: _rgb(color) for shown, color in (seg_node_map or {}).items()} if is_map else None
        drawing = self._drawing = self._drawing or Drawing()
        drawing.update(scene, flags, seg_node_map if is_map else None, self.point_size)
        size = (self.viewport_width, self.viewport_height)
        if not drawing.shown:
            return self._of_nothing(scene, flags)
        projection = projection_of(node.camera, scene.get_pose(node), *size)
        drawing.set_camera(projection)
        # As in pyrender, wireframes are solid where only depths or segments are drawn.
        is_solid = is_map or bool(flags & RenderFlags.DEPTH_ONLY)
        layers = drawing.layers(["depth", "object_id"] if is_map else ["depth"], projection.drawn, is_solid)
        found = {name: projection.picked(layer) for name, layer in layers.items()}
        seen = depth = found["depth"]
        if projection.far is not None:
            depth = np.where(depth <= projection.far + projection.back, depth, np.float32(0))
        segments = None if colors is None else _segments(found["object_id"], depth, drawing, colors)
        for shown, ends in drawing.lines(is_solid):
            of_lines = depths_of_lines(ends, projection)
            is_front = of_lines < np.where(depth > 0, depth, np.inf)
            depth = np.where(is_front, of_lines, depth)
            if colors is not None and segments is not None:
                segments[is_front] = colors[shown]
        metres = projection.depths(depth)
        if flags & RenderFlags.DEPTH_ONLY:
            return metres
        if segments is not None:
            return _with_alpha(segments, flags), metres
        return self._colors(scene, flags, depth, seen, projection), metres

    def _colors(self, scene: Scene, flags: int, depth: NDArray[Any], seen: NDArray[Any], projection: Projection) -> NDArray[Any]:
        """The image over the background, which is sRGB as it is given."""
        assert self._drawing is not None
        view = self._drawing.view
        is_whole = not ((depth == 0) & (seen > 0)).any()  # Nothing is left behind zfar.
        if is_whole and (scene.bg_color[3] >= 1 or not flags & RenderFlags.RGBA):
            view.settings["background.mode"] = "color"
            view.settings["background.color"] = [float(part) for part in np.clip(scene.bg_color[:3], 0, 1)]
            picture = projection.picked(view.render(projection.drawn))
            color = np.empty((*picture.shape[:2], 4 if flags & RenderFlags.RGBA else 3), np.uint8)
            for channel in range(color.shape[2]):  # Four times as fast as copying pixel by pixel.
                color[:, :, channel] = picture[:, :, channel]
            return color
        view.settings["background.mode"] = "transparent"
        picture = projection.picked(view.render(projection.drawn)).astype(np.float32) / 255
        alpha = picture[:, :, 3:] * ((depth > 0) | (seen == 0))[:, :, None]
        ground = scene.bg_color.astype(np.float32)
        # Linear, as surfaces are blended with the background that they are drawn over.
        color = encoded(decoded(picture[:, :, :3]) * alpha + decoded(ground[:3]) * (1 - alpha))
        if flags & RenderFlags.RGBA:
            color = np.concatenate([color, alpha + ground[3] * (1 - alpha)], axis=2)
        return (np.clip(color, 0, 1) * 255 + 0.5).astype(np.uint8)

    def _of_nothing(self, scene: Scene, flags: int) -> Any:
        shape = (self.viewport_height, self.viewport_width)
        depth = np.zeros(shape, np.float32)
        if flags & RenderFlags.DEPTH_ONLY:
            return depth
        if flags & RenderFlags.SEG:
            return _with_alpha(np.zeros((*shape, 3), np.uint8), flags), depth
        ground = (np.clip(scene.bg_color[: 4 if flags & RenderFlags.RGBA else 3], 0, 1) * 255 + 0.5).astype(np.uint8)
        return np.broadcast_to(ground, (*shape, len(ground))).copy(), depth

    def delete(self) -> None:
        """Frees what was made of the scene."""
        if self._drawing is not None:
            self._drawing.close()
        self._drawing = None


class OffscreenRenderer(Renderer):
    """What scripts render with; a Renderer, which draws into no window here, either."""


def _segments(
    object_id: NDArray[Any], depth: NDArray[Any], drawing: Drawing, colors: "Mapping[Node, NDArray[Any]]"
) -> NDArray[Any]:
    """Height x width x 3 uint8: the colour of each pixel's node, black where there is none."""
    table = np.zeros((len(drawing.view.object_names()) + 1, 3), np.uint8)
    for place, name in enumerate(drawing.view.object_names(), 1):
        table[place] = colors[drawing.shown[name.partition("/")[0]]]  # "node 1/part" is of "node 1".
    return table[np.where(depth > 0, object_id, 0).astype(int)]


def _rgb(color: Any) -> NDArray[Any]:
    """uint8 x 3 of a number or of three (or four), 0 to 255."""
    given = np.asarray(color)
    is_number = given.dtype.kind in "buif" and (given.ndim == 0 or given.shape in ((3,), (4,)))
    if not is_number or not ((given == np.floor(given)) & (given >= 0) & (given <= 255)).all():
        expected = "expected whole numbers from 0 to 255 for each node, one, three or four (the fourth is not used)"
        raise ArgumentError(f"render: seg_node_map: {expected}, got {color!r}")
    return np.broadcast_to(given if given.ndim == 0 else given[:3], 3).astype(np.uint8)


def _with_alpha(segments: NDArray[Any], flags: int) -> NDArray[Any]:
    """With RenderFlags.RGBA four channels, opaque."""
    return np.dstack([segments, np.full(segments.shape[:2], 255, np.uint8)]) if flags & RenderFlags.RGBA else segments

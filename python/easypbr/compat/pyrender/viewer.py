"""Viewer: EasyPBR's window with a scene in it."""

import threading
from typing import Any

import numpy as np

from .constants import RenderFlags
from .drawing import Drawing
from .projection import projection_of
from .scene import Scene


class Viewer:
    """Shows a scene in EasyPBR's window until it is closed; with `run_in_thread` the window runs on its own thread. Change the
    scene under `render_lock` and call `update()`. Keys, flags of the window and its other options are EasyPBR's own."""

    render_lock: "threading.RLock"
    render_flags: dict[str, Any]
    viewer_flags: dict[str, Any]

    def __init__(
        self,
        scene: Scene,
        viewport_size: "tuple[int, int] | None" = None,
        render_flags: "dict[str, Any] | None" = None,
        viewer_flags: "dict[str, Any] | None" = None,
        registered_keys: Any = None,
        run_in_thread: bool = False,
        auto_start: bool = True,
        **options: Any,
    ) -> None:
        self.scene = scene
        self.render_lock = threading.RLock()
        self.render_flags = dict(render_flags or {})
        self.viewer_flags = {**(viewer_flags or {}), **options}
        self.registered_keys = registered_keys
        self.run_in_thread = run_in_thread
        self._drawing = Drawing()
        self._drawing.view.settings["image.size"] = viewport_size or (640, 480)
        self.update()
        if auto_start:
            self.start()

    def update(self) -> None:
        """Takes over what changed in the scene."""
        flags = RenderFlags.SHADOWS_ALL if self.render_flags.get("shadows") else RenderFlags.NONE
        flags |= RenderFlags.ALL_WIREFRAME if self.render_flags.get("all_wireframe") else 0
        flags |= RenderFlags.FLIP_WIREFRAME if self.render_flags.get("flip_wireframe") else 0
        flags |= 0 if self.render_flags.get("cull_faces", True) else RenderFlags.SKIP_CULL_FACES
        with self.render_lock:
            self._drawing.update(self.scene, flags, point_size=float(self.render_flags.get("point_size", 1.0)))
            view = self._drawing.view
            view.settings["background.color"] = tuple(np.clip(self.scene.bg_color[:3], 0, 1))
            node = self.scene.main_camera_node
            if node is not None and node.camera is not None:
                self._drawing.set_camera(projection_of(node.camera, self.scene.get_pose(node), *view.settings.image.size))

    def start(self) -> None:
        """Opens the window. Raises ContextError without a display."""
        self._drawing.view.show(block=not self.run_in_thread)

    @property
    def is_active(self) -> bool:
        """Whether the window is open."""
        return self._drawing.view.is_open

    def close_external(self) -> None:
        """Closes the window."""
        self._drawing.view.close()

    close = close_external

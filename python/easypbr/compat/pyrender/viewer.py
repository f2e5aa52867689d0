"""Viewer: EasyPBR's window with a scene in it."""

import threading
from collections import deque
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ... import _easypbr
from ...errors import ArgumentError
from .changes import Latest
from .constants import RenderFlags
from .drawing import Drawing
from .light import DirectionalLight
from .projection import projection_of
from .scene import Scene

_RENDER_FLAGS: dict[str, Any] = {
    "flip_wireframe": False, "all_wireframe": False, "all_solid": False, "shadows": False, "vertex_normals": False,
    "face_normals": False, "cull_faces": True, "point_size": 1.0,
}  # fmt: skip
_VIEWER_FLAGS: dict[str, Any] = {
    "mouse_pressed": False, "rotate": False, "rotate_rate": np.pi / 3, "rotate_axis": (0.0, 0.0, 1.0), "view_center": None,
    "record": False, "use_raymond_lighting": False, "use_direct_lighting": False, "lighting_intensity": 3.0,
    "use_perspective_cam": True, "save_directory": None, "window_title": "Scene Viewer", "refresh_rate": 30.0,
    "fullscreen": False, "show_world_axis": False, "show_mesh_axes": False, "caption": None,
}  # fmt: skip
#: Seconds that the window waits for who changes the scene, before it draws what it has.
_PATIENCE = 0.1


class Viewer:
    """Shows a scene in EasyPBR's window until it is closed; with `run_in_thread` the window runs on its own thread. The window
    follows the scene and the flags: change them under `render_lock`. Flags may be given as keyword arguments, too.

    `registered_keys`: functions by keys, each called with the viewer before the next frame, on the window's thread; or lists of
    a function, a list of further arguments and a dict of named ones. They may take `render_lock`."""

    render_lock: "threading.RLock"
    render_flags: dict[str, Any]
    viewer_flags: dict[str, Any]
    viewport_size: tuple[int, int]

    def __init__(
        self,
        scene: Scene,
        viewport_size: "tuple[int, int] | None" = None,
        render_flags: "dict[str, Any] | None" = None,
        viewer_flags: "dict[str, Any] | None" = None,
        registered_keys: "Mapping[str, Any] | None" = None,
        run_in_thread: bool = False,
        auto_start: bool = True,
        **options: Any,
    ) -> None:
        self.scene = scene
        self.render_lock = threading.RLock()
        self.render_flags = _flags("render_flags", _RENDER_FLAGS, render_flags, options)
        self.viewer_flags = _flags("viewer_flags", _VIEWER_FLAGS, viewer_flags, options)
        unknown = [name for name in options if name not in _RENDER_FLAGS and name not in _VIEWER_FLAGS]
        if unknown:
            raise TypeError(f"Viewer: expected keyword arguments out of {', '.join([*_RENDER_FLAGS, *_VIEWER_FLAGS])}; "
                            f"got {', '.join(unknown)}")  # fmt: skip
        self.registered_keys: dict[str, Any] = dict(registered_keys or {})
        self.run_in_thread = run_in_thread
        width, height = (640, 480) if viewport_size is None else viewport_size
        self.viewport_size = int(width), int(height)
        self._drawing = Drawing()
        #: What was taken over last: of the scene and the flags; of the camera; the pose that lights were carried to.
        self._taken: tuple[Any, ...] = ()
        self._camera: tuple[Any, ...] = ()
        self._carried: NDArray[Any] | None = None
        #: Lights that the camera carries, with their poses in its frame, and the flags that they were made of.
        self._lights: list[tuple[DirectionalLight, NDArray[Any]]] = []
        self._lights_key: tuple[Any, ...] = ()
        #: Calls of keys that were pressed, for the next frame.
        self._pressed: deque[Callable[[], object]] = deque()
        view = self._drawing.view
        view.settings["image.size"] = self.viewport_size
        self.update()
        view.before_draw(self._call_pressed)
        view.before_draw(self._follow)
        view.on_event(self._press, "key_down")
        if auto_start:
            self.start()

    def update(self) -> None:
        """Takes over what changed in the scene, also what the window does not see by itself: numbers within arrays."""
        with self.render_lock:
            self._make_lights()
            self._taken, self._carried = self._state(), None
            view, flags = self._drawing.view, self._flags()
            point_size = float(self.render_flags["point_size"])
            self._drawing.update(self.scene, flags, point_size=point_size, carried=self._lights)
            view.settings["background.color"] = tuple(np.clip(self.scene.bg_color[:3], 0, 1))
            self._set_camera()
            self._carry()

    def _state(self) -> tuple[Any, ...]:
        """What tells that something was changed."""
        return Latest.change, self.scene, *self.render_flags.items(), *self._lighting()

    def _lighting(self) -> tuple[Any, ...]:
        return tuple(self.viewer_flags[name] for name in ("use_raymond_lighting", "use_direct_lighting", "lighting_intensity"))

    def _flags(self) -> int:
        given = self.render_flags
        flags = RenderFlags.SHADOWS_ALL if given["shadows"] else RenderFlags.NONE
        if given["flip_wireframe"]:
            flags |= RenderFlags.FLIP_WIREFRAME
        elif given["all_wireframe"]:
            flags |= RenderFlags.ALL_WIREFRAME
        return flags if given["cull_faces"] else flags | RenderFlags.SKIP_CULL_FACES

    def _make_lights(self) -> None:
        if self._lights_key == self._lighting():
            return  # A light that is made is a change, which windows look for.
        self._lights_key = raymond, direct, intensity = self._lighting()
        self._lights = found = []
        if raymond:  # Three that share the intensity, 30 degrees from the optical axis.
            for angle in np.radians([0.0, 120, 240]):
                pose = np.eye(4)
                pose[:3, 2] = np.sin(np.pi / 6) * np.cos(angle), np.sin(np.pi / 6) * np.sin(angle), np.cos(np.pi / 6)
                found.append((DirectionalLight(intensity=float(intensity) / 3), pose))
        if direct:
            found.append((DirectionalLight(intensity=float(intensity)), np.eye(4)))

    def _set_camera(self) -> None:
        """Looks from the scene's camera, unless it is where it was: the window has moved its own since."""
        node = self.scene.main_camera_node
        if node is None or node.camera is None:
            return
        projection = projection_of(node.camera, self.scene.get_pose(node), *self.viewport_size)
        key = (projection.matrix.tobytes(), projection.pose.tobytes())
        if key != self._camera:
            self._camera = key
            self._drawing.set_camera(projection)

    def _follow(self) -> None:
        """Before each frame. What nothing has changed of is not looked at."""
        if self._state() == self._taken and not self._drawing.carried:
            return
        if not self.render_lock.acquire(timeout=_PATIENCE):
            return
        try:
            if self._state() != self._taken:
                self.update()
            else:
                self._carry()
        finally:
            self.render_lock.release()

    def _carry(self) -> None:
        """Moves the lights that the camera carries with it. Needs `render_lock`."""
        if not self._drawing.carried:
            return
        try:
            pose = self._drawing.view.camera.T_world_cam
        except ArgumentError:
            return  # The scene has neither a camera nor anything that one could be placed for.
        if self._carried is None or not np.array_equal(pose, self._carried):
            self._drawing.carry(pose)
            self._carried = pose

    def _press(self, event: "_easypbr.Event") -> bool:
        """Notes the call of a key's function; whether there is one. Events are handled under the view's lock, which who holds
        `render_lock` may wait for: the function, which may take that one, is called outside."""
        for key, given in list(self.registered_keys.items()):
            if event.key.lower() != ("space" if key == " " else key.lower()):
                continue
            function, arguments, named = [*given, [], {}][:3] if isinstance(given, (list, tuple)) else (given, [], {})
            if not event.repeat:
                self._pressed.append(partial(function, self, *arguments, **(named or {})))
            return True
        return False

    def _call_pressed(self) -> None:
        """Before each frame. What is left after an exception is called before the next one."""
        while self._pressed:
            self._pressed.popleft()()

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


def _flags(what: str, defaults: dict[str, Any], given: "dict[str, Any] | None", options: dict[str, Any]) -> dict[str, Any]:
    """All flags of a kind: those given, then those among the keyword arguments."""
    unknown = [str(name) for name in given or {} if name not in defaults]
    if unknown:
        raise TypeError(f"Viewer: {what}: expected names out of {', '.join(defaults)}; got {', '.join(unknown)}")
    return {**defaults, **(given or {}), **{name: value for name, value in options.items() if name in defaults}}

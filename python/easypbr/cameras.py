"""Cameras as people give them: the name of a view, a dict, a matrix, PyVista's triple."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from . import _easypbr
from .errors import ArgumentError
from .tensors import as_numpy

#: Azimuth and elevation in degrees, around the content, whose front an automatic camera at (0, 0) sees.
VIEWS = {
    "front": (0.0, 0.0),
    "back": (180.0, 0.0),
    "right": (90.0, 0.0),
    "left": (-90.0, 0.0),
    "top": (0.0, 90.0),
    "bottom": (0.0, -90.0),
    "iso": (45.0, 35.264389682754654),
}
#: Keys of a dict: what they are in settings.camera.
_KEYS = {
    "position": "position",
    "eye": "position",
    "center": "target",
    "target": "target",
    "look_at": "target",
    "focal_point": "target",
    "up": "up",
    "view_up": "up",
    "fov": "fov_y_deg",
    "fov_y": "fov_y_deg",
    "view_angle": "fov_y_deg",
    "azimuth": "azimuth_deg",
    "elevation": "elevation_deg",
}
_EXPECTED = (
    f"expected a Camera, one of {', '.join(map(repr, VIEWS))}, a dict of settings.camera such as "
    "{'position': (3, 2, 5), 'target': (0, 0, 0), 'fov_y_deg': 30}, a 4 x 4 camera-to-world matrix with OpenGL axes, or "
    "(position, target, up)"
)


def set_camera(handle: "_easypbr.ViewerHandle", camera: Any, named: "Mapping[str, _easypbr.Camera] | None" = None) -> None:
    """Pins the camera of a viewer. `named`: the cameras of its files. Raises ArgumentError for what is no camera, which
    changes nothing."""
    if isinstance(camera, _easypbr.Camera):
        handle.camera = camera
    elif isinstance(camera, str):
        _set_view(handle, camera, named or {})
    elif isinstance(camera, Mapping):
        _set_values(handle, camera)
    elif isinstance(camera, (tuple, list)) and len(camera) == 3 and all(np.size(part) == 3 for part in camera):
        handle.camera = _looking_at(handle, *camera)
    else:
        _set_pose(handle, camera)


def _set_view(handle: "_easypbr.ViewerHandle", name: str, named: "Mapping[str, _easypbr.Camera]") -> None:
    if name in named:
        handle.camera = named[name]
        return
    if name not in VIEWS:
        files = f"; the cameras of the file are {', '.join(map(repr, named))}" if named else ""
        raise ArgumentError(f"camera: there is no view '{name}': {_EXPECTED}{files}")
    azimuth_deg, elevation_deg = VIEWS[name]
    # A camera that was pinned before would stay where it is.
    freed = {"camera.pose": (), "camera.position": _easypbr.auto, "camera.target": _easypbr.auto}
    handle.set_settings({"camera.azimuth_deg": azimuth_deg, "camera.elevation_deg": elevation_deg, **freed})


def _set_values(handle: "_easypbr.ViewerHandle", values: Mapping[str, Any]) -> None:
    given: dict[str, Any] = {}
    for key, value in values.items():
        name = _KEYS.get(str(key), str(key))
        if name in given:
            raise ArgumentError(f"camera: '{key}' is {name}, which is given already")
        _easypbr.field(f"camera.{name}")
        given[name] = value
    pinned = None
    up = given.get("up")
    if up is not None and not isinstance(up, str):
        if "position" not in given or "target" not in given:
            raise ArgumentError("camera: an up vector needs position and target; the world's up axis is a text such as '+z'")
        pinned = _looking_at(handle, given.pop("position"), given.pop("target"), given.pop("up"))
    elif "position" in given or "target" in given:
        given = {"pose": (), **given}
    handle.set_settings({f"camera.{name}": value for name, value in given.items()}, pinned)


def _looking_at(handle: "_easypbr.ViewerHandle", position: Any, target: Any, up: Any) -> "_easypbr.Camera":
    fov_y_deg = handle.get_setting("camera.fov_y_deg")
    known = fov_y_deg if isinstance(fov_y_deg, (int, float)) else 30.0
    return _easypbr.Camera.look_at(position, target, up, known)


def _set_pose(handle: "_easypbr.ViewerHandle", camera: Any) -> None:
    try:
        matrix = np.asarray(as_numpy(camera), dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise ArgumentError(f"camera: {_EXPECTED}; got a {type(camera).__name__}") from None
    if matrix.shape != (4, 4):
        shape = " x ".join(map(str, matrix.shape)) or "a number"
        raise ArgumentError(f"camera: {_EXPECTED}; got {shape}")
    fov_y_deg = handle.get_setting("camera.fov_y_deg")
    known = fov_y_deg if isinstance(fov_y_deg, (int, float)) else 30.0
    handle.camera = _easypbr.Camera.from_opengl(matrix, known)

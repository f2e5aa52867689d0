"""render(): one call from data to an image."""

import os
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _easypbr
from .errors import ArgumentError, UnknownNameError
from .scene import Scene
from .viewer import Viewer

_SHORT_NAMES = {
    "color": "material.color",
    "tonemap": "tonemap.operator",
    "flat": "style.flat",
    "two_sided": "style.two_sided",
    "environment_rotation_deg": "environment.rotation_deg",
    "environment_intensity": "environment.intensity",
}


def render(
    what: Any,
    out: str | os.PathLike | None = None,
    size: ArrayLike | None = None,
    samples: int | None = None,
    environment: Any = None,
    hdr: bool = False,
    camera: "_easypbr.Camera | None" = None,
    background: Any = None,
    settings: Mapping | str | os.PathLike | None = None,
    **values: Any,
) -> np.ndarray:
    """Renders `what`: a path, a Mesh, a Scene, (V, F), a dict of arrays, or a trimesh, Open3D or PyVista object.

    Returns height x width x 4, row 0 on top: uint8 sRGB, or linear float32 with `hdr`. `size` is (800, 600) and
    `samples` 16 by default. `out` writes the image to a file too. `environment`: environment map, a path, an array or
    an Environment. `background`: a colour, an image file, "environment", "blur" or "transparent". Other keywords are
    settings by the last part of their name (roughness=0.3, exposure=2); `settings` is a dict or a file of
    settings."""
    linear_file = out is not None and _easypbr.check_picture_path(out)
    view = Viewer(size, settings, scene=_scene_of(what))
    if environment is not None:
        _set_environment(view, environment)
    if background is not None:
        _set_background(view, background)
    for name, value in values.items():
        view.settings[_full_name(name)] = value
    if camera is not None:
        view.camera = camera
    picture = view.render(samples=samples, hdr=hdr)
    if out is not None:
        _easypbr.save_image(picture if hdr == linear_file else view.render(samples=samples, hdr=linear_file), out)
    return picture


def render_png(what: Any) -> bytes:
    """The bytes of a PNG file, for display in notebooks."""
    return _easypbr.encode_png(render(what))


def _scene_of(what: Any) -> Scene:
    if isinstance(what, Scene):
        return what
    scene = Scene()
    scene.show(what)
    return scene


def _set_environment(view: Viewer, environment: Any) -> None:
    if not isinstance(environment, (str, os.PathLike)) and not isinstance(environment, _easypbr.Environment):
        environment = _easypbr.Environment(environment)
    view.load_environment_map(environment)


def _set_background(view: Viewer, background: Any) -> None:
    mode = {"env": "environment"}.get(background, background) if isinstance(background, str) else None
    if mode in _easypbr.field("background.mode").choices and mode not in ("color", "image"):
        view.settings["background.mode"] = mode
    elif isinstance(background, os.PathLike) or (mode and os.path.splitext(mode)[1]):
        view.settings["background.image"] = background
        view.settings["background.mode"] = "image"
    else:
        view.settings["background.color"] = background


def _full_name(name: str) -> str:
    """The full name of a setting that is given by its last part."""
    if name in _SHORT_NAMES:
        return _SHORT_NAMES[name]
    found = [field.name for field in _easypbr.fields() if name in (field.name, field.name.rsplit(".")[-1])]
    if len(found) == 1:
        return found[0]
    if found:
        raise ArgumentError(f"render(): '{name}' may be {' or '.join(found)}: give it as settings={{'{found[0]}': ...}}")
    try:
        return _easypbr.field(name).name
    except UnknownNameError as error:
        raise TypeError(f"render(): {error}") from None

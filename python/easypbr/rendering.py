"""render(): one call from data to an image."""

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _easypbr
from .arguments import chosen
from .cameras import set_camera
from .errors import ArgumentError, UnknownNameError
from .scene import scene_of
from .viewer import Viewer, show_colorbar

if TYPE_CHECKING:
    from typing import overload

    from typing_extensions import Unpack

    from .settings import RenderSettings
else:

    def overload(function):
        """typing's keeps every overload, and with it this module, until after the interpreter has ended."""
        return function


#: Keywords for settings whose last part is not theirs alone, or is long.
SHORT_NAMES = {
    "color": "material.color",
    "tonemap": "tonemap.operator",
    "flat": "style.flat",
    "two_sided": "style.two_sided",
    "environment_rotation_deg": "environment.rotation_deg",
    "environment_intensity": "environment.intensity",
}
#: Settings that render() has an argument of its own for, or that go together.
_ARGUMENTS = {
    "image.size": "size=(800, 600)",
    "image.samples": "samples=8",
    "environment.file": "environment='map.hdr'",
    "background.color": "background='#ffffff'",
    "background.mode": "background='transparent'",
    "background.image": "background='photo.jpg'",
    "style.color_min": "color_min=0, color_max=1",
    "camera.position": "camera={'position': (3, 2, 5), 'target': (0, 0, 0)}",
    "camera.pose": "camera=T_world_cam",
    "path.enabled": "mode='path'",
}


@overload
def render(
    what: Any,
    out: str | os.PathLike[str] | None = None,
    size: ArrayLike | None = None,
    samples: int | None = None,
    environment: Any = None,
    hdr: Literal[False] = False,
    camera: Any = None,
    background: Any = None,
    settings: Mapping[str, Any] | str | os.PathLike[str] | None = None,
    strict: bool = False,
    preset: str | os.PathLike[str] | None = None,
    mode: Literal["raster", "path"] | None = None,
    **values: "Unpack[RenderSettings]",
) -> NDArray[np.uint8]: ...


@overload
def render(
    what: Any,
    out: str | os.PathLike[str] | None = None,
    size: ArrayLike | None = None,
    samples: int | None = None,
    environment: Any = None,
    *,
    hdr: Literal[True],
    camera: Any = None,
    background: Any = None,
    settings: Mapping[str, Any] | str | os.PathLike[str] | None = None,
    strict: bool = False,
    preset: str | os.PathLike[str] | None = None,
    mode: Literal["raster", "path"] | None = None,
    **values: "Unpack[RenderSettings]",
) -> NDArray[np.float32]: ...


@overload
def render(
    what: Any,
    out: str | os.PathLike[str] | None = None,
    size: ArrayLike | None = None,
    samples: int | None = None,
    environment: Any = None,
    hdr: bool = False,
    camera: Any = None,
    background: Any = None,
    settings: Mapping[str, Any] | str | os.PathLike[str] | None = None,
    strict: bool = False,
    preset: str | os.PathLike[str] | None = None,
    mode: Literal["raster", "path"] | None = None,
    **values: "Unpack[RenderSettings]",
) -> NDArray[Any]: ...


def render(
    what: Any,
    out: str | os.PathLike[str] | None = None,
    size: ArrayLike | None = None,
    samples: int | None = None,
    environment: Any = None,
    hdr: bool = False,
    camera: Any = None,
    background: Any = None,
    settings: Mapping[str, Any] | str | os.PathLike[str] | None = None,
    strict: bool = False,
    preset: str | os.PathLike[str] | None = None,
    mode: Literal["raster", "path"] | None = None,
    **values: Any,
) -> NDArray[Any]:
    """Renders `what`: a Scene, or anything as_mesh() takes: a path, a Mesh, points (n x 3, n x 6 with colours), (V, F), a dict
    or a table of arrays, an object of trimesh, Open3D, PyVista or VTK, or a list of these.

    Returns height x width x 4, row 0 on top: uint8 sRGB, or linear float32 with `hdr`. `size` is (800, 600) and
    `samples` 8 by default. `out` writes the image to a file too. `environment`: environment map, a path, an array or
    an Environment. `background`: a colour, an image (a file or an array), "environment", "blur" or "transparent". `camera`:
    "front", "back", "left", "right", "top", "bottom", "iso", the name of a camera of the file, a Camera, a dict of
    settings.camera, a 4 x 4 camera-to-world matrix with OpenGL axes, or (position, target, up). Points without a finite position are left out with a
    warning, or raise if `strict`. Values that PyVista and VTK colour by get a colour bar. Other keywords are settings by the
    last part of their name (roughness=0.3, exposure=2); `settings` is a dict or a file of settings. `preset`: "dark", "flat",
    "paper", "studio" or a file of settings that all others win over. `mode`: "raster" lights the image as frames that move are,
    "path" traces paths, the default of several samples."""
    linear_file = out is not None and _check_path(out)
    scene, made = scene_of(what, strict=strict)
    view = Viewer(size, settings, scene=scene, preset=preset)
    if environment is not None:
        _set_environment(view, environment)
    if background is not None:
        _set_background(view, background)
    if mode is not None:
        view.settings.path.enabled = _traces_paths(mode)
    for name, value in values.items():
        view.settings[_full_name(name)] = value
    show_colorbar(view, made)
    if camera is not None:
        set_camera(view._handle, camera, None if made is None else made.cameras)
    if out is not None:
        _easypbr.check_picture_path(out, view.settings.image.size, view.settings.background.mode == "transparent")
    picture = view.render(samples=samples, hdr=hdr)
    if out is not None:
        _easypbr.save_image(picture if hdr == linear_file else view.render(samples=samples, hdr=linear_file), out)
    return picture


def render_png(what: Any) -> bytes:
    """The bytes of a PNG file, for display in notebooks."""
    return _easypbr.encode_png(render(what))


def _check_path(out: Any) -> bool:
    """Whether the file is linear. Raises ArgumentError for what is no path, such as the faces of render(V, F)."""
    if not isinstance(out, (str, os.PathLike)):
        shape = getattr(out, "shape", None)
        kind = type(out).__name__ if shape is None else f"{' x '.join(map(str, shape))} array"
        raise ArgumentError(f"render(): out: expected a path, got a {kind}; vertices and faces are one argument: render((V, F))")
    return _easypbr.check_picture_path(out)


def _set_environment(view: Viewer, environment: Any) -> None:
    if not isinstance(environment, (str, os.PathLike)) and not isinstance(environment, _easypbr.Environment):
        environment = _easypbr.Environment(environment)
    view.load_environment_map(environment)


def _set_background(view: Viewer, background: Any) -> None:
    mode = {"env": "environment"}.get(background, background) if isinstance(background, str) else None
    if mode in _easypbr.field("background.mode").choices and mode not in ("color", "image"):
        view.settings["background.mode"] = mode
    elif isinstance(background, os.PathLike) or (mode and os.path.splitext(mode)[1]) or np.ndim(background) >= 2:
        view.load_background_image(background)
    else:
        view.settings["background.color"] = background


def _traces_paths(mode: Any) -> bool:
    return chosen("render(): mode", mode, ("raster", "path")) == "path"


def _full_name(name: str) -> str:
    """The full name of a setting that is given by its last part."""
    if name in SHORT_NAMES:
        return SHORT_NAMES[name]
    found = [field.name for field in _easypbr.fields() if name in (field.name, field.name.rsplit(".")[-1])]
    if found and _easypbr.synonym(name) is not None:  # a user who writes width=640 means the image, not the outline
        raise TypeError(f"render(): {_unknown(name)}; '{found[0]}' is given as settings={{'{found[0]}': ...}}")
    if len(found) == 1:
        return found[0]
    if found:
        raise ArgumentError(f"render(): '{name}' may be {' or '.join(found)}: give it as settings={{'{found[0]}': ...}}")
    raise TypeError(f"render(): {_unknown(name)}") from None


def _unknown(name: str) -> str:
    """What a wrong keyword is called here."""
    meant = _easypbr.synonym(name)
    if meant is None:
        try:
            return _easypbr.field(name).name
        except UnknownNameError as error:
            return str(error)
    if meant.advice and not meant.setting:
        return f"there is no '{name}': {meant.advice}"
    return f"there is no '{name}': it is called {keyword_of(meant.setting)}"


def keyword_of(setting: str) -> str:
    """How render() takes a setting."""
    if setting in _ARGUMENTS:
        return _ARGUMENTS[setting]
    short = [keyword for keyword, full in SHORT_NAMES.items() if full == setting]
    last = setting.rsplit(".")[-1]
    is_unique = sum(field.name.rsplit(".")[-1] == last for field in _easypbr.fields()) == 1 and not _easypbr.synonym(last)
    keyword = f"{short[0]}=..." if short else f"{last}=..." if is_unique else f"settings={{'{setting}': ...}}"
    return keyword + _choices_of(setting)


def _choices_of(setting: str) -> str:
    """", one of 'hard', 'pcf', 'soft'"; empty for numbers, colours and texts."""
    field = _easypbr.field(setting)
    if field.type == "boolean":
        return ", True or False"
    return f", one of {', '.join(map(repr, field.choices))}" if field.type == "choice" else ""

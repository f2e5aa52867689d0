"""view.lights: the three-point lights, which are settings, and the lights of the scene, by name."""

from collections.abc import Iterator
from typing import Any

from . import _easypbr
from .arguments import real_of
from .errors import ArgumentError

_STUDIO = ("key", "fill", "rim")
_STUDIO_FIELDS = ("enabled", "position", "color", "intensity", "casts_shadows", "radius")


class SceneLight:
    """A light of the scene; assignments to its attributes change the scene."""

    def __init__(self, scene: "_easypbr.SceneHandle", name: str) -> None:
        object.__setattr__(self, "_scene", scene)
        object.__setattr__(self, "_name", name)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self._scene.light(self._name), name)

    def __setattr__(self, name: str, value: Any) -> None:
        light = self._scene.light(self._name)
        setattr(light, name, value)
        self._scene.set_light(self._name, light)

    def __dir__(self) -> list[str]:
        return dir(_easypbr.Light)

    def __repr__(self) -> str:
        return f"<light '{self._name}': {self.type}, {self.intensity:g}>"


class StudioLight:
    """The key, fill or rim light: the settings lights.<name>.*, with a linear colour as for all lights. Reading an
    automatic value returns the inferred one; assigning pins it."""

    def __init__(self, handle: "_easypbr.ViewerHandle", name: str) -> None:
        object.__setattr__(self, "_handle", handle)
        object.__setattr__(self, "_prefix", f"lights.{name}.")

    type = "point"

    def _full(self, name: str) -> str:
        if name not in _STUDIO_FIELDS:
            raise AttributeError(f"a studio light has {', '.join(_STUDIO_FIELDS)}, but no '{name}'")
        return self._prefix + name

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        value = self._handle.get_setting(self._full(name))
        if isinstance(value, (_easypbr.Automatic, _easypbr.Follow)):
            # What was inferred, so that `intensity *= 2` means what it says.
            known = getattr(value, "value", None)
            value = known if known is not None else self._inferred(name, value)
        return tuple(map(_linear, value)) if name == "color" else value

    def _inferred(self, name: str, automatic: Any) -> Any:
        """The value for the next image; the setting itself if there is no content to infer it from."""
        try:
            return self._handle.resolved_setting(self._full(name))
        except ArgumentError:
            return automatic

    def __setattr__(self, name: str, value: Any) -> None:
        if name == "color" and not isinstance(value, str):
            value = tuple(_encoded(real_of(self._full(name), c)) for c in value)
        self._handle.set_setting(self._full(name), value)

    def __dir__(self) -> list[str]:
        return [*_STUDIO_FIELDS, "type"]


class Lights:
    """The lights of a viewer by name: "key", "fill", "rim", and those that were added."""

    def __init__(self, handle: "_easypbr.ViewerHandle", scene: "_easypbr.SceneHandle") -> None:
        self._handle, self._scene = handle, scene

    def __getitem__(self, name: str) -> "SceneLight | StudioLight":
        if name in _STUDIO:
            return StudioLight(self._handle, name)
        self._scene.light(name)
        return SceneLight(self._scene, name)

    def _names(self) -> list[str]:
        return [*_STUDIO, *self._scene.light_names()]

    def __contains__(self, name: str) -> bool:
        return name in self._names()

    def __iter__(self) -> Iterator[str]:
        return iter(self._names())

    def __len__(self) -> int:
        return len(self._names())


# IEC 61966-2-1.


def _linear(c: float) -> float:
    return c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4


def _encoded(c: float) -> float:
    return 12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055

"""Settings as attributes: view.settings.camera.fov_y_deg = 45."""

import json
from collections.abc import Iterator, Mapping
from typing import Any

from . import _easypbr
from .errors import UnknownNameError


class SettingsGroup:
    """A group of settings; attributes are the next parts of their names."""

    def __init__(self, handle: "_easypbr.ViewerHandle", prefix: str) -> None:
        object.__setattr__(self, "_handle", handle)
        object.__setattr__(self, "_prefix", prefix)

    def _next_parts(self) -> list[str]:
        parts = (f.name[len(self._prefix) :].split(".")[0] for f in _FIELDS.values() if f.name.startswith(self._prefix))
        return list(dict.fromkeys(parts))

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._next_parts()]

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        full = self._prefix + name
        if full in _FIELDS:
            return self._handle.get_setting(full)
        if name in self._next_parts():
            return SettingsGroup(self._handle, full + ".")
        raise _attribute_error(full)

    def __setattr__(self, name: str, value: Any) -> None:
        full = self._prefix + name
        if full in _FIELDS:
            self._handle.set_setting(full, value)
        elif name in self._next_parts():
            if not isinstance(value, Mapping):
                raise AttributeError(f"'{full}' is a group of settings: set its members, or assign a dict of them")
            self._handle.set_settings(_by_full_names(value, full + "."))
        else:
            raise _attribute_error(full)

    def __iter__(self) -> Iterator[tuple[str, Any]]:
        """Pairs of the full name and the value, in the order of the reference."""
        for name in _FIELDS:
            if name.startswith(self._prefix):
                yield name, self._handle.get_setting(name)

    def __repr__(self) -> str:
        return "\n".join(f"{name} = {value!r}" for name, value in self)


class Settings(SettingsGroup):
    """All settings of a viewer, as groups: image, camera, environment, background, lights, shading, tonemap, ..."""

    def __init__(self, handle: "_easypbr.ViewerHandle") -> None:
        super().__init__(handle, "")

    def __getitem__(self, name: str) -> Any:
        """The setting with this full name: settings["camera.fov_y_deg"]."""
        return self._handle.get_setting(name)

    def __setitem__(self, name: str, value: Any) -> None:
        self._handle.set_setting(name, value)

    def resolve(self, name: str) -> Any:
        """The value for the next image (auto: each mesh has its own), without latching it."""
        return self._handle.resolved_setting(name)

    def describe(self, name: str) -> str:
        """Description, unit, range and default of a setting."""
        field = _easypbr.field(name)
        lines = [field.name + (f" [{field.unit}]" if field.unit else ""), field.doc]
        if field.choices:
            lines.append("one of " + ", ".join(field.choices))
        lines.append(f"default: {field.default!r}")
        return "\n".join(lines)

    def update(self, values: Mapping) -> None:
        """Sets values from a dict, all or, with an error, none: nested ({"camera": {"fov_y_deg": 45}}), by full names, or
        as to_dict() gives it."""
        if "easypbr" in values:
            self._handle.settings_from_json(json.dumps(values))
        else:
            self._handle.set_settings(_by_full_names(values, ""))

    def to_dict(self) -> dict:
        """All settings, given and inferred, and the lights of the scene, as in a settings file. Raises ArgumentError where a
        name is not UTF-8."""
        return json.loads(self._handle.settings_to_json())


def _by_full_names(values: Mapping[str, Any], prefix: str) -> dict[str, Any]:
    named: dict[str, Any] = {}
    for name, value in values.items():
        full = prefix + name
        if isinstance(value, Mapping) and full not in _FIELDS:
            named |= _by_full_names(value, full + ".")
        else:
            named[full] = value
    return named


def _attribute_error(full: str) -> AttributeError:
    try:
        _easypbr.field(full)
    except UnknownNameError as error:
        return AttributeError(str(error))
    return AttributeError(full)


_FIELDS = {field.name: field for field in _easypbr.fields()}

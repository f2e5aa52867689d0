"""Specs of data sets: read from TOML files, checked before anything is drawn."""

import dataclasses
import difflib
import os
import sys
import typing
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from ..errors import ArgumentError, FileError
from .limits import check_camera, check_names, check_numbers
from .tables import DatasetTables, ObjectSpec, Range, SensorSpec
from .writers import WRITERS

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


@dataclasses.dataclass
class DatasetSpec(DatasetTables):
    """A data set. Frame `i` follows from the spec, the seed and `i` alone."""

    @classmethod
    def demo(cls, count: int = 100) -> "DatasetSpec":
        """Drones of several shapes and materials before procedural skies: needs no files."""
        return cls(
            count=count,
            objects=[ObjectSpec(class_name="drone", count=(1, 3), tilt_deg=20.0)],
            sensor=SensorSpec(exposure=(-0.7, 0.7), blur=(0.0, 0.8), noise=(0.0, 0.02)),
        )

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str]) -> "DatasetSpec":
        """Reads a spec; files in it are relative to the TOML file's folder. Raises ArgumentError naming the key, FileError."""
        path = Path(path)
        try:
            values = tomllib.loads(path.read_text(encoding="utf-8-sig"))
        except OSError as error:
            raise FileError(f"cannot read {path}: {error.strerror}") from None
        except ValueError as error:  # of TOML, or of UTF-8
            raise ArgumentError(f"{path}: {error}") from None
        except RecursionError:
            raise ArgumentError(f"{path}: its values are nested too deeply") from None
        spec = _from_dict(cls, values, str(path))
        spec._resolve_files(path.parent)
        spec.check()
        return spec

    def _resolve_files(self, folder: Path) -> None:
        for entry in self.objects:
            if not entry.source.startswith("builtin:"):
                entry.source = str(folder / entry.source)
        if self.surroundings.source:
            self.surroundings.source = str(folder / self.surroundings.source)
        self.background.files = tuple(str(folder / file) for file in self.background.files)

    def check(self) -> None:
        """Raises ArgumentError naming the first value that cannot be."""
        choices = {
            "image.format": (self.image.format, ("png", "jpg")),
            "placement.mode": (self.placement.mode, ("frustum", "surface")),
            "background.mode": (self.background.mode, ("sky", "environment", "image", "color")),
            "surroundings.up": (str(self.surroundings.up).lower(), ("x", "y", "z", "+x", "+y", "+z", "-x", "-y", "-z")),
            "on_error": (self.on_error, ("stop", "skip")),
        }
        for i, entry in enumerate(self.objects):
            choices[f"objects[{i}].rotation"] = (entry.rotation, ("upright", "any", "none"))
        for i, light in enumerate(self.lights):
            choices[f"lights[{i}].type"] = (light.type, ("directional", "point", "rectangle", "disc", "sphere"))
        for name in self.writers:
            choices[f"writers ({name})"] = (name, tuple(WRITERS))
        for key, (value, allowed) in choices.items():
            if value not in allowed:
                raise ArgumentError(f"dataset: {key}: expected {', '.join(allowed)}, got '{value}'{_nearest(value, allowed)}")
        check_numbers(self)
        check_names(self)
        check_camera(self)
        if not self.objects:
            raise ArgumentError("dataset: objects: expected at least one [[objects]]")
        for name in self.writers:
            WRITERS[name].check(self)
        if self.background.mode in ("environment", "image") and not self.background.files:
            raise ArgumentError(f"dataset: background.files: expected files for mode '{self.background.mode}'")


def _nearest(name: str, names: Iterable[str]) -> str:
    found = difflib.get_close_matches(name, names, 1, 0.5)
    return f" (did you mean '{found[0]}'?)" if found else ""


def _from_dict(cls: Any, values: dict[str, Any], where: str) -> Any:
    """An object of a class of tables; keys are its fields, "class" stands for class_name."""
    hints = typing.get_type_hints(cls)
    result = cls()
    for key, value in values.items():
        name = "class_name" if key == "class" and "class_name" in hints else key
        if name not in hints:
            names = [("class" if hint == "class_name" else hint) for hint in hints]
            raise ArgumentError(f"{where}: there is no '{key}'{_nearest(key, names)}: expected {', '.join(names)}")
        setattr(result, name, _value(hints[name], value, f"{where}: {key}"))
    return result


def _value(hint: Any, value: Any, where: str) -> Any:
    if dataclasses.is_dataclass(hint):
        if not isinstance(value, dict):
            raise ArgumentError(f"{where}: expected a table, got {value!r}")
        return _from_dict(hint, value, where)
    if typing.get_origin(hint) is list:
        if not isinstance(value, list):
            raise ArgumentError(f"{where}: expected tables [[...]], got {value!r}")
        return [_value(typing.get_args(hint)[0], item, f"{where}[{i}]") for i, item in enumerate(value)]
    if hint == Range:
        return _range(value, where)
    if typing.get_origin(hint) is tuple or hint is tuple:
        return _tuple(hint, value, where)
    if hint is float and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if not isinstance(value, hint) or (hint is int and isinstance(value, bool)):
        raise ArgumentError(f"{where}: expected {_word(hint)}, got {value!r}")
    return value


def _range(value: Any, where: str) -> Range:
    numbers = value if isinstance(value, (list, tuple)) else [value]
    is_number = all(isinstance(number, (int, float)) and not isinstance(number, bool) for number in numbers)
    if not is_number or len(numbers) > 2 or not numbers or (len(numbers) == 2 and numbers[0] > numbers[1]):
        raise ArgumentError(f"{where}: expected a number or [least, largest], got {value!r}")
    return (float(numbers[0]), float(numbers[1])) if len(numbers) == 2 else float(numbers[0])


def _tuple(hint: Any, value: Any, where: str) -> tuple[Any, ...]:
    kinds = typing.get_args(hint)
    if isinstance(value, int) and kinds == (int, int):
        value = [value, value]
    if not isinstance(value, (list, tuple)):
        raise ArgumentError(f"{where}: expected a list, got {value!r}")
    if kinds and kinds[-1] is not Ellipsis and len(kinds) != len(value):
        raise ArgumentError(f"{where}: expected {len(kinds)} values, got {len(value)}")
    if kinds and kinds[0] is not Any:
        kind = kinds[0]
        return tuple(_value(kind, item, where) for item in value)
    try:
        return tuple(tuple(map(float, row)) for row in value)
    except (TypeError, ValueError):
        raise ArgumentError(f"{where}: expected rows of numbers [[fx, 0, cx], [0, fy, cy], [0, 0, 1]], got {value!r}") from None


def _word(hint: Any) -> str:
    return {int: "a whole number", float: "a number", str: "a text", bool: "true or false"}.get(hint, str(hint))

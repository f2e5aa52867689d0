#!/usr/bin/env python3
"""Writes the typed stub of view.settings from the table of settings, so that editors complete names.

usage: write_settings_stub.py FOLDER      that holds the package; writes FOLDER/easypbr/settings.pyi
"""
import pathlib
import sys

TYPES = {"boolean": "bool", "integer": "int", "number": "float", "text": "str", "colormap": "str"}
HEADER = '''from collections.abc import Callable, Iterator, Mapping
from os import PathLike
from typing import Literal, TypedDict

from numpy.typing import ArrayLike

from ._easypbr import Automatic, Follow
'''
#: Arguments of render() of the same name as a setting's last part.
RENDER_ARGUMENTS = {"size", "samples"}
BASE = '''
class SettingsGroup:
    def __iter__(self) -> Iterator[tuple[str, object]]: ...
'''
SETTINGS_METHODS = '''    def __init__(self, handle: object) -> None: ...
    def __getitem__(self, name: str) -> object: ...
    def __setitem__(self, name: str, value: object) -> None: ...
    def resolve(self, name: str) -> object: ...
    def describe(self, name: str) -> str: ...
    def update(self, values: Mapping[str, object]) -> None: ...
    def to_dict(self) -> dict[str, object]: ...
'''


def read_type(field) -> str:
    if field.type == "choice":
        plain = "Literal[" + ", ".join(repr(choice) for choice in field.choices) + "]"
    elif field.type in ("color", "vector"):
        plain = f"tuple[{'int' if field.whole else 'float'}, ...]"
    else:
        plain = TYPES[field.type]
    return plain + (" | Automatic | Follow" if field.can_be_automatic else "")


def write_type(field) -> str:
    extra = {
        "color": " | str | ArrayLike",
        "vector": " | ArrayLike | None",
        "text": " | PathLike[str] | None",
        "colormap": " | ArrayLike | Callable[..., object]",
    }
    return read_type(field) + extra.get(field.type, "")


def class_name(path: tuple) -> str:
    return "".join(part.capitalize() for part in path) + "Settings" if path else "Settings"


def member(name: str, field) -> list:
    lines = ["    @property", f"    def {name}(self) -> {read_type(field)}:", f'        """{field.doc}"""']
    return [*lines, f"    @{name}.setter", f"    def {name}(self, value: {write_type(field)}) -> None: ..."]


def group(path: tuple, tree: dict) -> list:
    """Classes of the sub-groups, then the class of the group itself."""
    lines, members = [], []
    for name, value in tree.items():
        if isinstance(value, dict):
            sub = (*path, name)
            lines += group(sub, value)
            members += ["    @property", f"    def {name}(self) -> {class_name(sub)}: ..."]
            members += [f"    @{name}.setter", f"    def {name}(self, value: Mapping[str, object]) -> None: ..."]
        else:
            members += member(name, value)
    methods = SETTINGS_METHODS.rstrip().splitlines() if not path else []
    return [*lines, "", f"class {class_name(path)}(SettingsGroup):", *methods, *members]


def render_settings(fields, short_names: dict, synonyms: set) -> str:
    """What render() takes beside its arguments: settings by their last part where it is theirs alone and means nothing else in
    other programs, or by a short name."""
    last_parts = [field.name.rsplit(".")[-1] for field in fields]
    keywords = {
        last: field for field, last in zip(fields, last_parts) if last_parts.count(last) == 1 and last not in synonyms
    }
    keywords |= {short: field for field in fields for short, full in short_names.items() if full == field.name}
    rows = [f"    {name}: {write_type(keywords[name])}" for name in sorted(set(keywords) - RENDER_ARGUMENTS)]
    return "\n".join(["", "class RenderSettings(TypedDict, total=False):", *rows, ""])


def stub(fields, short_names: dict, synonyms: set) -> str:
    tree: dict = {}
    for field in fields:
        *groups, name = field.name.split(".")
        place = tree
        for part in groups:
            place = place.setdefault(part, {})
        place[name] = field
    return HEADER + BASE + "\n".join(group((), tree)) + "\n" + render_settings(fields, short_names, synonyms)


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1])
    sys.path.insert(0, str(folder))
    from easypbr import _easypbr, rendering

    synonyms = {synonym.word for synonym in _easypbr.synonyms()}
    (folder / "easypbr/settings.pyi").write_text(stub(_easypbr.fields(), rendering.SHORT_NAMES, synonyms))

"""Configuration files of the first EasyPBR: JSON with unquoted keys, comments and optional commas."""

import logging
import os
import re
from typing import Any

from ...errors import FileError, FormatError

TOKEN = re.compile(r'\s+|//[^\n]*|,|(?P<mark>[{}\[\]:])|"(?P<text>[^"\n]*)"|(?P<word>[^\s{}\[\]:,"/]+)')
#: Keys below `visualization` and the settings they are; what is "auto" stays inferred.
SETTINGS = {
    "cam.exposure": "tonemap.exposure",
    "ssao.enable_ssao": "ssao.enabled",
    "ssao.kernel_radius": "ssao.radius",
    "bloom.enable_bloom": "bloom.enabled",
    "edl.enable_edl_lighting": "edl.enabled",
    "background.show_background_img": "",
    "ibl.enable_ibl": "environment.enabled",
}
TONE_OPERATORS = {"aces": "aces", "reinhardluminance": "reinhard", "reinhard": "reinhard", "linear": "none", "unreal": "aces"}


def parse(text: str, name: str) -> dict[str, Any]:
    tokens: list[tuple[str, int]] = []
    at = 0
    while at < len(text):
        match = TOKEN.match(text, at)
        if not match:
            raise FormatError(f"{name}: line {text.count(chr(10), 0, at) + 1}: cannot read '{text[at : at + 10]}'")
        for kind in ("mark", "text", "word"):
            if match[kind] is not None:
                tokens.append((('"' if kind == "text" else "") + match[kind], text.count("\n", 0, at) + 1))
        at = match.end()
    tokens.append(("", text.count("\n") + 1))
    reader = _Reader(tokens, name)
    return reader.table("" if tokens[0][0] != "{" else "{")


class _Reader:
    def __init__(self, tokens: list[tuple[str, int]], name: str) -> None:
        self.tokens, self.name, self.at = tokens, name, 0

    def next(self) -> str:
        self.at += 1
        return self.tokens[self.at - 1][0]

    def fail(self, expected: str) -> FormatError:
        token, line = self.tokens[self.at - 1]
        return FormatError(f"{self.name}: line {line}: expected {expected}, got '{token or 'the end'}'")

    def table(self, opened: str) -> dict[str, Any]:
        if opened:
            self.next()
        found: dict[str, Any] = {}
        while (key := self.next()) != ("}" if opened else ""):
            if key in ("", "{", "}", "[", "]", ":"):
                raise self.fail("a key")
            if self.tokens[self.at][0] == ":":
                self.next()
            found[key.lstrip('"')] = self.value()
        return found

    def value(self) -> Any:
        token = self.next()
        if token == "{":
            self.at -= 1
            return self.table("{")
        if token == "[":
            items = []
            while self.tokens[self.at][0] != "]":
                items.append(self.value())
            self.next()
            return items
        if token in ("", "}", "]", ":"):
            raise self.fail("a value")
        if token.startswith('"'):
            return token[1:]
        if token in ("true", "false"):
            return token == "true"
        try:
            return float(token)
        except ValueError:
            raise self.fail("a number, true, false, a text, a list or a table") from None


def flat(table: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key, value in table.items():
        found.update(flat(value, f"{prefix}{key}.") if isinstance(value, dict) else {prefix + key: value})
    return found


def read(path: "str | os.PathLike[str]") -> tuple[dict[str, Any], dict[str, Any]]:
    """Settings by their full names, and the values of `visualization` by theirs. What has no counterpart is named once, in the log."""
    try:
        with open(path, encoding="utf-8") as file:
            text = file.read()
    except OSError as error:
        raise FileError(f"{os.fspath(path)}: {error.strerror}") from error
    values = flat(parse(text, os.fspath(path)).get("visualization", {}))
    settings: dict[str, Any] = {}
    ignored = []
    for key, value in values.items():
        if value == "auto":
            continue
        if SETTINGS.get(key):
            settings[SETTINGS[key]] = value
        elif key == "tonemap" and str(value).lower() in TONE_OPERATORS:
            settings["tonemap.operator"] = TONE_OPERATORS[str(value).lower()]
        elif key not in ("cam.fov", "cam.near", "cam.far", "ibl.environment_map_path", "show_gui", "use_offscreen") and not key.startswith("lights.spot_light_"):
            ignored.append(key)
    if ignored:
        logging.getLogger("easypbr").info("%s: without a counterpart: %s", os.fspath(path), ", ".join(ignored))
    return settings, values

#!/usr/bin/env python3
"""Checks that every room includes only the rooms it may use: never upward, never sideways.

usage: check_includes.py [ROOT]      exit code 1 and one line per violation
"""
import pathlib
import re
import sys

MAY_USE = {
    "core": set(),
    "scene": {"core"},
    "gl": {"core"},
    "geometry": {"core", "scene"},
    "io": {"core", "scene"},
    "gpu": {"core", "scene", "gl"},
    "render": {"core", "scene", "gl", "gpu"},
    "app": {"core", "scene", "gl", "io", "gpu", "render"},
    "gui": {"core", "scene", "gl", "io", "gpu", "render", "app"},
    "dataset": {"core", "scene", "gl", "io", "gpu", "render", "app"},
    "viewer": {"core", "scene", "gl", "io", "gpu", "render", "app", "gui", "dataset"},
    "cli": {"core", "scene", "geometry", "gl", "io", "gpu", "render", "app", "gui", "dataset", "viewer"},
    "python": {"core", "scene", "geometry", "gl", "io", "gpu", "render", "app", "gui", "dataset", "viewer", "cli"},
}
INCLUDE = re.compile(r'#include\s+["<]easypbr/(\w+)/')


def violations(root: pathlib.Path):
    for room, allowed in MAY_USE.items():
        for path in sorted((root / "src/easypbr" / room).glob("*.*")):
            for number, line in enumerate(path.read_text().splitlines(), 1):
                match = INCLUDE.match(line)
                if match and match[1] != room and match[1] not in allowed:
                    yield f"{path.relative_to(root)}:{number}: {room} may not include {match[1]}"
                if match and room == "render" and path.stem.endswith("_pass"):
                    other = re.search(r"render/(\w+_pass)\.h", line)
                    if other and other[1] != path.stem:
                        yield f"{path.relative_to(root)}:{number}: a pass may not include another pass"


if __name__ == "__main__":
    found = list(violations(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()))
    print("\n".join(found) or "includes: every room uses only what it may")
    sys.exit(1 if found else 0)

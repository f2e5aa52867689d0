#!/usr/bin/env python3
"""Writes docs/llms.txt, the short overview that coding assistants read (https://llmstxt.org): tasks and calls from docs/howto.md, then
the pages. It stands at the root of the documentation's site and in the Python package.

usage: write_llms.py [--check]      with --check: exit code 1 when the file is not what would be written
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
TARGET = ROOT / "docs/llms.txt"
HEAD = """# EasyPBR

> Physically based renderer for meshes, point clouds and labelled data, without a screen or a GPU. C++20 library, Python package
> `easypbr`, command line `easypbr`. Camera, lights and exposure are inferred; every setting can be given.

Images are numpy arrays, height x width x 4, uint8, row 0 on top. In the calls below: `from easypbr import *`; `mesh` is a `Mesh("drone.ply")`,
`cloud` one without faces, `points` an n x 3 array, `V` and `F` vertices and faces, `scene` a `Scene` that shows `mesh`, `view` a
`Viewer((320, 240), scene=scene)`, `K` and `T` a camera matrix and a camera-to-world pose of OpenCV. Keywords of `render` are settings by the last part of
their name; `view.settings.<group>.<name>` and `--set group.name=value` are the same settings. `easypbr COMMAND --help` lists options.
"""


def rows(text: str) -> list[tuple[str, list[list[str]]]]:
    """The headings of the page with the cells of their table's rows."""
    found = []
    for section in text.split("\n## ")[1:]:
        lines = [line for line in section.splitlines() if line.startswith("|")][2:]
        found.append((section.splitlines()[0], [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines]))
    return found


def pages() -> list[str]:
    nav = (ROOT / "mkdocs.yml").read_text().split("\nnav:\n")[1]
    # A page's address in the site is its name without the extension.
    found = [(name.strip("'"), path) for name, path in re.findall(r"^ +- (.+?): (\S+\.md)$", nav, re.MULTILINE)]
    # Pages that are written, not generated, say themselves what they are called.
    named = [((ROOT / "docs" / path).read_text().splitlines()[0].removeprefix("# ") if (ROOT / "docs" / path).exists() and
              not path.startswith("reference/") else name, path) for name, path in found if path != "index.md"]  # fmt: skip
    return [f"- [{name}]({path.removesuffix('.md')}/)" for name, path in named]


def llms_text() -> str:
    text = HEAD
    for heading, table in rows((ROOT / "docs/howto.md").read_text()):
        text += f"\n## {heading}\n\n| Task | Python | Command line |\n|---|---|---|\n"
        text += "".join(f"| {task} | {call} | {option} |\n" for task, call, option, _ in table)
    return f"{text}\n## Pages\n\n" + "\n".join(pages()) + "\n"


if __name__ == "__main__":
    if sys.argv[1:] == ["--check"]:
        sys.exit(TARGET.read_text() != llms_text() and f"{TARGET} is old: run scripts/write_llms.py")
    elif len(sys.argv) > 1:
        sys.exit(__doc__)
    TARGET.write_text(llms_text())

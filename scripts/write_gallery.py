#!/usr/bin/env python3
"""Writes the gallery of the documentation: each picture beside the lines that draw it, and a link to its page.

usage: write_gallery.py OUTPUT_FILE      the easypbr package must be importable
"""

import ast
import inspect
import pathlib
import re
import sys
import textwrap
from collections.abc import Callable

import write_pictures

ROOT = pathlib.Path(__file__).resolve().parents[1]
IMAGE = re.compile(r"!\[([^\]]*)\]\(images/(\w+)\.(?:png|svg)\)")
#: Pages that stand first: their pictures are those that a reader looks for.
FIRST = ["materials_and_textures", "lights_and_environment", "light", "effects", "data_kinds", "labels_and_scalars", "geometry"]
HEAD = """# Gallery

Each picture of these pages beside the lines that draw it, and the page that explains it. `scripts/write_pictures.py` draws all of
them; `easypbr` is imported as `from easypbr import *`, numpy as `np`. What several of them use stands [at the end](#shared-by-several).
"""


def shown() -> dict[str, tuple[str, str]]:
    """Of each picture the page that shows it first, and its caption there."""
    pages = {page.stem: page for page in sorted((ROOT / "docs").glob("*.md"))}
    found: dict[str, tuple[str, str]] = {}
    for stem in [*FIRST, *sorted(set(pages) - set(FIRST))]:
        for caption, picture in IMAGE.findall(pages[stem].read_text()):
            found.setdefault(picture, (stem, caption))
    return found


def title(page: str) -> str:
    return (ROOT / f"docs/{page}.md").read_text().splitlines()[0].removeprefix("# ")


def lines_of(draw: Callable) -> str:
    """What a function of write_pictures does, without its head and docstring."""
    source = inspect.getsource(draw)
    function = ast.parse(source).body[0]
    assert isinstance(function, ast.FunctionDef)
    body = function.body[1:] if ast.get_docstring(function) and len(function.body) > 1 else function.body
    # Comments above the first line stay.
    lines = source.splitlines()[function.body[0].end_lineno if body is not function.body else function.body[0].lineno - 1 :]
    return textwrap.dedent("\n".join(lines)).strip("\n")


def code_of(name: str, draw: Callable) -> str:
    figure = ROOT / f"examples/figures/{name}.py"
    # A figure is a program; what it draws stands in its draw().
    return lines_of(sys.modules[name].draw) if draw in write_pictures.FIGURES and figure.exists() else lines_of(draw)


def entry(name: str, draw: Callable, page: str, caption: str) -> str:
    program = f" The program: `examples/figures/{name}.py`." if draw in write_pictures.FIGURES else ""
    return f"""
### {name.replace("_", " ").capitalize().replace("Gltf", "glTF")}

<div class="beside" markdown>

![{caption}](../images/{write_pictures.file_name(draw)})

```py
{code_of(name, draw)}
```

</div>

{caption}. [{title(page)}](../{page}.md).{program}
"""


def gallery_page() -> str:
    draws = {draw.__name__: draw for draw in write_pictures.PICTURES + write_pictures.FIGURES + write_pictures.DRAWINGS}
    places = shown()
    text = HEAD
    for page in dict.fromkeys(page for page, _ in places.values()):
        text += f"\n## {title(page)}\n"
        text += "".join(entry(name, draws[name], place, caption) for name, (place, caption) in places.items()
                        if place == page and name in draws)  # fmt: skip
    helpers = (write_pictures.teapot, write_pictures.on_floor, write_pictures.row, write_pictures.sky, write_pictures.window_of)
    shared = "\n\n".join(inspect.getsource(helper).rstrip() for helper in helpers)
    return f"{text}\n## Shared by several\n\n```py\n{shared}\n```\n"


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    pathlib.Path(sys.argv[1]).write_text(gallery_page())

"""What a data set looks like: a contact sheet, a page of numbers."""

import html
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _easypbr
from .writers import Writer, decode_rle

_COLORS = np.array([(230, 80, 60), (60, 160, 230), (90, 200, 90), (240, 180, 40), (180, 90, 220), (60, 200, 190)])
_CELL = 320  #: width of a picture on the sheet


def draw_annotations(picture: NDArray[Any], objects: list[dict[str, Any]], edges: bool = False) -> NDArray[Any]:
    """The picture with masks tinted and boxes drawn; with `edges` the boxes in space too."""
    picture = picture[..., :3].copy()
    for entry in objects:
        color = _COLORS[(entry["category_id"] - 1) % len(_COLORS)]
        if entry["box"][2] < 1:
            continue
        mask = decode_rle(entry["rle"])
        picture[mask] = (0.6 * picture[mask] + 0.4 * color).astype(np.uint8)
        x, y, w, h = entry["box"]
        for first, last in ((0, 1), (h - 2, h)):
            picture[y + max(first, 0) : y + last, x : x + w] = color
        for first, last in ((0, 2), (w - 2, w)):
            picture[y : y + h, x + max(first, 0) : x + last] = color
        if edges:
            for a in range(8):
                for b in range(a + 1, 8):
                    if bin(a ^ b).count("1") == 1:
                        _line(picture, entry["corners_px"][a], entry["corners_px"][b], color)
    return picture


def _line(picture: NDArray[Any], start: list[float | None], end: list[float | None], color: NDArray[Any]) -> None:
    ends = np.array([start, end], float)  # None, as records have it, becomes NaN.
    if not np.isfinite(ends).all():
        return
    height, width = picture.shape[:2]
    steps = int(min(np.abs(ends[1] - ends[0]).max(), 8 * max(width, height))) + 2
    x, y = np.rint(np.linspace(ends[0], ends[1], steps)).astype(int).T
    for dx, dy in ((0, 0), (1, 0), (0, 1)):
        inside = (x + dx >= 0) & (x + dx < width) & (y + dy >= 0) & (y + dy < height)
        picture[y[inside] + dy, x[inside] + dx] = color


def _shrunk(picture: NDArray[Any], width: int) -> NDArray[Any]:
    """Means of whole blocks of pixels."""
    step = max(1, picture.shape[1] // width)
    height, width = picture.shape[0] // step, picture.shape[1] // step
    blocks = picture[: height * step, : width * step].reshape(height, step, width, step, 3)
    return blocks.mean((1, 3)).astype(np.uint8)


def contact_sheet(records: list[dict[str, Any]], folder: Path, names: Writer, count: int = 20, columns: int = 5) -> NDArray[Any]:
    """The first pictures with their annotations, in rows."""
    cells = []
    for record in records[:count]:
        picture = _easypbr.load_image(folder / names.picture(record["index"]))
        cells.append(_shrunk(draw_annotations(picture, record["objects"]), _CELL))
    columns = min(columns, len(cells))
    rows = -(-len(cells) // columns)
    height, width = cells[0].shape[:2]
    sheet = np.full((rows * (height + 4) + 4, columns * (width + 4) + 4, 3), 255, np.uint8)
    for i, cell in enumerate(cells):
        y, x = 4 + i // columns * (height + 4), 4 + i % columns * (width + 4)
        sheet[y : y + height, x : x + width] = cell
    return sheet


def statistics_page(records: list[dict[str, Any]], classes: list[str]) -> tuple[str, dict[str, Any]]:
    """A page of HTML, and its numbers: classes, sizes, visibility."""
    entries = [entry for record in records for entry in record["objects"]]
    statistics: dict[str, Any] = {"images": len(records), "objects": len(entries), "classes": {}}
    sections = []
    for name in classes:
        own = [entry for entry in entries if entry["class"] == name]
        statistics["classes"][name] = len(own)
        sizes = [max(entry["box"][2:]) for entry in own]
        sections.append(f"<h2>{html.escape(name)}: {len(own)} objects</h2>"
                        + _bars("Longer side of the box, pixels", sizes, [0, 16, 32, 64, 96, 128, 256, 512, 1 << 16])
                        + _bars("Visible, percent", [100 * e["visible_fraction"] for e in own], range(0, 101, 10))
                        + _bars("Cut off by the picture, percent", [100 * e["truncation"] for e in own], range(0, 101, 10)))
    counts = _bars("Objects in a picture", [len(record["objects"]) for record in records], [0, 1, 2, 3, 4, 5, 8, 16, 1 << 16])
    page = (f"<!doctype html><meta charset=utf-8><title>Data set</title><style>body{{font:14px sans-serif;margin:2em}}"
            f"td{{padding:0 .5em}}div{{background:#4a90d9;height:.9em}}</style><h1>{len(records)} pictures, "
            f"{len(entries)} objects</h1>{counts}{''.join(sections)}"
            "<p><img src=contact_sheet.png style='max-width:100%'></p>\n")
    return page, statistics


def _bars(title: str, values: list[float], edges: Iterable[int]) -> str:
    edges = list(edges)
    counts, _ = np.histogram(values, edges)
    rows = [f"<tr><td>{low} – {high}<td>{n}<td><div style='width:{300 * n / max(counts.max(), 1):.0f}px'></div>"
            for low, high, n in zip(edges, edges[1:], counts)]
    return f"<h3>{title}</h3><table>{''.join(rows)}</table>"

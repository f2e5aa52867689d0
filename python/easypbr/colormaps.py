"""Colour maps that are arrays, or matplotlib's, as the texts that settings hold."""
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import ArgumentError
from .tensors import as_numpy

#: Colours of a table; a table of the library has as many.
_COUNT = 256


def colormap_text(what: Any) -> str:
    """The colours with commas between them: of an n x 3 or n x 4 array, of texts, of a Colormap of matplotlib, or of the one
    that matplotlib has by this name. Another name is given back as it is."""
    if isinstance(what, str):
        found = _named_by_matplotlib(what)
        return what if found is None else colormap_text(found)
    if callable(what) and hasattr(what, "N"):
        # In the middle of each part of the values, so that steps of a map stay where they are.
        return colormap_text(what((np.arange(_COUNT) + 0.5) / _COUNT))
    if isinstance(what, (list, tuple)) and what and all(isinstance(color, str) for color in what):
        return _text_of_texts(what)
    array = _numbers(what)
    return ",".join(f"#{red:02x}{green:02x}{blue:02x}" for red, green, blue in _codes(array).tolist())


def _named_by_matplotlib(name: str) -> Any:
    try:
        import matplotlib
    except ImportError:
        return None
    maps = matplotlib.colormaps
    return maps[name] if name in maps else None


def _text_of_texts(colors: Any) -> str:
    if len(colors) < 2:
        raise ArgumentError(f"colormap: expected at least 2 colours, got {len(colors)}")
    for color in colors:
        if "," in color:
            raise ArgumentError(f"colormap: expected texts of one colour each, got {color!r}")
    return ",".join(colors)


def _numbers(what: Any) -> NDArray[Any]:
    expected = "colormap: expected a name, n x 3 colours from 0 to 1 or of uint8, or a Colormap of matplotlib"
    try:
        array = np.asarray(as_numpy(what))
    except (TypeError, ValueError) as error:
        raise ArgumentError(f"{expected}, got {type(what).__name__}") from error
    if array.dtype.kind not in "biuf":
        raise ArgumentError(f"{expected}, got {type(what).__name__}")
    if array.ndim != 2 or array.shape[0] < 2 or array.shape[1] not in (3, 4):
        shape = " x ".join(map(str, array.shape)) or repr(what)
        raise ArgumentError(f"colormap: expected n x 3 or n x 4 colours, at least 2 of them, got {shape}")
    return array


def _codes(array: NDArray[Any]) -> NDArray[np.uint8]:
    """8-bit codes of n x 3 colours."""
    if array.dtype != np.uint8:
        wrong = ~((array >= 0) & (array <= 1))
        if wrong.any():
            row, column = np.argwhere(wrong)[0]
            raise ArgumentError(
                f"colormap: expected numbers from 0 to 1, or of uint8, got {array[row, column]} of {array.dtype} in row {row} "
                f"of {len(array)}"
            )
        array = np.rint(array.astype(np.float64) * 255).astype(np.uint8)
    if array.shape[1] == 4 and (array[:, 3] != 255).any():
        row = int(np.argmax(array[:, 3] != 255))
        raise ArgumentError(f"colormap: expected opaque colours, got one with alpha in row {row} of {len(array)}")
    return array[:, :3]

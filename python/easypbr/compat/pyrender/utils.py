"""pyrender's module of this name: colours as arrays of floats."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...errors import ArgumentError
from .colors import color, unit


def format_color_vector(value: ArrayLike, length: int) -> NDArray[Any]:
    """A colour of `length` floats, 0 to 1: a single number is all of them, further channels are 1."""
    return color(value, length, 1.0)


def format_color_array(value: ArrayLike, shape: tuple[int, int]) -> NDArray[Any]:
    """Colours of shape[0] rows and shape[1] channels, float32, 0 to 1, of as many rows or of one colour for all. Channels that
    are not given are 1, those beyond shape[1] are left out. Raises ArgumentError for other dimensions."""
    count, channels = shape
    found = unit(value)
    if found.ndim not in (1, 2) or found.ndim == 2 and len(found) != count:
        got = " x ".join(map(str, found.shape)) or "a single number"
        raise ArgumentError(f"format_color_array: expected {count} rows of numbers, or a list of them for all rows; got {got}")
    found = np.tile(found, (count, 1)) if found.ndim == 1 else found
    ones = np.ones((count, max(channels - found.shape[1], 0)))
    return np.column_stack([found, ones])[:, :channels].astype(np.float32)


__all__ = ["format_color_array", "format_color_vector"]

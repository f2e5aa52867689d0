"""Colours as pyrender takes them: whole numbers are 0 to 255, others 0 to 1."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...errors import ArgumentError


def unit(values: ArrayLike) -> NDArray[Any]:
    """float64, 0 to 1."""
    given = np.asarray(values)
    return given / 255 if given.dtype.kind in "iu" else given.astype(np.float64)


def color(value: ArrayLike | None, length: int, default: ArrayLike) -> NDArray[Any]:
    """A colour of `length` channels: a single number is all of them, further channels are 1. None: `default`."""
    channels = unit(default if value is None else value).squeeze()
    if channels.ndim > 1:
        raise ArgumentError(f"a colour: expected {length} numbers, got an array of {' x '.join(map(str, channels.shape))}")
    channels = np.full(length, channels) if channels.ndim == 0 else channels
    return np.append(channels, np.ones(max(length - len(channels), 0)))[:length]


def colors(values: ArrayLike, count: int) -> NDArray[Any]:
    """count x 4 float32 of count x 3 or count x 4, or of one colour for all."""
    found = unit(values)
    found = np.tile(found, (count, 1)) if found.ndim == 1 else found
    if found.ndim != 2 or len(found) != count or found.shape[1] < 3:
        raise ArgumentError(f"color_0: expected {count} x 3 or {count} x 4, got {' x '.join(map(str, found.shape))}")
    return np.column_stack([found, np.ones(count)])[:, :4].astype(np.float32)


def encoded(linear: NDArray[Any]) -> NDArray[Any]:
    """sRGB of linear values, 0 to 1."""
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055)


def decoded(srgb: NDArray[Any]) -> NDArray[Any]:
    """Linear values of sRGB, 0 to 1."""
    srgb = np.clip(srgb, 0, 1)
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)

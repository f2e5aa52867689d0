"""pyrender's module of this name: colours as arrays of floats."""

from typing import Any

from numpy.typing import ArrayLike, NDArray

from .colors import color, colors


def format_color_vector(value: ArrayLike, length: int) -> NDArray[Any]:
    """A colour of `length` floats, 0 to 1: a single number is all of them, further channels are 1."""
    return color(value, length, 1.0)


def format_color_array(value: ArrayLike, shape: tuple[int, int]) -> NDArray[Any]:
    """Colours of shape[0] rows and shape[1] floats, 0 to 1: channels that are not given are 1."""
    return colors(value, shape[0])[:, : shape[1]]


__all__ = ["format_color_array", "format_color_vector"]

"""Mat: an image with the methods of OpenCV's matrices that scripts call, and tensors of it."""

import os
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ... import _easypbr
from ...errors import ArgumentError


class Mat:
    """An image, height x width x channels. Like OpenCV's, its channels are blue, green, red where files are read and written; what
    the renderer returns is red, green, blue, bottom row first, so that scripts call .rgba2bgra().flip_y()."""

    data: NDArray[Any]

    def __init__(self, source: "str | os.PathLike[str] | ArrayLike | None" = None) -> None:
        self.data = np.zeros((0, 0, 1), np.uint8)
        if isinstance(source, (str, os.PathLike)):
            self.from_file(source)
        elif source is not None:
            self.from_numpy(source)

    def from_numpy(self, array: ArrayLike) -> "Mat":
        data = np.array(array)
        if data.ndim not in (2, 3) or (data.ndim == 3 and data.shape[2] > 4):
            raise ArgumentError(f"Mat: expected height x width x 1 to 4, got {' x '.join(map(str, data.shape))}")
        self.data = np.atleast_3d(data)
        return self

    def from_file(self, path: "str | os.PathLike[str]") -> "Mat":
        self.data = _swapped(_easypbr.load_image(path))
        return self

    def to_file(self, path: "str | os.PathLike[str]") -> None:
        _easypbr.save_image(np.ascontiguousarray(_swapped(self.data)), path)

    def clone(self) -> "Mat":
        return Mat(self.data)

    def empty(self) -> bool:
        return self.data.size == 0

    @property
    def rows(self) -> int:
        return int(self.data.shape[0])

    @property
    def cols(self) -> int:
        return int(self.data.shape[1])

    def channels(self) -> int:
        return int(self.data.shape[2])

    def _swap(self) -> "Mat":
        return Mat(_swapped(self.data))

    rgb2bgr = _swap
    bgr2rgb = _swap
    rgba2bgra = _swap
    bgra2rgba = _swap

    def bgra2bgr(self) -> "Mat":
        return Mat(self.data[:, :, :3])

    rgba2rgb = bgra2bgr

    def rgba2bgr(self) -> "Mat":
        return self._swap().bgra2bgr()

    def flip_y(self) -> "Mat":
        return Mat(self.data[::-1])

    def flip_x(self) -> "Mat":
        return Mat(self.data[:, ::-1])

    def hconcat(self, other: "Mat") -> "Mat":
        return Mat(np.hstack([self.data, other.data]))

    def vconcat(self, other: "Mat") -> "Mat":
        return Mat(np.vstack([self.data, other.data]))

    def normalize_range(self, low: float = 0, high: float = 1) -> "Mat":
        data = self.data.astype(np.float32)
        least, most = float(data.min()), float(data.max())
        return Mat(low + (data - least) * ((high - low) / (most - least if most > least else 1)))

    def to_cv8u(self) -> "Mat":
        """From 0 to 1 to 0 to 255."""
        return Mat(self.data if self.data.dtype == np.uint8 else np.round(np.clip(self.data, 0, 1) * 255).astype(np.uint8))

    def to_cv32f(self) -> "Mat":
        return Mat(self.data.astype(np.float32) / 255 if self.data.dtype == np.uint8 else self.data.astype(np.float32))

    def __array__(self, dtype: Any = None, copy: Any = None) -> NDArray[Any]:
        return self.data.astype(dtype) if dtype else self.data.copy()


def _swapped(data: NDArray[Any]) -> NDArray[Any]:
    """Red and blue exchanged; one channel stays."""
    return data[:, :, [2, 1, 0, 3][: data.shape[2]]] if data.ndim == 3 and data.shape[2] >= 3 else data


def mat2tensor(mat: Mat, flip_red_blue: bool = False) -> Any:
    """1 x channels x height x width, 0 to 1."""
    import torch

    data = mat.to_cv32f().data
    return torch.from_numpy(np.ascontiguousarray((_swapped(data) if flip_red_blue else data).transpose(2, 0, 1)[None]))


def tensor2mat(tensor: Any) -> Mat:
    """Of 1 x channels x height x width, or without the 1."""
    data = tensor.detach().cpu().float().numpy()
    data = data[0] if data.ndim == 4 else data
    return Mat(np.ascontiguousarray(data.transpose(1, 2, 0)))

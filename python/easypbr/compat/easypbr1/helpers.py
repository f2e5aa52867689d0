"""ColorMngr, LabelMngr and Profiler."""

import logging
import os
import time
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ... import _easypbr
from ...errors import ArgumentError
from .mat import Mat


def _read(path: "str | os.PathLike[str]") -> list[str]:
    with open(path, encoding="utf-8") as file:
        lines = [line.split("#")[0].strip() for line in file]
    return [line for line in lines if line]


class ColorMngr:
    """Colours of numbers by a colour map; "pubu" is drawn as cividis."""

    def eigen2color(self, values: ArrayLike, color_scheme: str = "magma") -> NDArray[Any]:
        """n x 3, 0 to 1, from the least to the largest value. What is no number has the colour of the least."""
        v = np.asarray(values, dtype=np.float64).ravel()
        known = v[np.isfinite(v)]
        low, high = (known.min(), known.max()) if known.size else (0.0, 1.0)
        table = _easypbr.colormap("cividis" if color_scheme == "pubu" else color_scheme)
        place = (np.nan_to_num(v, nan=low, posinf=high, neginf=low) - low) / (high - low or 1)
        return table[np.round(place * 255).astype(int)] / 255

    def mat2color(self, mat: Mat, color_scheme: str = "magma") -> Mat:
        data = mat.data[:, :, 0]
        return Mat(self.eigen2color(data, color_scheme).reshape(*data.shape, 3).astype(np.float32))

    def magma_color(self, x: float) -> NDArray[Any]:
        return _one(x, "magma")

    def plasma_color(self, x: float) -> NDArray[Any]:
        return _one(x, "plasma")

    def viridis_color(self, x: float) -> NDArray[Any]:
        return _one(x, "viridis")


def _one(x: float, name: str) -> NDArray[Any]:
    return _easypbr.colormap(name)[int(round(min(max(x, 0.0), 1.0) * 255))] / 255


class LabelMngr:
    """LabelMngr(labels_file, colors_file, frequency_file, unlabeled), or LabelMngr(classes, unlabeled) with generated colours. An
    unlabelled index below 0: there is none."""

    def __init__(self, classes: "int | str | os.PathLike[str]", *more: Any) -> None:
        self._colors: NDArray[Any] | None = None
        self._frequencies: NDArray[Any] = np.zeros(0)
        if isinstance(classes, int):
            self._names = [str(label) for label in range(classes)]
            self._unlabeled = int(more[0]) if more else None
        else:
            if len(more) != 3:
                raise ArgumentError("LabelMngr: expected files of labels, colours and frequencies, and the unlabelled index")
            self._names = _read(classes)
            self._colors = np.array([[float(c) for c in line.split(",")] for line in _read(more[0])]) / 255
            self._frequencies = np.array([float(line) for line in _read(more[1])])
            self._unlabeled = int(more[2])

    def nr_classes(self) -> int:
        return len(self._names)

    def get_idx_unlabeled(self) -> int | None:
        return self._unlabeled

    def class_frequencies(self) -> NDArray[Any]:
        return self._frequencies

    def idx2label(self, index: int) -> str:
        return self._names[index]

    def label2idx(self, label: str) -> int:
        return self._names.index(label)

    def set_color_scheme(self, colors: ArrayLike) -> None:
        """n x 3, 0 to 1."""
        self._colors = np.asarray(colors, dtype=np.float64)

    def set_color_for_label_with_idx(self, index: int, color: ArrayLike) -> None:
        self._colors = np.array(self._map().colors / 255 if self._colors is None else self._colors, dtype=np.float64)
        self._colors[index] = np.asarray(color)

    def _map(self) -> "_easypbr.LabelMap":
        unlabeled = self._unlabeled if self._unlabeled is not None and self._unlabeled >= 0 else None
        unknown = "refused" if unlabeled is None else "unlabelled"
        return _easypbr.LabelMap(self._names, colors=self._colors, unlabelled=unlabeled, unknown=unknown)


class Profiler:
    """Times by name, of the processor's clock alone."""

    _began: dict[str, float] = {}
    _spent: dict[str, tuple[float, int]] = {}

    @classmethod
    def start(cls, name: str) -> None:
        cls._began[name] = time.perf_counter()

    @classmethod
    def end(cls, name: str) -> None:
        if name not in cls._began:
            raise ArgumentError(f"Profiler.end('{name}'): it was not started")
        spent, times = cls._spent.get(name, (0.0, 0))
        cls._spent[name] = spent + time.perf_counter() - cls._began.pop(name), times + 1

    @classmethod
    def get_elapsed_ms(cls, name: str) -> float:
        """Of the last time that is known, on average."""
        spent, times = cls._spent.get(name, (0.0, 1))
        return 1000 * spent / times

    @classmethod
    def get_elapsed_ns(cls, name: str) -> float:
        return 1e6 * cls.get_elapsed_ms(name)

    @classmethod
    def print_all_stats(cls) -> None:
        for name, (spent, times) in cls._spent.items():
            logging.getLogger("easypbr").info("%s: %d times, %.3f ms each", name, times, 1000 * spent / times)

    @classmethod
    def clear(cls) -> None:
        cls._began.clear()
        cls._spent.clear()

    @staticmethod
    def is_profiling_gpu() -> bool:
        return False

    @staticmethod
    def set_profile_gpu(on: bool) -> None:
        """Without effect."""

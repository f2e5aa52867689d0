"""Which numbers and names of a spec can be: checked before anything is drawn or written."""

import math
import sys

import numpy as np

from .._easypbr import Camera
from ..errors import ArgumentError
from .tables import DatasetTables

_TINY, _LARGE = sys.float_info.min, 1e30  #: what is more than 0; what no scene needs
_MOST = 1_000_000  #: frames, whose files have names of six digits; tries, which must end
_MOST_OBJECTS, _MOST_LIGHTS = 100_000, 1000

#: By table and key the least and the largest, of both ends of ranges.
_LIMITS: dict[str, dict[str, tuple[float, float]]] = {
    "": {"count": (1, _MOST), "seed": (0, math.inf)},
    "image": {"size": (1, 65536), "samples": (1, 65536)},
    "camera": {"fov_y_deg": (0.001, 179), "distance": (_TINY, _LARGE), "azimuth_deg": (-_LARGE, _LARGE),
               "elevation_deg": (-90, 90)},
    "objects": {"count": (0, _MOST_OBJECTS), "size": (_TINY, _LARGE), "tilt_deg": (-180, 180)},
    "placement": {"distance": (_TINY, _LARGE), "margin": (0, 0.49), "radius": (_TINY, _LARGE), "tries": (1, _MOST)},
    "occlusion": {"min_visible": (0, 1), "max_truncation": (0, 1), "tries": (1, _MOST)},
    "background": {"skies": (1, _MOST), "intensity": (0, _LARGE)},
    "surroundings": {"size": (_TINY, _LARGE), "turn_deg": (-_LARGE, _LARGE)},
    "lights": {"count": (0, _MOST_LIGHTS), "illuminance": (0, _LARGE), "azimuth_deg": (-_LARGE, _LARGE), "elevation_deg": (-90, 90),
               "distance": (_TINY, _LARGE), "size": (_TINY, _LARGE), "saturation": (0, 1)},
    "motion": {"translation": (0, _LARGE), "rotation_deg": (-360, 360), "camera": (0, _LARGE)},
    "sensor": {"exposure": (-30, 30), "blur": (0, 1000), "noise": (0, 10), "jpeg_quality": (1, 100)},
}


def check_numbers(spec: DatasetTables) -> None:
    """Raises ArgumentError naming the first number that is out of its range, is none (NaN), or begins a range beyond its end."""
    for table, limits in _LIMITS.items():
        found = getattr(spec, table) if table else spec
        owners = [(f"{table}[{i}].", item) for i, item in enumerate(found)] if isinstance(found, list) else [(table and f"{table}.", found)]
        for where, owner in owners:
            for key, (least, largest) in limits.items():
                _check(where + key, getattr(owner, key), least, largest)


def _check(key: str, value: float | tuple[float, ...], least: float, largest: float) -> None:
    ends = value if isinstance(value, tuple) else (value,)
    if not all(least <= end <= largest for end in ends):  # NaN is in no range.
        low = "more than 0" if least == _TINY else f"{least:g} or more" if largest >= _LARGE else f"{least:g}"
        expected = low if largest >= _LARGE and least > -_LARGE else "a number" if least <= -_LARGE else f"{low} to {largest:.7g}"
        raise ArgumentError(f"dataset: {key}: expected {expected}, got {_text(value)}")
    if key != "image.size" and len(ends) == 2 and ends[0] > ends[1]:
        raise ArgumentError(f"dataset: {key}: expected [least, largest], got {_text(value)}")


def _text(value: float | tuple[float, ...]) -> str:
    if isinstance(value, tuple):
        return f"[{', '.join(map(_text, value))}]"
    try:
        return f"{value:g}"
    except OverflowError:  # a whole number beyond the range of floats
        return f"a number of {int(value).bit_length()} bits"


def check_names(spec: DatasetTables) -> None:
    """Raises ArgumentError for a class whose name would break the lines of a label file."""
    for i, entry in enumerate(spec.objects):
        name = entry.name()
        if not name.isprintable() or not name.strip():
            raise ArgumentError(f"dataset: objects[{i}].class: expected a name of printable characters, got {name!r}")


def check_camera(spec: DatasetTables) -> None:
    """Raises ArgumentError for a K that is singular or not finite and for a lens that cannot be."""
    given = spec.camera
    try:
        K = np.array(given.K or np.eye(3), dtype=float)
        Camera.from_opencv(K, np.eye(4), spec.image.size, list(given.distortion), given.distortion_model)
    except ValueError as error:
        raise ArgumentError(f"dataset: camera: {str(error).removeprefix('camera: ')}") from None

"""Arguments that several functions take, checked with a message of ours instead of the binding's."""

import operator
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from . import _easypbr
from .errors import ArgumentError

#: The largest number of an image of int32.
_INT32 = 2**31 - 1


def _whole(value: Any) -> int | None:
    """The whole number that a value is; None: it is none, as booleans are."""
    if isinstance(value, (bool, np.bool_)):
        return None
    try:
        return operator.index(value)
    except TypeError:
        return None


def samples_of(samples: Any) -> int | None:
    """A number of samples; None: that of the settings."""
    if samples is None:
        return None
    field = _easypbr.field("image.samples")
    number = _whole(samples)
    if number is None or not field.min <= number <= field.max:
        raise ArgumentError(f"samples: expected a whole number from {field.min:g} to {field.max:g}, got {samples!r}")
    return number


def classes_of(classes: Any) -> dict[str, int]:
    """Semantic ids by names; None: none."""
    if classes is None:
        return {}
    if not isinstance(classes, Mapping):
        raise ArgumentError(f"classes: expected a dict of whole numbers by names of objects, got {classes!r}")
    made = {}
    for name, value in classes.items():
        if not isinstance(name, str):
            raise ArgumentError(f"classes: expected names of objects, got {name!r}")
        number = _whole(value)
        if number is None or not -_INT32 - 1 <= number <= _INT32:
            raise ArgumentError(f"classes[{name!r}]: expected a whole number from {-_INT32 - 1} to {_INT32}, got {value!r}")
        made[name] = number
    return made


def missing_names(wanted: Iterable[str], objects: Iterable[str]) -> list[str]:
    """Names that are neither an object's nor begin with one's and a mark of instances: "object/node", "object:part",
    "object#2"."""
    shown = set(objects)

    def is_known(name: str) -> bool:
        return name in shown or any(mark in "/:#" and name[:at] in shown for at, mark in enumerate(name))

    return [name for name in wanted if not is_known(name)]


def real_of(name: str, value: Any, what: str = "a number") -> float:
    """A real number, which the library checks further; `what` is expected of it."""
    try:
        return float(value + 0)  # float() alone takes text.
    except TypeError:
        raise ArgumentError(f"{name}: expected {what}, got {value!r}") from None
    except OverflowError:
        raise ArgumentError(f"{name}: expected {what} in the range of float64, got a larger number") from None


def chosen(name: str, value: Any, choices: Sequence[str]) -> str:
    """The one of the choices that a text is, in any case."""
    found = value.lower() if isinstance(value, str) else value
    if found in choices:
        return str(found)
    raise ArgumentError(f"{name}: expected {', '.join(map(repr, choices[:-1]))} or {choices[-1]!r}, got {value!r}")

"""Arguments that several functions take, checked with a message of ours instead of the binding's."""

import operator
from collections.abc import Sequence
from typing import Any

from . import _easypbr
from .errors import ArgumentError


def samples_of(samples: Any) -> int | None:
    """A number of samples; None: that of the settings."""
    if samples is None:
        return None
    field = _easypbr.field("image.samples")
    try:
        number = operator.index(samples)
    except TypeError:
        number = 0
    if isinstance(samples, bool) or not field.min <= number <= field.max:
        raise ArgumentError(f"samples: expected a whole number from {field.min:g} to {field.max:g}, got {samples!r}")
    return number


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

"""Numbers of what was changed last: who has seen one knows without a look at a scene that nothing has changed since."""

from collections.abc import Callable
from functools import wraps
from itertools import count
from typing import Any

_numbers = count(1)  # next() is atomic: no two changes have the same number, whatever their threads.


class Latest:
    """The numbers of the latest changes of all scenes."""

    #: Of anything: nodes, meshes, materials, lights, cameras.
    change: int = 0
    #: Of which node is whose child.
    tree: int = 0


def note(is_tree: bool = False) -> None:
    """Notes a change that has been made."""
    number = next(_numbers)
    if is_tree:
        Latest.tree = number
    Latest.change = number


class Noted:
    """Something whose attributes are noted when they are assigned, but for those whose names begin with an underscore."""

    def __setattr__(self, name: str, value: Any) -> None:
        super().__setattr__(name, value)
        if not name.startswith("_"):
            note()


def _noting(method: Callable[..., Any]) -> Callable[..., Any]:
    @wraps(method)
    def noting(self: "Children", *arguments: Any, **named: Any) -> Any:
        try:
            return method(self, *arguments, **named)
        finally:
            note(is_tree=True)

    return noting


class Children(list[Any]):
    """The children of a node: a list whose changes are noted."""


for _name in ("append extend insert remove pop clear reverse sort __setitem__ __delitem__ __iadd__ __imul__").split():
    setattr(Children, _name, _noting(getattr(list, _name)))

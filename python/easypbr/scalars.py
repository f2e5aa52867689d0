"""The scalar fields of a mesh as a dict that writes through to the mesh."""
from collections.abc import Iterator, MutableMapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._easypbr import Mesh


class Scalars(MutableMapping[str, NDArray[Any]]):
    """The type of `mesh.scalars`: read-only arrays by name; assigning to a name or deleting it changes the mesh."""

    def __init__(self, mesh: "Mesh") -> None:
        self._mesh = mesh

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self._mesh._scalars()[name]

    def __setitem__(self, name: str, values: ArrayLike) -> None:
        self._mesh.add_scalar(name, values)

    def update(self, *values: Any, **more: Any) -> None:
        """Adds or replaces all of them; with an error, none."""
        self._mesh._add_scalars(dict(*values, **more))

    def __delitem__(self, name: str) -> None:
        if name not in self:
            raise KeyError(name)
        self._mesh.remove_scalar(name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._mesh._scalars())

    def __len__(self) -> int:
        return len(self._mesh._scalars())

    def __repr__(self) -> str:
        return repr(self._mesh._scalars())

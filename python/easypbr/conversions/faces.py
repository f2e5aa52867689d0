"""What may be the faces beside vertices."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..tensors import array_of, rows_of


class Faces:
    """None, m x k vertex indices, or polygons with numbers of corners of their own; told from clouds and colours."""

    def __init__(self, given: Any) -> None:
        if isinstance(given, np.ndarray) and given.dtype == object:
            given = given.tolist()
        #: As make.triangles() takes them.
        self.rows: NDArray[Any] | list[NDArray[Any]] | None = None
        if isinstance(given, (tuple, list)):
            self.rows = rows_of(given, "faces") if given else None
        elif given is not None:
            self.rows = array_of(given, "faces")
        self._parts = [] if self.rows is None else [self.rows] if isinstance(self.rows, np.ndarray) else self.rows

    def are_rows(self) -> bool:
        """Whether each face has corners; None has no faces."""
        if isinstance(self.rows, np.ndarray):
            return self.rows.ndim == 2
        return all(face.ndim == 1 for face in self.rows or [])

    def are_integers(self) -> bool:
        """Whether all are numbers of an integer type."""
        return all(part.dtype.kind in "iu" for part in self._parts)

    def are_whole(self) -> bool:
        """Whether all are whole numbers, of whatever type."""
        return all(
            part.dtype.kind in "iu" or (part.dtype.kind == "f" and bool((part == np.floor(part)).all())) for part in self._parts
        )

    def have_distinct_corners(self) -> bool:
        """Whether no face has a vertex twice; asked of are_rows()."""
        if isinstance(self.rows, np.ndarray):
            corners = np.sort(self.rows, axis=1)
            return not bool((corners[:, 1:] == corners[:, :-1]).any())
        return all(len(np.unique(face)) == len(face) for face in self.rows or [])

    def are_below(self, count: int) -> bool:
        """Whether all are from 0 to `count` - 1."""
        return all(part.size == 0 or (part.min() >= 0 and part.max() < count) for part in self._parts)

    def are_colors(self, count: int) -> bool:
        """Whether these can only be the colours of `count` vertices: floats from 0 to 1, or numbers of 8 bits, which reach few
        of these vertices."""
        if not isinstance(self.rows, np.ndarray) or count == 0 or self.rows.shape not in ((count, 3), (count, 4)):
            return False
        if self.rows.dtype == np.uint8:
            return count > 256
        return self.rows.dtype.kind == "f" and bool(((self.rows >= 0) & (self.rows <= 1)).all())

"""What follows from the bounds of something."""

from abc import ABC, abstractmethod
from typing import Any

import numpy as np
from numpy.typing import NDArray


class Bounded(ABC):
    """Something with bounds."""

    @property
    @abstractmethod
    def bounds(self) -> NDArray[Any]:
        """Lower and upper corner, 2 x 3."""

    @property
    def centroid(self) -> NDArray[Any]:
        """Middle of the bounds."""
        return self.bounds.mean(axis=0)

    @property
    def extents(self) -> NDArray[Any]:
        """Sides of the bounds."""
        return np.diff(self.bounds, axis=0).reshape(-1)

    @property
    def scale(self) -> float:
        """Diagonal of the bounds."""
        return float(np.linalg.norm(self.extents))

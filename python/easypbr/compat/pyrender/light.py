"""Lights: they shine along -z of their node."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ... import _easypbr
from .changes import Noted
from .colors import color as color_of


class Light(Noted):
    """What all lights have: a linear colour (whole numbers: 0 to 255), and an intensity in lux (directional) or candela."""

    intensity: float

    _type = "point"

    def __init__(self, color: ArrayLike | None = None, intensity: float | None = None, name: str | None = None) -> None:
        self.name = name
        self.color = color
        self.intensity = 1.0 if intensity is None else float(intensity)

    @property
    def color(self) -> NDArray[Any]:
        return self._color

    @color.setter
    def color(self, color: ArrayLike | None) -> None:
        self._color = color_of(color, 3, 1.0)

    def made(self, pose: NDArray[Any], casts_shadows: bool) -> "_easypbr.Light":
        """The light of a node with this pose."""
        values: dict[str, Any] = {"color": self.color, "intensity": self.intensity, "casts_shadows": casts_shadows}
        return _easypbr.Light(self._type, **values, **self._placed(pose))

    def _placed(self, pose: NDArray[Any]) -> dict[str, Any]:
        return {"position": pose[:3, 3]}


class DirectionalLight(Light):
    """A light from far away."""

    _type = "directional"

    def _placed(self, pose: NDArray[Any]) -> dict[str, Any]:
        return {"direction": -pose[:3, 2]}


class PointLight(Light):
    """A light at a point; `range`: distance in metres at which nothing is left of it, None: none."""

    def __init__(
        self,
        color: ArrayLike | None = None,
        intensity: float | None = None,
        range: float | None = None,
        name: str | None = None,
    ) -> None:
        super().__init__(color, intensity, name)
        self.range = range

    def _placed(self, pose: NDArray[Any]) -> dict[str, Any]:
        return {"position": pose[:3, 3], "range": self.range or 0}


class SpotLight(Light):
    """A light at a point with a cone; its half angles are in radians."""

    innerConeAngle: float
    outerConeAngle: float

    _type = "spot"

    def __init__(
        self,
        color: ArrayLike | None = None,
        intensity: float | None = None,
        range: float | None = None,
        innerConeAngle: float = 0.0,
        outerConeAngle: float = np.pi / 4,
        name: str | None = None,
    ) -> None:
        super().__init__(color, intensity, name)
        self.range = range
        self.innerConeAngle, self.outerConeAngle = float(innerConeAngle), float(outerConeAngle)

    def _placed(self, pose: NDArray[Any]) -> dict[str, Any]:
        cone = {"inner_cone_deg": np.degrees(self.innerConeAngle), "outer_cone_deg": np.degrees(self.outerConeAngle)}
        return {"position": pose[:3, 3], "direction": -pose[:3, 2], "range": self.range or 0, **cone}

"""Lights of a data set."""

import numpy as np

from .._easypbr import Light
from .poses import draw
from .tables import LightSpec


def _illuminance_of(kind: str, size: float, distance: float) -> float:
    """Illuminance of a surface that faces a light of intensity or radiance 1."""
    half = size / 2
    if kind == "directional":
        return 1.0
    if kind == "point":
        return 1 / distance**2
    if kind == "sphere":
        return np.pi * (half / distance) ** 2
    if kind == "disc":
        return np.pi * half**2 / (half**2 + distance**2)
    # Four quarters of a square (Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-4).
    reach = np.hypot(half, distance)
    return 4 * half / reach * np.arctan(half / reach)


def random_light(given: LightSpec, random: np.random.Generator) -> Light:
    """A light as a specification says, around the origin."""
    azimuth, elevation = np.radians(draw(random, given.azimuth_deg)), np.radians(draw(random, given.elevation_deg))
    towards = np.array([np.cos(elevation) * np.sin(azimuth), np.sin(elevation), np.cos(elevation) * np.cos(azimuth)])
    hue = random.random(3)
    color = 1 + draw(random, given.saturation) * (hue / hue.max() - 1)
    illuminance, distance = draw(random, given.illuminance), draw(random, given.distance)
    light = Light(given.type, color=color)
    size = 0.0
    if given.type in ("rectangle", "disc", "sphere"):
        size = draw(random, given.size)
        light.size, light.radius = (size, size), size / 2
    if given.type != "directional":
        light.position = towards * distance
    if given.type not in ("point", "sphere"):
        light.direction = -towards
    light.intensity = illuminance / _illuminance_of(given.type, size, distance)
    return light

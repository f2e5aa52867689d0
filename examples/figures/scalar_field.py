"""A scalar field on a surface with its colour bar, values beyond a chosen range included. Writes scalar_field.png."""
import pathlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from easypbr import Scene, Viewer, shapes
from figure import main, row, sized


def draw(data: pathlib.Path | None, scale: float) -> NDArray[Any]:
    mesh = shapes.torus(1, 0.42, segments=192, tube_segments=96)
    x, y, z = mesh.V.T
    mesh.scalars["temperature [°C]"] = 20 + 12 * np.sin(3 * np.arctan2(z, x)) * np.cos(4 * y)
    scene = Scene()
    scene.show(mesh, "ring")
    settings = {"camera": {"elevation_deg": 40}, "annotation": {"colorbar": True}}
    lit = Viewer(sized(560, 330, scale), settings, scene).render()
    mesh.style.lit = False
    mesh.style.colormap = "coolwarm"
    mesh.style.color_min, mesh.style.color_max = 12, 28
    return row([lit, Viewer(sized(560, 330, scale), settings, scene).render()])


if __name__ == "__main__":
    main(draw)

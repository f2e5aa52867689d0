"""One field with an own colour map, on a logarithmic scale, and in bands. Writes colormaps.png."""
import pathlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from easypbr import Scene, Viewer, shapes
from figure import main, row, sized


def draw(data: pathlib.Path | None, scale: float) -> NDArray[Any]:
    mesh = shapes.sphere(1.0, 128)
    # Over five powers of ten.
    mesh.scalars["field"] = 10 ** (2.5 * mesh.V[:, 1] * np.cos(4 * mesh.V[:, 0]))
    scene = Scene()
    scene.show(mesh, "ball")
    settings = {"annotation": {"colorbar": True}}
    pictures = []
    looks: list[dict[str, Any]] = [
        {"colormap": "navy,white,maroon", "color_min": 0.01, "color_max": 100},
        {"colormap": "navy,white,maroon", "color_scale": "log"},
        {"colormap": "viridis_r", "color_scale": "log", "color_steps": 5},
    ]
    for look in looks:
        for name, value in look.items():
            setattr(mesh.style, name, value)
        pictures.append(Viewer(sized(370, 300, scale), settings, scene).render())
    return row(pictures)


if __name__ == "__main__":
    main(draw)

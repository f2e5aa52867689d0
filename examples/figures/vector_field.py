"""A flow on a ring: as arrows that are coloured by its speed, and some of its field lines as tubes. Writes vector_field.png."""
import pathlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from easypbr import Mesh, Scene, Viewer, as_mesh, shapes
from figure import main, row, sized


def flow(ring: Mesh) -> NDArray[Any]:
    """Around the ring and around its tube, faster on one side."""
    x, _, z = ring.V.T
    around = np.stack([-z, np.zeros_like(x), x], axis=1) / np.hypot(x, z)[:, None]
    speed = 1.5 + np.sin(np.arctan2(z, x))
    return np.asarray(speed[:, None] * (around + 0.6 * np.cross(around, ring.N)))


def field_line(phase: float) -> Mesh:
    """A line that goes round the tube three times on its way around the ring."""
    t = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    radius = 1 + 0.42 * np.cos(3 * t + phase)
    number = np.arange(len(t))
    line = as_mesh({"V": np.stack([radius * np.cos(t), 0.42 * np.sin(3 * t + phase), radius * np.sin(t)], axis=1),
                    "E": np.stack([number, np.roll(number, -1)], axis=1)})
    line.scalars["speed"] = 1.5 + np.sin(t)
    return line


def draw(data: pathlib.Path | None, scale: float) -> NDArray[Any]:
    ring = shapes.torus(1, 0.42, segments=30, tube_segments=12).remove_duplicate_vertices(keep_seams=False)
    body = shapes.torus(1, 0.41, segments=192, tube_segments=96)
    settings = {"camera": {"elevation_deg": 40}}
    arrows = shapes.arrows(ring.V, flow(ring), scale=0.1)
    arrows.style.scalar = "length"
    left = Scene()
    left.show(body, "ring")
    left.show(arrows, "flow")
    right = Scene()
    for i in range(6):
        right.show(field_line(i * np.pi / 3).to_tubes(0.04), f"line {i}")
    return row([Viewer(sized(560, 330, scale), settings, scene).render() for scene in (left, right)])


if __name__ == "__main__":
    main(draw)

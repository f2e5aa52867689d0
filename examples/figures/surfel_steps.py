"""How a surfel comes about: its basis, the rectangle along it, the ellipse in the rectangle (figure 4 of the paper).

Writes surfel_steps.png.
"""
import pathlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from easypbr import Material, Mesh, Scene, Viewer, shapes
from figure import main, row, sized

normal = np.array([0.35, 0.9, 0.25]) / np.linalg.norm([0.35, 0.9, 0.25])
tangent = np.cross(normal, [0.3, 0, 1])
tangent /= np.linalg.norm(tangent)
bitangent = np.cross(normal, tangent)
length, width = 1.0, 0.6  # semi-axes


def basis() -> dict[str, Mesh]:
    arrows = {}
    for name, direction, color in (("n", normal, "#3060d0"), ("t", tangent * length, "#c03028"),
                                   ("b", bitangent * width, "#2f9040")):
        arrow = shapes.arrow((0, 0, 0), direction, radius=0.025)
        arrow.material = Material(base_color=color, roughness=0.5)
        arrows[name] = arrow
    return arrows


def rectangle() -> Mesh:
    t, b = tangent * length, bitangent * width
    mesh = Mesh([-t - b, t - b, t + b, b - t], [[0, 1, 2], [0, 2, 3]])
    mesh.material = Material(base_color="#c8a15a", roughness=0.6)
    return mesh


def ellipse() -> Mesh:
    """The surfel itself: a point with a normal, a tangent as long as one semi-axis, and the length of the other."""
    surfel = Mesh()
    surfel.assign(V=[[0, 0, 0]], N=[normal], T=[tangent * length], B=[width])
    surfel.material = Material(base_color="#c8a15a", roughness=0.6)
    return surfel


def draw(data: pathlib.Path | None, scale: float) -> NDArray[Any]:
    camera = {"position": (1.2, 2.2, 3.4), "target": (0, 0.12, 0), "fov_y_deg": 31}
    outline = rectangle()
    outline.E = [[0, 1], [1, 2], [2, 3], [3, 0]]
    outline.F = None
    outline.style.mode = "lines"
    outline.style.line_dash = 6
    outline.style.line_color = "#ffffff"
    steps = [basis(), {**basis(), "rectangle": rectangle()}, {"outline": outline, "surfel": ellipse()}]
    pictures = []
    for step in steps:
        scene = Scene()
        for name, mesh in step.items():
            scene.show(mesh, name)
        pictures.append(Viewer(sized(300, 260, scale), {"camera": camera}, scene).render())
    return row(pictures)


if __name__ == "__main__":
    main(draw)

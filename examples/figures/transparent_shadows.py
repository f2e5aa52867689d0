"""Shadows of what lets light through, without and with: panes of three opacities, coloured glass, two panes behind each other.

Writes transparent_shadows.png.
"""
import pathlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from easypbr import Light, Material, Mesh, Scene, Viewer, shapes
from figure import main, sized


def pane(place: tuple[float, float, float], material: Material) -> Mesh:
    """A square that stands upright."""
    mesh = shapes.plane(0.75)
    mesh.rotate_axis_angle((1, 0, 0), 90)
    mesh.translate(place)
    mesh.material = material
    return mesh


def stained(color: str) -> Material:
    return Material(base_color=color, roughness=0, transmission=1)


def draw(data: pathlib.Path | None, scale: float) -> NDArray[Any]:
    scene = Scene()
    floor = shapes.plane(4)
    floor.material = Material(base_color="#d8d4cc", roughness=0.9)
    scene.show(floor, "floor")
    for i, opacity in enumerate((0.25, 0.5, 0.75)):
        scene.show(pane((0.85 * i - 1.5, 0.38, 0.3), Material(base_color="#606060", opacity=opacity)), f"blended {i}")
    scene.show(pane((1.05, 0.38, 0), stained("#f0b030")), "behind")
    scene.show(pane((1.3, 0.38, 0.7), stained("#3080f0")), "before")
    ball = shapes.sphere(0.3, 64)
    ball.translate((-0.3, 0.3, 1.3))
    ball.material = Material(base_color="#60d080", roughness=0, transmission=1, thickness=0.3)
    scene.show(ball, "ball")
    scene.set_light("sun", Light("directional", direction=(-0.35, -1, 0.9), intensity=3, angular_radius_deg=1))
    view = Viewer(sized(480, 300, scale), {"camera": {"azimuth_deg": 12, "elevation_deg": 32},
                                           "environment": {"intensity": 0.3}}, scene)
    pictures = []
    for shadows in (False, True):
        view.settings.shadows.enabled = shadows
        pictures.append(view.render(samples=32)[:, :, :3])
    return np.hstack(pictures)


if __name__ == "__main__":
    main(draw)

"""Figure 6a: what shadows and ambient occlusion add: neither, occlusion alone, shadows alone, both.

Writes shadows_and_occlusion.png.
"""
import pathlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from easypbr import Material, Mesh, Scene, Viewer, shapes
from figure import main, sized


def corner() -> list[Mesh]:
    """A floor, two walls, and some shapes between them."""
    meshes = []
    for shape, place, turn in ((shapes.plane(4), (0, 0, 0), 0), (shapes.plane(4), (0, 2, -2), 90),
                               (shapes.sphere(0.5, 64), (0.4, 0.5, 0.2), 0), (shapes.box(0.8), (-0.8, 0.4, -0.8), 0),
                               (shapes.cylinder(0.3, 1.4), (1.1, 0.7, -1), 0)):
        shape.rotate_axis_angle((1, 0, 0), turn)
        shape.translate(place)
        meshes.append(shape)
    return meshes


def draw(data: pathlib.Path | None, scale: float) -> NDArray[Any]:
    scene = Scene()
    for number, mesh in enumerate([Mesh(data / "room_scene.obj")] if data else corner()):
        mesh.material = Material(base_color="#d8d4cc", roughness=0.9)
        scene.show(mesh, f"mesh {number}")
    view = Viewer(sized(400, 280, scale), {"camera": {"azimuth_deg": 35, "elevation_deg": 28}, "ssao": {"radius": 0.6},
                              "environment": {"intensity": 0.35}, "rays": {"enabled": False}}, scene)
    pictures = []
    for shadows in (False, True):
        for occlusion in (False, True):
            view.settings.shadows.enabled = shadows
            view.settings.ssao.enabled = occlusion
            pictures.append(view.render(samples=32)[:, :, :3])
    return np.vstack([np.hstack(pictures[:2]), np.hstack(pictures[2:])])


if __name__ == "__main__":
    main(draw)

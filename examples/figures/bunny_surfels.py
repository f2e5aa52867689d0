"""A mesh, its vertices as surfels, and a close-up with smaller ones (figure 5 of the paper). Writes bunny_surfels.png.

The bunny where there is data, else a lump. The surfels are made from the positions alone: normals, orientation and
sizes come from each point's neighbours.
"""
import pathlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from easypbr import Material, Mesh, Scene, Viewer, shapes
from figure import main, row, sized


def lump() -> Mesh:
    """A ball with waves."""
    ball = shapes.icosphere(1, 6)
    x, y, z = ball.V.T
    waves = 0.16 * np.sin(4 * x) * np.sin(5 * y) * np.sin(3 * z + 1) + 0.05 * np.sin(9 * x + 7 * z) * np.cos(8 * y)
    return Mesh(ball.V * (1 + waves[:, None]), ball.F)


def surface_of(data: pathlib.Path | None) -> tuple[Mesh, Mesh]:
    """A mesh and a cloud of the same shape."""
    cloud = Mesh()
    if data is not None:
        mesh = Mesh(data / "bunny.ply")
    else:
        mesh = lump()
    cloud.V = mesh.V
    return mesh, cloud


def draw(data: pathlib.Path | None, scale: float) -> NDArray[Any]:
    mesh, cloud = surface_of(data)
    surfels = cloud.estimate_surfels()
    for drawn in mesh, surfels:
        drawn.material = Material(base_color="#d0a060", roughness=0.45)
    # Towards the vertex in the middle of what faces the viewer.
    low, high = mesh.bounding_box()
    size = np.linalg.norm(high - low)
    target = mesh.V[np.argmax(mesh.V @ [0.2, 0.5, 0.84])]
    near = {"position": target + size * np.array([0.05, 0.1, 0.22]), "target": target, "fov_y_deg": 24}
    pictures = []
    for drawn, camera, surfel_scale in ((mesh, {}, 1.0), (surfels, {}, 1.0), (surfels, near, 1.0), (surfels, near, 0.35)):
        drawn.style.surfel_scale = surfel_scale
        scene = Scene()
        scene.show(drawn, "object")
        pictures.append(Viewer(sized(320, 300, scale), {"camera": camera}, scene).render())
    return row(pictures)


if __name__ == "__main__":
    main(draw)

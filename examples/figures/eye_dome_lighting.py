"""A cloud without normals: its colours alone, with eye-dome lighting, with ambient occlusion too (figure 3 of the paper).

Writes eye_dome_lighting.png.
"""
import pathlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from easypbr import Material, Mesh, Scene, Viewer
from figure import main, row, sized
from street import street


def cloud_of(data: pathlib.Path | None) -> tuple[Mesh, dict[str, Any]]:
    if data is not None:
        return Mesh(data / "clouds/lion.ply"), {"up": "z", "azimuth_deg": 150, "elevation_deg": 20}
    cloud = Mesh()
    cloud.V = street().V
    cloud.material = Material(base_color="#d8d4cc")
    return cloud, {"position": (-9, 11, 34), "target": (1, 1, 6)}


def draw(data: pathlib.Path | None, scale: float) -> NDArray[Any]:
    cloud, camera = cloud_of(data)
    scene = Scene()
    scene.show(cloud, "cloud")
    pictures = []
    for eye_dome, occlusion in ((False, False), (True, False), (True, True)):
        settings = {"camera": camera, "edl": {"enabled": eye_dome}, "ssao": {"enabled": occlusion},
                    "points": {"hole_filling": 2}}
        pictures.append(Viewer(sized(420, 340, scale), settings, scene).render())
    return row(pictures)


if __name__ == "__main__":
    main(draw)

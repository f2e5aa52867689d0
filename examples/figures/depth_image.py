"""A depth image as points: from the angles of other content, and by default, from where its camera stood.

Writes depth_image.png.
"""
import pathlib
import tempfile
from typing import Any

import numpy as np
from numpy.typing import NDArray

from easypbr import Material, Mesh, Scene, Viewer, shapes
from figure import main, placed, row, sized


def table() -> Scene:
    """What the depth camera looks at."""
    scene = Scene()
    for name, mesh, color in (("board", shapes.plane(40), "#b08a60"),
                              ("teapot", placed(shapes.teapot(), turn_deg=20, scale=0.7), "#c8503c"),
                              ("ball", placed(shapes.sphere(), x=-1.1, y=0.3, z=0.5, scale=0.35), "#3f72b5"),
                              ("cube", placed(shapes.box(), x=1, y=0.25, z=-0.4, turn_deg=30, scale=0.6), "#4f9a56")):
        mesh.material = Material(base_color=color)
        scene.show(mesh, name)
    return scene


def measured(path: pathlib.Path) -> None:
    """What a depth camera would write: an organised PCD."""
    size = width, height = 640, 480
    view = Viewer(size, {"camera": {"position": (0, 3, 4.5), "target": (0, 0.2, 0)}, "path": {"enabled": False}}, table())
    color = view.render()[:, :, :3].astype(np.uint32)
    depth = view.layers(["depth"])["depth"].astype(np.float32)
    y, x = np.mgrid[0:height, 0:width]
    rays = np.linalg.inv(view.camera.opencv_K(size)) @ np.stack([x.ravel(), y.ravel(), np.ones(x.size)])
    rows = np.empty(x.size, [("xyz", "<f4", 3), ("rgb", "<u4")])
    rows["xyz"] = (rays * depth.ravel()).T
    rows["rgb"] = (color @ np.array([1 << 16, 1 << 8, 1], np.uint32)).ravel()
    header = ("VERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\n"
              f"WIDTH {width}\nHEIGHT {height}\nPOINTS {x.size}\nDATA binary\n")
    path.write_bytes(header.encode() + rows.tobytes())


def draw(data: pathlib.Path | None, scale: float) -> NDArray[Any]:
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "frame.pcd"
        measured(path)
        image = Mesh(path)
    pictures = []
    for camera in ({"azimuth_deg": 30, "elevation_deg": 15}, {}):
        scene = Scene()
        scene.show(image, "frame")
        pictures.append(Viewer(sized(420, 320, scale), {"camera": camera}, scene).render())
    return row(pictures)


if __name__ == "__main__":
    main(draw)

#!/usr/bin/env python3
"""The camera path of figure 10: a path around a statue, drawn as its curve and its cameras, and the video of it.

usage: figure_10_camera_path.py [STATUE] [--z-up] [--video FILE]
Writes camera_path.png, and FILE when it is asked for. STATUE is a mesh file; without one a teapot stands in.
"""
import argparse

import numpy as np

from easypbr import Camera, CameraPath, Material, Mesh, Scene, Viewer, shapes


def statue_on_the_floor(path: str | None, z_up: bool) -> Mesh:
    mesh = Mesh(path) if path else shapes.teapot(1.0)
    if z_up:
        mesh.rotate_axis_angle((1, 0, 0), -90)
    if not path:
        mesh.material = Material(base_color="#c8b89a", roughness=0.6)
    low, high = mesh.bounding_box()
    size = 1.0 / (high[1] - low[1])
    mesh.scale(size)
    mesh.translate((-(low + high) / 2 * (1, 0, 1) - (0, low[1], 0)) * size)
    return mesh


def path_around(radius: float) -> CameraPath:
    """Seven cameras on a rising spiral that look at the statue; the last two come nearer."""
    cameras = []
    for angle, height, part in ((-60, 0.25, 1), (-20, 0.5, 1), (20, 0.9, 1), (65, 1.2, 1.05), (110, 1.3, 1.1),
                                (150, 1.1, 0.95), (185, 0.8, 0.8)):
        turn = np.radians(angle)
        position = (part * radius * np.sin(turn), height, part * radius * np.cos(turn))
        cameras.append(Camera.look_at(position, (0, 0.5, 0), fov_y_deg=35))
    return CameraPath(cameras, segment_s=0.8, ease="in_out")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("statue", nargs="?")
    parser.add_argument("--z-up", action="store_true")
    parser.add_argument("--video")
    arguments = parser.parse_args()
    scene = Scene()
    scene.show(statue_on_the_floor(arguments.statue, arguments.z_up), "statue")
    floor = shapes.plane(6)
    floor.material = Material(base_color="#9a9a9a", roughness=0.8)
    scene.show(floor, "floor")
    path = path_around(2.2)
    view = Viewer((1280, 720), {"style.line_color": "#ff6a00", "style.line_width": 2.5}, scene)
    view.camera = Camera.look_at((3.6, 3.2, 5.2), (0, 0.45, 0), fov_y_deg=32)
    scene.show(shapes.camera_path(path, size=(16, 9), depth=0.35), "path")
    view.recorder.record("camera_path.png")
    if arguments.video:
        scene.hide("path")
        view.recorder.record_path(path, arguments.video, fps=30, samples=4)


if __name__ == "__main__":
    main()

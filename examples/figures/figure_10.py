"""The window with a camera path around a statue, and its panels (figure 10 of the paper). Writes figure_10.png."""
import pathlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from easypbr import Camera, CameraPath, Material, Mesh, Scene, Viewer, shapes
from figure import main, placed, sized

STONE = Material(base_color="#c8b89a", roughness=0.6)


def lathe(radii: NDArray[Any], heights: NDArray[Any], segments: int = 160) -> Mesh:
    """A profile turned about the y axis, closed at its poles, its radius carved by folds that fade upwards."""
    angles = np.linspace(0, 2 * np.pi, segments, endpoint=False)
    folds = 1 + 0.06 * np.sin(11 * angles)[None] * np.clip(1.1 - heights / heights.max(), 0, 1)[:, None] ** 0.5
    rings = radii[:, None] * folds
    V = np.stack([rings * np.cos(angles), np.repeat(heights[:, None], segments, 1), rings * np.sin(angles)], -1)
    row, column = np.meshgrid(np.arange(len(radii) - 1), np.arange(segments), indexing="ij")
    here, right = row * segments + column, row * segments + (column + 1) % segments
    F = np.stack([here, here + segments, right, right, here + segments, right + segments], -1).reshape(-1, 3)
    return Mesh(V.reshape(-1, 3), F)


def figure_of_a_robe() -> Mesh:
    """A robed figure with a head, one high."""
    knots = [(0, 0.24), (0.05, 0.235), (0.3, 0.17), (0.52, 0.12), (0.64, 0.15), (0.76, 0.155), (0.82, 0.06), (0.84, 0.05)]
    heights = np.linspace(0, 0.84, 120)
    radii = np.interp(heights, *np.transpose(knots))
    radii = np.convolve(np.pad(radii, 6, mode="edge"), np.ones(13) / 13, mode="valid")
    head = shapes.sphere(0.08, 64)
    parts = [lathe(radii, heights), placed(Mesh(head.V, head.F), y=0.895)]
    for part in parts:
        part.material = STONE
    return Mesh.merge(*parts)


def statue(data: pathlib.Path | None) -> Mesh:
    """One high, standing on a pedestal's top at 0."""
    mesh = Mesh(data / "bunny.ply") if data else figure_of_a_robe()
    low, high = mesh.bounding_box()
    size = 1 / (high[1] - low[1])
    mesh.scale(size)
    mesh.translate((-(low + high) / 2 * (1, 0, 1) - (0, low[1], 0)) * size)
    if data:
        mesh.material = STONE
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


def draw(data: pathlib.Path | None, scale: float) -> NDArray[Any]:
    scene = Scene()
    scene.show(statue(data), "statue")
    stone = Material(base_color="#8d8d8d", roughness=0.8)
    pedestal = placed(shapes.cylinder(0.42, 0.3, 96), y=-0.15)
    floor = placed(shapes.plane(7), y=-0.3)
    pedestal.material = floor.material = stone
    scene.show(pedestal, "pedestal")
    scene.show(floor, "floor")
    view = Viewer(sized(1280, 760, scale), scene=scene)
    view.camera = Camera.look_at((3.3, 3.4, 5.4), (-0.4, 0.3, 0), fov_y_deg=34)
    view.camera_path = path_around(2.1)
    view.show_panels("Scene", "Camera path", "Recorder")
    return view.screenshot(scale=max(scale, 0.5))[:, :, :3]


if __name__ == "__main__":
    main(draw)

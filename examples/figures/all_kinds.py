"""A mesh, a cloud, surfels, voxels and lines in one scene, whole and cut by a plane. Writes all_kinds.png."""
import pathlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from easypbr import Material, Mesh, Scene, Viewer, shapes
from figure import main, placed, row, sized


def cloud() -> Mesh:
    """Bare points of a ring, coloured by where they are."""
    mesh = Mesh()
    mesh.V = shapes.torus(0.42, 0.17).sample_surface(200_000).subsample(cell_size=0.012).V
    mesh.C = 0.5 + 0.5 * np.sin(6 * mesh.V + [0, 2, 4])
    return mesh


def surfels() -> Mesh:
    mesh = Mesh()
    mesh.V = shapes.icosphere(0.5, 4).sample_surface(4000).V
    mesh = mesh.estimate_surfels()
    mesh.material = Material(base_color="#3a7bbf", roughness=0.3)
    return mesh


def voxels() -> Mesh:
    """The labels of a small volume: shells of a ball, open at one side."""
    place = np.indices((14, 14, 14)).transpose(1, 2, 3, 0) - 6.5
    radius = np.linalg.norm(place, axis=3)
    shown = (radius < 7) & ~((place[..., 0] < 0) & (place[..., 1] > 0) & (place[..., 2] > 0))
    return shapes.voxel_grid(np.where(shown, 1 + radius.astype(int) // 2, 0), origin=(-0.5,) * 3, cell_size=1 / 14)


def camera_with_picture() -> Mesh:
    K = np.array([[40, 0, 31.5], [0, 40, 23.5], [0, 0, 1.0]])
    # Above the grid, looking down at the teapot.
    forward = np.array([-2.0, -1.2, -1.0]) / np.linalg.norm([-2.0, -1.2, -1.0])
    right = np.cross(forward, [0, 1, 0]) / np.linalg.norm(np.cross(forward, [0, 1, 0]))
    T_world_cam = np.eye(4)
    T_world_cam[:3] = np.stack([right, np.cross(forward, right), forward, [-0.4, 1.15, 0.6]], axis=1)
    y, x = np.mgrid[0:48, 0:64]
    picture = np.stack([x * 4, y * 5, 255 - x * 4], axis=2).astype(np.uint8)
    return shapes.camera_frustum((K, T_world_cam), picture, depth=0.4)


def draw(data: pathlib.Path | None, scale: float) -> NDArray[Any]:
    scene = Scene()
    teapot = shapes.teapot(0.75)
    teapot.material = Material(base_color="#b03a2e", roughness=0.25)
    scene.show(placed(teapot, -2.3, 0, 0), "mesh")
    scene.show(placed(cloud(), -0.75, 0.2, 0), "cloud")
    scene.show(placed(surfels(), 0.6, 0.5, 0), "surfels")
    scene.show(placed(voxels(), 1.9, 0.51, 0), "voxels")
    scene.show(camera_with_picture(), "camera")
    scene.show(placed(shapes.grid(6, 12), -0.2, 0, 0), "ground")
    scene.show(placed(shapes.axes(0.6), -2.6, 0, 1.3), "axes")
    camera = {"position": (-0.2, 2.4, 6.6), "target": (-0.2, 0.3, 0.2), "fov_y_deg": 27}
    view = Viewer(sized(640, 330, scale), {"camera": camera}, scene)
    whole = view.render()
    # What lies at n . p + d < 0 is cut: the front half, as far as the middle of all objects.
    view.settings.clip.planes = (0, 0, -1, 0.001)
    return row([whole, view.render()])


if __name__ == "__main__":
    main(draw)

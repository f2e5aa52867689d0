"""What has been changed step by step looks as what is new: nothing of earlier pictures is left."""
import copy
from typing import Any, Callable

import numpy as np
import pytest

import easypbr
from easypbr import Mesh, Scene, Viewer, shapes

SIZE = (64, 48)


def random_points(count: int = 40) -> np.ndarray:
    return np.random.default_rng(0).normal(size=(count, 3)).astype(np.float32) * 0.4


def lines() -> Mesh:
    mesh = Mesh()
    mesh.assign(V=random_points(), E=np.arange(40).reshape(20, 2), L=np.arange(40) % 5)
    return mesh


def surfels() -> Mesh:
    points = random_points()
    normal, tangent = np.tile([0, 0, 1], (40, 1)), np.tile([0.2, 0, 0], (40, 1))
    mesh = Mesh()
    mesh.assign(V=points, N=normal, T=tangent, B=np.full(40, 0.1), L=np.arange(40) % 5)
    return mesh


def splats() -> Mesh:
    mesh = easypbr.splats(random_points(), scales=0.1, opacities=np.full(40, 0.9), colors=np.full((40, 3), 0.5))
    mesh.L = np.arange(40) % 5
    return mesh


def require_as_new(scene: Scene, values: dict[str, Any], change: Callable[[], None]) -> None:
    view = Viewer(SIZE, values, scene=scene)
    before = view.render(samples=1)
    change()
    changed = view.render(samples=1)
    new = Viewer(SIZE, view.settings.to_dict(), scene=scene).render(samples=1)
    assert (before != new).any(), "the change is not seen at all"
    np.testing.assert_array_equal(changed, new)


def new_edges(mesh: Mesh) -> None:
    mesh.E = np.array([[0, 1]])


def new_tangents(mesh: Mesh) -> None:
    mesh.T = np.array(mesh.T) * 2


def new_bitangents(mesh: Mesh) -> None:
    mesh.B = np.array(mesh.B) * 2


def new_opacities(mesh: Mesh) -> None:
    mesh.opacities = np.full(40, 0.3)


@pytest.mark.parametrize("make, change", [(lines, new_edges), (surfels, new_tangents), (surfels, new_bitangents),
                                          (splats, new_opacities)])
def test_arrays_of_objects_that_data_colour(make: Callable[[], Mesh], change: Callable[[Mesh], None]) -> None:
    mesh = make()
    scene = Scene()
    scene.show(mesh, "a")
    require_as_new(scene, {"style.line_width": 3}, lambda: change(mesh))


def new_normals(mesh: Mesh) -> None:
    mesh.N = -np.array(mesh.N)[:, [1, 2, 0]]


@pytest.mark.parametrize("make, change", [(lambda: shapes.sphere(0.5, 16), new_normals), (surfels, new_tangents),
                                          (surfels, new_normals)])
def test_arrays_of_objects_that_are_cut(make: Callable[[], Mesh], change: Callable[[Mesh], None]) -> None:
    mesh = make()
    scene = Scene()
    scene.show(mesh, "a")
    require_as_new(scene, {"clip.planes": (1, 0, 0, 0.1)}, lambda: change(mesh))


@pytest.mark.parametrize("values", [{}, {"rays.enabled": True}])
def test_occlusion_of_earlier_frames(values: dict[str, Any]) -> None:
    cloud = Mesh()
    cloud.V = random_points()
    scene = Scene()
    scene.show(shapes.box(), "box")
    scene.show(cloud, "cloud")
    view = Viewer(SIZE, scene=scene)
    view.render(samples=1)
    view.settings.update(values)
    for picture in (view.render(samples=4), view.render(samples=4)):
        new = Viewer(SIZE, view.settings.to_dict(), scene=scene).render(samples=4)
        np.testing.assert_array_equal(picture, new)


def test_ground_below_voxels_that_grow() -> None:
    mesh = Mesh()
    mesh.V = np.array([[0, 0, 0], [1, 1, 1]], np.float32)
    mesh.style.mode = "voxels"
    mesh.style.voxel_size = 0.1
    scene = Scene()
    scene.show(mesh, "a")
    view = Viewer(SIZE, {"ground.mode": "plane"}, scene=scene)
    view.render(samples=1)
    mesh.style.voxel_size = 0.4
    view.render(samples=1)
    height = view.settings.resolve("ground.height")
    # Just below the lower faces, by 1e-4 of the content's size.
    assert -0.201 < height < -0.2


def test_automatic_values_are_copied() -> None:
    view = Viewer(SIZE)
    values = {"camera.position": view.settings.camera.position, "style.point_size": easypbr.auto,
              "camera.target": easypbr.follow}
    assert copy.deepcopy(values) == values == copy.copy(values)

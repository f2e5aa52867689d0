"""Coordinates far from zero: kept in double precision by an offset."""

import numpy as np
import pytest

from easypbr import Mesh, Scene

UTM = np.array([691_000.125, 5_335_000.25, 520.5])


@pytest.fixture
def grid():
    x, y = np.meshgrid(np.arange(20) * 5.0, np.arange(20) * 5.0)
    return UTM + np.stack([x.ravel(), y.ravel(), np.arange(400) * 0.001], 1)


def test_float64_positions_keep_millimetres(grid):
    mesh = Mesh()
    mesh.V = grid
    assert mesh.V.dtype == np.float32 and np.abs(mesh.V).max() < 128
    # Half the spacing of float32 numbers up to 128.
    np.testing.assert_allclose(mesh.offset + mesh.V, grid, rtol=0, atol=2.0**-18)
    assert np.abs(grid.astype(np.float32) - grid).max() > 0.1, "what float32 alone would lose"


def test_integers_and_constructor(grid):
    whole = np.round(grid * 1000).astype(np.int64)
    mesh = Mesh(whole, np.array([[0, 1, 2]]))
    # 100 m are 100,000 mm: half the spacing below 2^17.
    np.testing.assert_allclose(mesh.offset + mesh.V, whole, rtol=0, atol=2.0**-8)


def test_float32_positions_are_taken_as_they_are(grid):
    mesh = Mesh()
    mesh.V = grid.astype(np.float32)
    np.testing.assert_array_equal(mesh.V, grid.astype(np.float32))
    np.testing.assert_array_equal(mesh.offset, 0)


def test_assigned_positions_are_local(grid):
    mesh = Mesh()
    mesh.V = grid
    offset = mesh.offset
    mesh.V = mesh.V * 2
    np.testing.assert_array_equal(mesh.offset, offset)
    with mesh.edit("V") as v:
        v += 1
    np.testing.assert_array_equal(mesh.offset, offset)
    mesh.assign(V=grid + 1000, offset=(0, 0, 0))
    np.testing.assert_allclose(mesh.offset + mesh.V, grid + 1000, rtol=0, atol=2.0**-18)
    mesh.offset = [1, 2, 3]
    np.testing.assert_array_equal(mesh.offset, [1, 2, 3])
    for bad in ([1, 2], [np.nan, 0, 0], "far"):
        with pytest.raises(ValueError, match="offset"):
            mesh.offset = bad


def test_saved_files_give_it_back(grid, tmp_path):
    mesh = Mesh()
    mesh.V = grid
    for name in ("far.ply", "far.obj"):
        mesh.save(tmp_path / name)
        back = Mesh(tmp_path / name)
        np.testing.assert_array_equal(back.offset, mesh.offset)
        np.testing.assert_array_equal(back.V, mesh.V)


def test_scene_has_an_origin(grid):
    scene = Scene()
    np.testing.assert_array_equal(scene.origin, 0)
    mesh = Mesh()
    mesh.V = grid
    scene.show(mesh, "cloud")
    np.testing.assert_array_equal(scene.origin, mesh.offset)
    scene.origin = UTM
    np.testing.assert_array_equal(scene.origin, UTM)
    with pytest.raises(ValueError, match="origin"):
        scene.origin = (0, 0, np.inf)


def test_points_of_geometry_functions_include_the_offset() -> None:
    utm = np.array([691000.0, 5335000.0, 520.0])
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    mesh = Mesh(utm + square, [[0, 1, 2], [0, 2, 3]])
    np.testing.assert_allclose(mesh.bounding_box(), utm + [[0, 0, 0], [1, 1, 0]], atol=1e-6)
    assert len(mesh.crop_box(*mesh.bounding_box()).V) == 4
    distance, face, point = mesh.closest_points(utm + [[0.75, 0.25, 2]])
    np.testing.assert_allclose(distance, [2], atol=1e-6)
    np.testing.assert_allclose(point, utm + [[0.75, 0.25, 0]], atol=1e-6)
    assert face[0] == 0


def test_normals_turn_to_a_viewpoint_far_from_zero() -> None:
    utm = np.array([691000.0, 5335000.0, 520.0])
    grid = np.stack(np.meshgrid(np.arange(20.0), np.arange(20.0), [0.0], indexing="ij"), -1).reshape(-1, 3)
    for side in (1, -1):
        normals = Mesh(utm + grid).estimate_normals(viewpoint=utm + [10, 10, side * 5]).N
        np.testing.assert_allclose(normals, np.tile([0, 0, side], (400, 1)), atol=1e-5)

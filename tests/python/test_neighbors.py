import numpy as np
import pytest

import easypbr
from easypbr import KdTree, Mesh, shapes


def cloud(V):
    mesh = Mesh()
    mesh.V = V
    return mesh


def ball(count, seed=0):
    V = np.random.default_rng(seed).normal(size=(count, 3))
    return V / np.linalg.norm(V, axis=1, keepdims=True)


def test_nearest_is_what_trying_all_finds():
    random = np.random.default_rng(1)
    points, queries = random.random((500, 3)).astype(np.float32), random.random((20, 3)).astype(np.float32)
    distances, indices = KdTree(points).nearest(queries, k=5)
    all_distances = np.linalg.norm(points[None] - queries[:, None], axis=2)
    np.testing.assert_array_equal(indices, np.argsort(all_distances, axis=1)[:, :5])
    np.testing.assert_allclose(distances, np.sort(all_distances, axis=1)[:, :5], rtol=1e-5)
    assert distances.dtype == np.float32 and indices.dtype == np.int32
    assert KdTree(points).nearest(queries)[1].shape == (20, 1) and len(KdTree(points)) == 500


def test_within_gives_offsets():
    distances, indices, offsets = KdTree([[0, 0, 0], [3, 4, 0], [9, 0, 0]]).within([[0, 0, 0], [50, 0, 0]], 5)
    np.testing.assert_array_equal(offsets, [0, 2, 2])
    np.testing.assert_array_equal(indices, [0, 1])
    np.testing.assert_array_equal(distances, [0, 5])


@pytest.mark.parametrize("where", [(5e5, 5.4e6, 300), (-1e4, 0, 0), (1000, 0, 0)])
@pytest.mark.parametrize("extent", [1.0, 1e-3])
def test_points_far_from_zero_are_told_apart(where, extent):
    points = np.array(where) + extent * np.random.default_rng(3).random((1000, 3))
    queries = points[:20] + 0.01 * extent
    all_distances = np.linalg.norm(points[None] - queries[:, None], axis=2)
    distances, indices = KdTree(points).nearest(queries, k=2)
    # The coordinates themselves are rounded to 2^-53 of 5.4e6, which is 6e-10, and what is left to float32.
    np.testing.assert_allclose(distances, np.sort(all_distances, axis=1)[:, :2], atol=2e-9 + 1e-6 * extent)
    if extent == 1:
        np.testing.assert_array_equal(indices, np.argsort(all_distances, axis=1)[:, :2])
    found, _, offsets = KdTree(points).within(queries, 0.2 * extent)
    np.testing.assert_allclose(np.diff(offsets), (all_distances < 0.2 * extent).sum(axis=1), atol=1)
    assert found.max() <= np.float32(0.2 * extent)


def test_queries_of_another_type_than_the_points_keep_their_precision():
    points = np.array([[5e5, 5.4e6, 0], [5e5 + 1, 5.4e6, 0], [5e5 + 2, 5.4e6, 0]])
    query = [[5e5 + 0.25, 5.4e6, 0]]
    for given in (points, points.astype(np.int64), points.astype(np.float32)):  # All of them hold these exactly.
        distances, indices = KdTree(given).nearest(query, k=3)
        np.testing.assert_array_equal(distances, [[0.25, 0.75, 1.75]])
        np.testing.assert_array_equal(indices, [[0, 1, 2]])


def test_a_stray_point_does_not_decide_the_precision():
    points = np.array([5e5, 5.4e6, 300]) + np.random.default_rng(4).random((1000, 3))
    points[7] = 0
    distances, indices = KdTree(points).nearest(points, k=1)
    np.testing.assert_array_equal(indices[:, 0], np.arange(1000))
    assert (distances[np.arange(1000) != 7] == 0).all()


@pytest.mark.parametrize("call, message", [
    (lambda: KdTree(np.zeros((0, 3))), "at least one point"),
    (lambda: KdTree(np.zeros((5, 2))), "expected n x 3, got 5 x 2"),
    (lambda: KdTree([[0, np.nan, 0]]), "expected finite points"),
    (lambda: KdTree(np.zeros((5, 3))).nearest(np.zeros((1, 3)), k=6), "from 1 to 5, got 6"),
    (lambda: KdTree(np.zeros((5, 3))).within(np.zeros((1, 3)), np.nan), "radius"),
])
def test_questions_without_an_answer_raise(call, message):
    with pytest.raises(easypbr.ArgumentError, match=message):
        call()


def test_normals_of_a_ball_point_outwards_or_to_the_viewpoint():
    mesh = cloud(ball(5000))
    estimated = mesh.estimate_normals(k=12)
    assert mesh.N.shape == (0, 3), "the mesh itself stays as it was"
    assert ((estimated.N * estimated.V).sum(axis=1) > 0.99).all()
    inwards = mesh.estimate_normals(viewpoint=(0, 0, 0))
    assert ((inwards.N * inwards.V).sum(axis=1) < -0.99).all()


def test_surfels_are_perpendicular_ellipses():
    surfels = cloud(ball(5000)).estimate_surfels()
    assert np.abs((surfels.N * surfels.T).sum(axis=1)).max() < 1e-6
    radii = np.linalg.norm(surfels.T, axis=1)
    # 5000 ellipses of area pi a b cover 4 pi at least once, and with random points not more than some times.
    covered = (np.pi * radii * surfels.B).sum() / (4 * np.pi)
    assert 1 < covered < 3
    kept = shapes.sphere().estimate_surfels(keep_normals=True)
    np.testing.assert_allclose(kept.N, shapes.sphere().N, atol=1e-6)


def test_surfels_of_a_mesh_keep_its_normals():
    ball = shapes.icosphere(1, 3)
    surfels = ball.to_surfels()
    np.testing.assert_array_equal(surfels.N, ball.N)
    assert len(surfels.F) == 0 and len(ball.F) == 1280
    assert len(surfels.T) == len(surfels.B) == len(ball.V)


@pytest.mark.parametrize("V, options, message", [
    (np.zeros((0, 3)), {}, "expected a mesh with vertices"),
    (np.zeros((1, 3)), {}, "at least 3 different points, got 1 in 1"),
    (np.ones((9, 3)), {}, "at least 3 different points, got 1 in 9"),
    (np.eye(3), dict(k=2), "k: expected a whole number from 3 to 256, got 2"),
    (np.eye(3), dict(viewpoint=(0, 0)), "viewpoint: expected 3 numbers"),
    (np.eye(3), dict(viewpoint=(0, 0, np.inf)), "viewpoint: expected finite numbers"),
])
def test_what_is_no_surface_raises(V, options, message):
    for method in ("estimate_normals", "estimate_surfels"):
        with pytest.raises(easypbr.ArgumentError, match=message):
            getattr(cloud(V), method)(**options)
    with pytest.raises(easypbr.ArgumentError, match="expected a mesh with faces"):
        cloud(V).to_surfels()


def test_more_neighbors_than_points_are_all_of_them():
    assert np.allclose(np.abs(cloud(np.eye(3)).estimate_normals(k=50).N), 3**-0.5)

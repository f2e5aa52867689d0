"""Rays against meshes, line of sight, inside and outside, what a camera sees."""

import numpy as np
import pytest

import easypbr
from easypbr import Camera, Mesh, RayTree, Scene, shapes

UTM = np.array([500_000.0, 5_400_000.0, 300.0])
NAN = float("nan")


def moved(mesh, by):
    T = np.eye(4)
    T[:3, 3] = by
    mesh.T_parent_mesh = T
    return mesh


def test_a_box_is_met_where_its_faces_are():
    tree = RayTree(shapes.box(1))
    hits = tree.cast([[0.1, 0.2, 5], [0.1, 0.2, 0.3], [0.6, 0, 5]], [[0, 0, -3], [0.01, 0, 0], [0, 0, -1]])
    assert isinstance(hits, easypbr.RayHits)
    np.testing.assert_allclose(hits.distances, [4.5, 0.4, np.inf], atol=1e-13)
    np.testing.assert_allclose(hits.points[:2], [[0.1, 0.2, 0.5], [0.5, 0.2, 0.3]], atol=1e-13)
    np.testing.assert_allclose(hits.normals[:2], [[0, 0, 1], [1, 0, 0]], atol=1e-13)
    assert hits.faces[2] == -1 and np.isnan(hits.points[2]).all() and np.isnan(hits.barycentric[2]).all()
    assert hits.faces.dtype == np.int32 and hits.distances.dtype == np.float64 and len(tree) == 12
    box = shapes.box(1)
    corners = box.V[box.F[hits.faces[:2]]].astype(float)
    np.testing.assert_allclose((hits.barycentric[:2, :, None] * corners).sum(axis=1), hits.points[:2], atol=1e-13)


def test_the_largest_distance_and_one_row_for_all():
    tree = RayTree(shapes.box(1))
    directions = [[0, 0, -2], [0, 0, 1]]
    np.testing.assert_array_equal(tree.cast((0, 0, 2.5), directions).distances, [2, np.inf])
    np.testing.assert_array_equal(tree.cast((0, 0, 2.5), directions, max_distance=2).faces >= 0, [True, False])
    np.testing.assert_array_equal(tree.cast((0, 0, 2.5), directions, max_distance=1.9).faces, [-1, -1])
    np.testing.assert_array_equal(tree.occluded((0, 0, 2), [[0, 0, 1], [0, 0, -2]]), [False, True])
    assert tree.cast(np.zeros((0, 3)), np.zeros((0, 3))).points.shape == (0, 3)
    assert tree.contains(np.zeros((0, 3))).shape == (0,)


def test_nothing_leaves_a_closed_mesh():
    ball = shapes.icosphere(1, 3)
    V = ball.V.astype(float)
    edges = np.vstack([V[ball.F[:, [0, 1]]].mean(axis=1), V[ball.F[:, [1, 2]]].mean(axis=1), V])
    origin = np.array([0.1, -0.2, 0.3])
    hits = RayTree(ball).cast(origin, edges - origin)
    np.testing.assert_allclose(hits.distances, np.linalg.norm(edges - origin, axis=1), atol=1e-12)


def test_contains_is_the_sign_of_the_distance():
    torus = shapes.torus(1, 0.4)
    points = np.random.default_rng(1).uniform(-1.5, 1.5, (2000, 3))
    ring = np.hypot(np.hypot(points[:, 0], points[:, 2]) - 1, points[:, 1]) - 0.4
    clear = np.abs(ring) > 0.01  # Tessellation of 64 and 32 parts is 0.0036 off at most.
    inside = RayTree(torus).contains(points)
    assert inside.dtype == bool
    np.testing.assert_array_equal(inside[clear], ring[clear] < 0)


def test_poses_children_and_several_meshes():
    parent = moved(shapes.box(1), (10, 0, 0))
    parent.add_child(moved(shapes.box(1), (0, 0, 3)))
    for content in (parent, [moved(shapes.box(1), (10, 0, 0)), moved(shapes.box(1), (10, 0, 3))]):
        hits = RayTree(content).cast([[10, 0, 9], [10, 0, -9], [0, 0, 9]], [[0, 0, -1], [0, 0, 1], [0, 0, -1]])
        np.testing.assert_allclose(hits.distances, [5.5, 8.5, np.inf], atol=1e-12)
        assert hits.faces[0] >= 12 > hits.faces[1] >= 0


def test_coordinates_far_from_zero():
    box = shapes.box(1)
    V = box.V.astype(float) + UTM
    tree = RayTree((V, box.F))
    hits = tree.cast(UTM + (0.1, 0.2, 5), [[0, 0, -1]])
    # float64 numbers of 5.4e6 are 9.3e-10 apart.
    np.testing.assert_allclose(hits.distances, [4.5], atol=2e-9)
    np.testing.assert_allclose(hits.points, [UTM + (0.1, 0.2, 0.5)], rtol=0, atol=2e-9)
    np.testing.assert_array_equal(tree.contains(UTM + [[0, 0, 0], [0.501, 0, 0]]), [True, False])
    assert tree.occluded(UTM - (2, 0, 0), UTM + (2, 0, 0)).tolist() == [True]


def test_vertices_that_a_point_and_a_camera_see():
    box = shapes.box(1)
    # The only corner of a box that is not seen from beyond the opposite one.
    far = (box.V < 0).all(axis=1)
    seen = box.visible_from((5, 4, 3))
    assert seen.dtype == bool and far.sum() == 3
    np.testing.assert_array_equal(seen, ~far)
    camera = Camera.look_at((5, 4, 3), (0, 0, 0))
    np.testing.assert_array_equal(box.visible_from(camera, (320, 240)), ~far)
    away = Camera.look_at((5, 4, 3), (9, 9, 9))
    assert not box.visible_from(away).any()
    aside = Camera.look_at((5, 4, 3), (5, 4, 0))
    assert box.visible_from(aside).any() and not box.visible_from(aside, (64, 64)).any()
    # At depth 1 a unit is 100 pixels, and the principal point is 51 from the corner: the plane goes from 1 to 101.
    plane = shapes.plane(1)
    for width, expected in ((102, 4), (100, 2)):
        K = [[100, 0, 50.5], [0, 100, 50.5], [0, 0, 1]]
        T = np.array([[1.0, 0, 0, 0], [0, 0, -1, 1], [0, 1, 0, 0], [0, 0, 0, 1]])
        assert plane.visible_from(Camera.from_opencv(K, T, (width, 102)), (width, 102)).sum() == expected


def test_the_near_plane_is_inferred_unless_it_is_given():
    ball = shapes.icosphere(0.001, 3)
    camera = Camera.look_at((0, 0, 0.004), (0, 0, 0))
    seen = ball.visible_from((0, 0, 0.004))
    assert camera.near == 0.01 and 0 < seen.sum() < len(ball.V) / 2
    np.testing.assert_array_equal(ball.visible_from(camera), seen)
    # Beyond the foremost vertex, which is 0.003 away: the rest of the ball is open.
    cut = ball.visible_from(camera, near=0.0035)
    np.testing.assert_array_equal(cut & (ball.V[:, 2] > 0.0005), False)
    assert cut.sum() > seen.sum()


def test_a_camera_of_a_scene_far_from_zero():
    box = Mesh(shapes.box(1).V.astype(float) + UTM, shapes.box(1).F)
    scene = Scene()
    scene.show(box, "box")
    camera = Camera.look_at(UTM - scene.origin + (5, 4, 3), UTM - scene.origin)
    far = (box.V + box.offset - UTM < 0).all(axis=1)
    np.testing.assert_array_equal(box.visible_from(UTM + (5, 4, 3)), ~far)
    np.testing.assert_array_equal(box.visible_from(camera, (64, 64)), ~far)
    np.testing.assert_array_equal(box.visible_from(camera, (64, 64), scene.origin), ~far)
    scene.origin = UTM - (100, 0, 0)
    camera = Camera.look_at((105, 4, 3), (100, 0, 0))
    np.testing.assert_array_equal(box.visible_from(camera, (64, 64), origin=scene.origin), ~far)


@pytest.mark.parametrize("call, message", [
    (lambda: RayTree(np.zeros((5, 3))), "expected a mesh with faces, got .* with 5 vertices and 0 faces"),
    (lambda: Mesh(np.zeros((5, 3)), np.zeros((0, 3), int)).visible_from((0, 0, 1)), "expected a mesh with faces"),
    (lambda: RayTree(object()), "expected"),
    (lambda: RayTree(shapes.box()).cast([[0, 0]], [[0, 0, 1]]), "origins: expected n x 3, got 1 x 2"),
    (lambda: RayTree(shapes.box()).cast([[0, 0, 0]], [[0, 0, 0]]), "directions other than zero, got zero in row 0 of 1"),
    (lambda: RayTree(shapes.box()).cast([[0, NAN, 0]], [[0, 0, 1]]), "finite origins, got .0, nan, 0. in row 0 of 1"),
    (lambda: RayTree(shapes.box()).cast([[0, 0, 0]], [[0, 0, NAN]]), "finite directions"),
    (lambda: RayTree(shapes.box()).cast(np.zeros((3, 3)), np.ones((2, 3))), "got 3 and 2"),
    (lambda: RayTree(shapes.box()).cast([[0, 0, 0]], [[0, 0, 1]], -1), "max_distance: expected a number >= 0, got -1"),
    (lambda: RayTree(shapes.box()).occluded(np.zeros((3, 3)), np.ones((2, 3))), "got 3 and 2"),
    (lambda: RayTree(shapes.box()).contains([[NAN, 0, 0]]), "finite points"),
    (lambda: shapes.box().visible_from((0, 0)), "viewpoint: expected 3 numbers"),
    (lambda: shapes.box().visible_from((0, 0, 5), (64, 64)), "with a Camera alone"),
    (lambda: shapes.box().visible_from((0, 0, 5), near=1), "with a Camera alone"),
    (lambda: shapes.box().visible_from(Camera(), near=0), "camera: near: expected a number > 0, got 0"),
    (lambda: shapes.box().visible_from(Camera(), (0, 64)), "at least 1x1, got 0x64"),
])
def test_questions_without_an_answer_raise(call, message):
    with pytest.raises(easypbr.ArgumentError, match=message):
        call()

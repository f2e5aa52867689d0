"""Methods of Mesh that make and measure geometry. They give new meshes; the mesh itself stays as it was."""
import threading

import numpy as np
import pytest

import easypbr
from easypbr import Mesh, shapes

NAN = float("nan")


def cloud(V, **arrays):
    mesh = Mesh()
    mesh.assign(V=V, **arrays)
    return mesh


def corners(mesh):
    return (mesh.V[mesh.F[:, k]].astype(np.float64) for k in range(3))


def area(mesh):
    a, b, c = corners(mesh)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def volume(mesh):
    a, b, c = corners(mesh)
    return (a * np.cross(b, c)).sum() / 6


def pose(x=0.0, y=0.0, z=0.0, scale=1.0):
    T = np.diag([scale, scale, scale, 1.0])
    T[:3, 3] = x, y, z
    return T


def test_transform_center_and_size():
    box = shapes.box((1, 2, 4))
    moved = box.transform(pose(10, 0, 0, scale=2))
    np.testing.assert_allclose(moved.bounding_box(), [[9, -2, -4], [11, 2, 4]])
    np.testing.assert_allclose(box.bounding_box(), [[-0.5, -1, -2], [0.5, 1, 2]])
    np.testing.assert_allclose(moved.center().bounding_box(), [[-1, -2, -4], [1, 2, 4]])
    np.testing.assert_allclose(moved.center().normalize_size(1).bounding_box(), [[-0.125, -0.25, -0.5], [0.125, 0.25, 0.5]])
    mirrored = box.transform(np.diag([-1, 1, 1, 1]))
    assert volume(mirrored) == pytest.approx(8)


def test_bounding_box_is_right_under_rotation():
    ball = shapes.icosphere(1, 5)
    turn = np.eye(4)
    turn[:2, :2] = np.array([[1, -1], [1, 1]]) / np.sqrt(2)
    ball.T_parent_mesh = turn
    np.testing.assert_allclose(ball.bounding_box(), [[-1] * 3, [1] * 3], atol=2e-3)
    np.testing.assert_allclose(ball.bounding_box(pose(5)), [[4, -1, -1], [6, 1, 1]], atol=2e-3)
    box = shapes.box((1, 2, 3)).transform(turn)
    T, size = box.oriented_bounding_box()
    np.testing.assert_allclose(size, [3, 2, 1], atol=1e-5)
    inside = (np.linalg.inv(T) @ np.c_[box.V, np.ones(len(box.V))].T)[:3].T
    np.testing.assert_allclose(np.abs(inside), [[1.5, 1, 0.5]] * len(inside), atol=1e-5)


def test_merge_keeps_materials_and_fills_in():
    red, ball = shapes.box(), shapes.sphere()
    red.material.base_color = (1, 0, 0)
    red.C = np.zeros((24, 3))
    red.T_parent_mesh = pose(3)
    both = red.merge(ball)
    assert len(both.F) == len(red.F) + len(ball.F)
    assert both.materials[0].base_color == (1, 0, 0) and len(both.materials) == 2
    np.testing.assert_array_equal(both.V[:24].max(axis=0), [3.5, 0.5, 0.5])
    # The grey of a default material: sRGB of 0.6, 1.055 * 0.6^(1/2.4) - 0.055.
    np.testing.assert_allclose(both.C[24:], 0.79774, atol=1e-5)
    three = Mesh.merge(*[shapes.box()] * 3)
    assert len(three.V) == 72 and len(three.materials) == 1
    with pytest.raises(easypbr.ArgumentError, match="expected meshes"):
        red.merge("ball")


def test_merge_makes_children_part_of_one_mesh(tmp_path):
    parent, child = Mesh(), shapes.box()
    child.T_parent_mesh = pose(7)
    parent.add_child(child)
    with pytest.raises(easypbr.ArgumentError, match="merge.. makes its children part of it"):
        parent.decimate(faces=4)
    assert len(parent.merge().F) == 12 and parent.merge().bounding_box()[1, 0] == 7.5


def test_repair():
    box = shapes.box()
    assert len(box.remove_duplicate_vertices().V) == 24
    welded = box.remove_duplicate_vertices(keep_seams=False)
    assert len(welded.V) == 8 and volume(welded) == pytest.approx(1)
    assert volume(welded.flip_winding()) == pytest.approx(-1)
    np.testing.assert_array_equal(box.flip_normals().N, -box.N)
    near = cloud([[0, 0, 0], [0.01, 0, 0], [1, 0, 0]])
    assert len(near.remove_duplicate_vertices(tolerance=0.1).V) == 2
    loose = Mesh([[0, 0, 0], [5, 5, 5], [1, 0, 0], [0, 1, 0], [2, 0, 0]], [[0, 2, 3], [0, 2, 4]])
    assert len(loose.remove_unreferenced_vertices().V) == 4
    assert len(loose.remove_degenerate_faces().F) == 1


def test_pieces():
    both = shapes.box().merge(shapes.sphere().transform(pose(5)))
    assert set(both.vertex_components()) == {0, 1}
    assert (both.face_components() == np.repeat([0, 1], [12, len(shapes.sphere().F)])).all()
    pieces = both.split()
    assert [len(piece.F) for piece in pieces] == [12, len(shapes.sphere().F)]
    np.testing.assert_array_equal(pieces[0].V, shapes.box().V)


def test_subsample_and_voxelize():
    V = np.random.default_rng(0).random((10000, 3))
    mesh = cloud(V, I=np.arange(10000))
    assert len(mesh.subsample(1234).V) == 1234
    some = mesh.subsample(fraction=0.25, seed=3)
    assert len(some.V) == 2500
    np.testing.assert_array_equal(mesh.V[some.I.astype(int)], some.V)
    cells = mesh.subsample(cell_size=0.25)
    assert len(cells.V) == 64
    key = np.floor(mesh.V / np.float32(0.25)).astype(int)
    first = mesh.V[(key == key[0]).all(axis=1)]
    np.testing.assert_allclose(cells.V[0], first.mean(axis=0), atol=1e-6)
    voxels = mesh.voxelize(0.5)
    assert sorted(map(tuple, voxels.V)) == [(x, y, z) for x in (0.25, 0.75) for y in (0.25, 0.75) for z in (0.25, 0.75)]


def test_decimate_upsample_smooth():
    ball = shapes.icosphere(1, 4)
    simple = ball.decimate(faces=500)
    assert 490 <= len(simple.F) <= 500
    assert len(ball.decimate(error=0.05).F) < len(ball.decimate(error=0.005).F) < len(ball.F)
    assert len(ball.upsample().F) == 4 * len(ball.F)
    assert area(shapes.box().upsample(2)) == pytest.approx(6)
    assert volume(shapes.box().upsample(2, method="loop")) < 0.7
    assert volume(ball.smooth(20, method="laplacian")) < 0.99 * volume(ball)
    assert volume(ball.smooth(20)) == pytest.approx(volume(ball), rel=0.005)


def test_normals():
    ball = shapes.icosphere(2, 3)
    np.testing.assert_allclose(ball.vertex_normals(), ball.V / 2, atol=0.01)
    a, b, c = corners(ball)
    n = np.cross(b - a, c - a)
    np.testing.assert_allclose(ball.face_normals(), n / np.linalg.norm(n, axis=1, keepdims=True), atol=1e-6)


def test_sample_surface_is_uniform():
    points = shapes.box((1, 1, 2)).sample_surface(10000, seed=1)
    assert points.N.shape == points.V.shape == (10000, 3) and points.UV.shape == (10000, 2)
    # Areas of the sides across x, y and z: 4, 4 and 2.
    across = np.abs(points.N).argmax(axis=1)
    np.testing.assert_allclose(np.bincount(across) / 10000, [0.4, 0.4, 0.2], atol=0.001)
    np.testing.assert_array_equal(points.V, shapes.box((1, 1, 2)).sample_surface(10000, seed=1).V)


def test_distances():
    plane = shapes.plane(2)
    distances, faces, points = plane.closest_points([[0, 3, 0], [2, 0, 0.5]])
    np.testing.assert_allclose(distances, [3, 1])
    np.testing.assert_allclose(points, [[0, 0, 0], [1, 0, 0.5]])
    assert set(faces) <= {0, 1}
    far = shapes.plane(2)
    far.T_parent_mesh = pose(0, 0.5, 0)
    assert far.distance_to(plane) == pytest.approx({"max": 0.5, "mean": 0.5, "rms": 0.5})
    large = shapes.plane(4)
    assert plane.distance_to(large)["max"] == pytest.approx(0, abs=1e-7)
    assert plane.hausdorff_distance(large) == pytest.approx(np.sqrt(2))


def test_triangles_agree_with_trimesh():
    trimesh = pytest.importorskip("trimesh")
    torus = shapes.torus(1, 0.4, 24, 12)
    queries = np.random.default_rng(2).uniform(-1.5, 1.5, (200, 3)).astype(np.float32)
    theirs = trimesh.Trimesh(torus.V, torus.F, process=False)
    _, expected, _ = trimesh.proximity.closest_point_naive(theirs, queries)
    np.testing.assert_allclose(torus.closest_points(queries)[0], expected, atol=1e-6)
    assert torus.sample_surface(10).V.shape == (10, 3)
    assert theirs.volume == pytest.approx(volume(torus))


@pytest.mark.parametrize("call, message", [
    (lambda m: m.transform(np.eye(3)), "transform: expected a 4 x 4 matrix"),
    (lambda m: m.transform(np.diag([1, 1, 0, 1])), "determinant 0"),
    (lambda m: m.transform(np.full((4, 4), NAN)), "finite"),
    (lambda m: m.normalize_size(0), "size: expected a number > 0"),
    (lambda m: m.remove_duplicate_vertices(tolerance=-1), "tolerance"),
    (lambda m: m.remove_duplicate_vertices(tolerance=NAN), "tolerance"),
    (lambda m: m.subsample(), "expected one of count, fraction and cell_size"),
    (lambda m: m.subsample(5, fraction=0.5), "expected one of"),
    (lambda m: m.subsample(-1), "count"),
    (lambda m: m.subsample(fraction=1.5), "fraction"),
    (lambda m: m.subsample(cell_size=0), "cell size"),
    (lambda m: m.voxelize(NAN), "cell size"),
    (lambda m: m.voxelize(1e-12), "at most 2097152 cells"),
    (lambda m: m.decimate(), "got neither"),
    (lambda m: m.decimate(faces=-5), "faces"),
    (lambda m: m.decimate(error=NAN), "error"),
    (lambda m: m.upsample(-1), "iterations"),
    (lambda m: m.upsample(method="lop"), "expected 'midpoint' or 'loop', got 'lop'"),
    (lambda m: m.smooth(method="x"), "expected 'taubin' or 'laplacian'"),
    (lambda m: m.sample_surface(-1), "count"),
    (lambda m: m.closest_points([[0, NAN, 0]]), "finite"),
    (lambda m: m.closest_points([[0, 0]]), "expected n x 3"),
    (lambda m: m.distance_to(Mesh()), "expected a mesh with vertices"),
    (lambda m: m.distance_to(m, samples=-1), "samples"),
])
def test_bad_parameters_raise(call, message):
    with pytest.raises(easypbr.ArgumentError, match=message):
        call(shapes.box())


@pytest.mark.parametrize("method", ["center", "normalize_size", "bounding_box", "oriented_bounding_box", "upsample", "smooth",
                                    "split"])
def test_an_empty_mesh_has_none_of_it(method):
    with pytest.raises(easypbr.ArgumentError, match="expected"):
        getattr(Mesh(), method)()


@pytest.mark.parametrize("method", ["remove_unreferenced_vertices", "remove_duplicate_vertices", "remove_degenerate_faces",
                                    "flip_winding", "flip_normals", "merge"])
def test_an_empty_mesh_stays_empty(method):
    assert len(getattr(Mesh(), method)().V) == 0


def test_a_single_point_and_equal_points():
    for V in ([[1, 2, 3]], [[1, 2, 3]] * 50):
        mesh = cloud(V)
        np.testing.assert_array_equal(mesh.bounding_box(), [[1, 2, 3]] * 2)
        np.testing.assert_array_equal(mesh.center().V, np.zeros((len(V), 3)))
        assert len(mesh.remove_duplicate_vertices().V) == 1
        assert len(mesh.subsample(cell_size=0.5).V) == 1
        assert mesh.distance_to(mesh)["max"] == 0
        with pytest.raises(easypbr.ArgumentError, match="different places"):
            mesh.normalize_size()


def test_other_threads_run_meanwhile():
    mesh, ticks, done = shapes.icosphere(1, 7), [], threading.Event()

    def count():
        while not done.is_set():
            ticks.append(1)
            done.wait(0.001)

    other = threading.Thread(target=count, daemon=True)
    other.start()
    before = len(ticks)
    mesh.smooth(50)
    after = len(ticks)
    done.set()
    other.join()
    # A call that keeps the interpreter's lock lets no tick happen but at its ends.
    assert after - before > 3


def line(**arrays):
    return easypbr.as_mesh({"V": np.array([[0, 0, 0], [2.0, 0, 0], [2, 3, 0]]), "E": np.array([[0, 1], [1, 2]]), **arrays})


def test_lines_become_tubes():
    lines = line(C=np.eye(3))
    lines.scalars["heat"] = [1, 2, 3]
    tubes = lines.to_tubes(0.25, sides=16, ends="flat")
    # A mitre keeps the volume of prisms along the lines, of 16 sides: n / 2 sin(2 pi / n) r^2.
    assert volume(tubes) == pytest.approx(5 * 8 * np.sin(np.pi / 8) * 0.25 ** 2, rel=1e-5)
    assert len(tubes.E) == 0 and len(lines.E) == 2
    for vertex, place in ((0, [0, 0, 0]), (2, [2, 3, 0])):
        near = np.linalg.norm(tubes.V - place, axis=1) < 0.3
        assert (tubes.scalars["heat"][near] == vertex + 1).all() and (tubes.C[near] == np.eye(3)[vertex]).all()
    # Automatic: 1 / 200 of the diagonal of the line's box.
    assert lines.to_tubes().V[:, 1].max() == pytest.approx(3 + np.sqrt(13) / 200, abs=1e-6)


def test_tubes_have_a_radius_for_each_vertex():
    tubes = line().to_tubes(np.array([0.1, 0.2, 0.3]))
    assert tubes.V[:, 0].min() == pytest.approx(-0.1, abs=1e-6)
    assert tubes.V[:, 1].max() == pytest.approx(3.3, abs=1e-6)
    assert line().to_tubes(np.float32(0.5)).V[:, 1].max() == pytest.approx(3.5, abs=1e-6)


@pytest.mark.parametrize("call, message", [
    (lambda: shapes.box().to_tubes(), "make_tubes: expected a mesh with edges"),
    (lambda: line().to_tubes(NAN), "make_tubes: radius: expected a number > 0, got nan"),
    (lambda: line().to_tubes([0.1, 0.2]), "make_tubes: radii: expected one for each of 3 vertices, got 2"),
    (lambda: line().to_tubes([0.1, 0, 0.2]), "make_tubes: radius of vertex 1: expected a number > 0, got 0"),
    (lambda: line().to_tubes(ends="sharp"), "to_tubes: ends: expected 'round' or 'flat', got 'sharp'"),
    (lambda: line().to_tubes(sides=2), "make_tubes: sides: expected a whole number from 3 to 8192, got 2"),
])
def test_impossible_tubes_raise(call, message):
    with pytest.raises(easypbr.ArgumentError, match=message):
        call()

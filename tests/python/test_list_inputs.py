"""Lists and tuples: several things to draw, or vertices and faces, and what may be either."""

import numpy as np
import pytest
from test_inputs import COLORS, POINTS, drawn

import easypbr
from easypbr import Scene, as_mesh, shapes


def test_lists_of_anything_drawable(square, tmp_path):
    ball, box = shapes.sphere(0.5, 8), shapes.box()
    ball.save(tmp_path / "a.ply")
    box.save(tmp_path / "b.ply")
    for what, count in (
        ([ball, box], 2),
        ((str(tmp_path / "a.ply"), tmp_path / "b.ply"), 2),
        ([ball, POINTS, square, {"points": POINTS}], 4),
        ([POINTS, POINTS + 1, POINTS + 2], 3),
        ([POINTS, POINTS + 0.5], 2),
        ([[ball, box], POINTS], 2),
    ):
        mesh = as_mesh(what)
        assert len(mesh.children) == count
        assert drawn(what).shape == (36, 48, 4)
    assert [child.name for child in as_mesh([tmp_path / "a.ply", tmp_path / "b.ply"]).children] == ["a", "b"]
    apart = [ball, box.clone()]
    apart[1].T_parent_mesh = [[1, 0, 0, 3], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    scene = Scene()
    scene.show(apart[0], "ball")
    scene.show(apart[1], "box")
    np.testing.assert_array_equal(drawn(apart), drawn(scene))


def test_two_arrays_in_a_tuple_are_vertices_and_faces(square):
    V, F = square
    floats = F.astype(float)
    for what in ((V, F), (V, F.tolist()), (V, floats), (V, floats.tolist()), (V, list(floats)), (V.tolist(), F.tolist())):
        np.testing.assert_array_equal(as_mesh(what).F, F)
    for nothing in (None, [], np.zeros((0, 3)), np.zeros((0, 3), int)):
        assert len(as_mesh((V, nothing)).V) == 4 and not as_mesh((V, nothing)).children
    with pytest.raises(easypbr.ArgumentError, match="from 0 to 3, got 4 in row 1 of 2"):
        as_mesh((V, [[0.0, 1.0, 2.0], [0.0, 2.0, 4.0]]))
    for wrong in (F + 0.5, (F + 0.5).tolist(), F[0], [0, 1, 2], V[:, 0], F > 0, np.zeros((2, 2, 3)), [[0, 1, np.nan]]):
        with pytest.raises(easypbr.ArgumentError, match=r"expected \(V, F\), with m x 3 .* two clouds as a list, \[a, b\]"):
            as_mesh((V, wrong))
    # What is no array is drawn beside the points.
    for part in (shapes.box(), {"points": POINTS}, [POINTS, POINTS]):
        assert len(as_mesh((V, part)).children) == 2


def test_colors_beside_points_are_no_faces(square):
    many = np.random.default_rng(2).random((300, 3))
    # 8 bits hold the indices of all vertices up to 256.
    for V, C in ((POINTS, COLORS / 255), (square[0], np.eye(4)), (many, np.zeros((300, 3), np.uint8))):
        with pytest.raises(easypbr.ArgumentError, match=r"what look like colours; give them in a dict: \{'V': V, 'C': C\}"):
            as_mesh((V, C))
    faces = np.array([[0, 1, 2], [0, 2, 3], [0, 1, 3], [1, 2, 3]], np.uint8)
    np.testing.assert_array_equal(as_mesh((square[0], faces)).F, faces)


def test_arrays_in_a_list_are_clouds(square):
    V, F = square
    whole = np.array([[5, 0, 0], [1, 7, 0], [0, 1, 0], [2, 2, 2]])
    for what in (
        [POINTS, POINTS], [whole, whole], [whole, whole[:, [2, 0, 1]]], [V, whole], [V, F.astype(float)],
        [V, F.astype(float).tolist()], [V, F + 0.5], [V, np.zeros((0, 3))],
    ):  # fmt: skip
        mesh = as_mesh(what)
        assert [len(child.V) for child in mesh.children] == [len(what[0]), len(what[1])]
        assert not any(len(child.F) for child in mesh.children)
    assert len(as_mesh([V, whole, whole]).children) == 3
    # Points of a grid, which are below the number of points as vertex indices are; no triangle of (0, 0, 0) or (0, 1, 1).
    grid = np.array([[0, 0, 0], [0, 1, 1], [0, 1, 2], [1, 1, 1]])
    for what in ([grid, grid], [grid.tolist(), grid.tolist()], [grid, grid, grid], (grid, grid, grid)):
        assert [len(child.V) for child in as_mesh(what).children] == [4] * len(what)
    # A polygon of four corners beside a row of three, with a corner twice.
    with pytest.raises(easypbr.ArgumentError, match="expected as many numbers in each row"):
        as_mesh([grid, [[0, 1, 2, 0], [0, 1, 2]]])


def test_a_list_that_may_be_vertices_and_faces_is_refused(square):
    V, F = square
    whole = V.astype(int)
    for what in (
        [V, F], [V, F.tolist()], [V.tolist(), F.tolist()], [V, [[0, 1, 2, 3], [0, 1, 2]]], [V, np.zeros((0, 3), int)],
        [whole, F], [whole.tolist(), F.tolist()], [whole, [[0, 1, 2, 3], [0, 1, 2]]],
    ):  # fmt: skip
        with pytest.raises(easypbr.ArgumentError, match=r"a tuple, \(V, F\), .* a list of dicts, \[\{'V': a\}, \{'V': b\}\]"):
            as_mesh(what)
    for what, got in (([V, F, V], r"\[4 x 3, 2 x 3, 4 x 3\]"), ((V, F, V), r"\(4 x 3, 2 x 3, 4 x 3\)"), ([whole, F, V], r"\[")):
        with pytest.raises(easypbr.ArgumentError, match=rf"^{got}.*: expected \(V, F\); .*, and clouds as a list of dicts, \["):
            as_mesh(what)
    assert [len(child.V) for child in as_mesh([{"V": V}, {"V": F}]).children] == [4, 2]

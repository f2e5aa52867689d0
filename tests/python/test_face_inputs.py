"""Faces that are given as arrays and lists: polygons, the values of each, creases."""

import numpy as np
import pytest
from test_inputs import drawn

import easypbr
from easypbr import Mesh, as_mesh


@pytest.mark.parametrize("faces", [np.array([[0, 1, 2, 3]]), [[0, 1, 2, 3]]])
def test_polygons_are_fans(square, faces):
    V, _ = square
    np.testing.assert_array_equal(as_mesh((V, faces)).F, [[0, 1, 2], [0, 2, 3]])
    mixed = as_mesh({"vertices": np.vstack([V, [[2, 0, 0]]]), "faces": [[0, 1, 2, 3], [1, 4, 2]], "area": [1.0, 0.5]})
    np.testing.assert_array_equal(mixed.F, [[0, 1, 2], [0, 2, 3], [1, 4, 2]])
    np.testing.assert_array_equal(mixed.scalars["area"], [1, 1, 0.5])


def test_values_of_polygons_stay_theirs_with_as_many_triangles_as_vertices():
    """2 x 3 quads: 6 polygons, 12 vertices, 12 triangles. 12 values are those of vertices."""
    x, y = np.meshgrid(np.arange(4.0), np.arange(3.0))
    corner = (np.arange(2)[:, None] * 4 + np.arange(3)).reshape(-1, 1)
    arrays = {"V": np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3), "F": corner + [0, 1, 5, 4], "C": np.full((12, 3), 0.5)}
    at_vertices = np.arange(12.0)
    mesh = as_mesh(arrays | {"area": np.arange(6.0), "labels": np.arange(6), "heat": at_vertices})
    assert len(mesh.F) == 12 and len(mesh.V) == len(mesh.C) == 13
    np.testing.assert_array_equal(mesh.scalars["area"], np.repeat(np.arange(6), 2))
    np.testing.assert_array_equal(mesh.L, np.repeat(np.arange(6), 2))
    np.testing.assert_array_equal(mesh.scalars["heat"][:12], at_vertices)
    np.testing.assert_array_equal(mesh.V[12], mesh.V[11])
    only_labels = as_mesh(arrays | {"labels": np.arange(6)})
    np.testing.assert_array_equal(only_labels.L, np.repeat(np.arange(6), 2))
    assert len(as_mesh(arrays | {"heat": at_vertices}).V) == 12, "nothing to tell apart"


# Two quads side by side, beyond them a triangle; a path of corners round each.
STRIP_V = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0], [3, 0, 0]], float)
STRIP_F = [[0, 1, 4, 3], [1, 2, 5, 4], [2, 6, 5]]


def test_polygons_are_remembered():
    ragged, quads = as_mesh((STRIP_V, STRIP_F)), as_mesh((STRIP_V, np.array(STRIP_F[:2])))
    np.testing.assert_array_equal(ragged.source_face, [0, 0, 1, 1, 2])
    np.testing.assert_array_equal(quads.source_face, [0, 0, 1, 1])
    np.testing.assert_array_equal(as_mesh({"V": STRIP_V, "F": STRIP_F}).source_face, [0, 0, 1, 1, 2])
    given = as_mesh({"V": STRIP_V, "source_face": [0, 0, 1, 1], "F": quads.F, "area": [1.0, 2.0]})
    np.testing.assert_array_equal(given.source_face, [0, 0, 1, 1])
    np.testing.assert_array_equal(given.scalars["area"], [1, 1, 2, 2])
    assert len(as_mesh((STRIP_V, quads.F)).source_face) == 0, "triangles are polygons themselves"
    with pytest.raises(easypbr.ArgumentError, match="source_face: expected triangles beside it"):
        as_mesh({"V": STRIP_V, "F": STRIP_F, "source_face": [0, 0, 1, 1, 2]})


def test_wireframes_of_polygons_are_those_of_the_same_file(tmp_path):
    lines = [f"v {x} {y} {z}" for x, y, z in STRIP_V] + ["f " + " ".join(str(i + 1) for i in face) for face in STRIP_F]
    (tmp_path / "strip.obj").write_text("\n".join(lines) + "\n")
    look = {"show_wireframe": True, "camera": "front"}
    of_file = drawn(tmp_path / "strip.obj", **look)
    np.testing.assert_array_equal(drawn((STRIP_V, STRIP_F), **look), of_file)
    np.testing.assert_array_equal(drawn({"V": STRIP_V, "F": STRIP_F}, **look), of_file)
    assert (drawn((STRIP_V, as_mesh((STRIP_V, STRIP_F)).F), **look) != of_file).any(), "triangles have diagonals"


def test_values_of_polygons_are_taken_afterwards():
    mesh = as_mesh((STRIP_V, STRIP_F))  # 7 vertices, 5 triangles, 3 polygons
    mesh.L = [5, 6, 7]
    mesh.scalars["area"] = [1.0, 2.0, 0.5]
    np.testing.assert_array_equal(mesh.L, [5, 5, 6, 6, 7])
    np.testing.assert_array_equal(mesh.scalars["area"], [1, 1, 2, 2, 0.5])
    mesh.L = range(5)
    np.testing.assert_array_equal(mesh.L, range(5))
    counts = "expected 7 rows, one per vertex, or 5, one per face, or 3, one per polygon, or none; got 4 x 1"
    with pytest.raises(easypbr.ArgumentError, match=f"array L: {counts}"):
        mesh.L = [0, 1, 2, 3]
    np.testing.assert_array_equal(mesh.L, range(5))
    with pytest.raises(easypbr.ArgumentError, match="source_face: expected 5 rows, one per face, or none; got 3 x 1"):
        mesh.source_face = [0, 1, 2]
    with pytest.raises(easypbr.ArgumentError, match="expected numbers of polygons from 0 on, got -1 in row 1 of 5"):
        mesh.source_face = [0, -1, 1, 1, 2]
    mesh.F = mesh.F
    assert len(mesh.source_face) == 0


def test_faces_and_what_belongs_to_them_are_assigned_in_any_order():
    mesh = Mesh(STRIP_V, [[0, 1, 4]])
    mesh.assign(source_face=[0, 0], L=[3], F=[[0, 1, 4], [0, 4, 3]])
    np.testing.assert_array_equal(mesh.source_face, [0, 0])
    np.testing.assert_array_equal(mesh.L, [3, 3])


def test_a_crease_angle_keeps_edges_of_any_mesh_without_normals_sharp(tmp_path):
    V = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    F = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    triangles = as_mesh((V, F)).F
    sides = np.cross(V[triangles[:, 1]] - V[triangles[:, 0]], V[triangles[:, 2]] - V[triangles[:, 0]])
    split = {"V": V[triangles.ravel()], "F": np.arange(36).reshape(12, 3), "N": np.repeat(sides, 3, axis=0)}
    sharp, soft = (drawn(what, crease_deg=180, color_by="solid").astype(int) for what in (split, (V, F)))
    mesh = Mesh(V, triangles)
    mesh.save(tmp_path / "box.obj")
    for what in ((V, F), mesh, tmp_path / "box.obj", {"V": V, "F": F, "number": range(6)}):
        creased = drawn(what, crease_deg=30, color_by="solid").astype(int)
        # Other vertices with the same normals: 1 for what interpolation rounds.
        assert np.abs(creased - sharp).max() <= 1
        np.testing.assert_array_equal(drawn(what, color_by="solid"), creased)
        np.testing.assert_array_equal(drawn(what, crease_deg=180, color_by="solid"), soft)
    assert np.abs(sharp - soft).max() > 10
    assert len(mesh.V) == 8, "what is shown stays as it is"

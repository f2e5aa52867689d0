"""Faces of more than three corners that are given as arrays: how they are cut, and that their diagonals are not shown."""

import types

import numpy as np
import pytest

import easypbr
from easypbr import as_mesh

#: An arrow of area 4 - 1.5 (its notch is a triangle of width 2 and height 1.5), and a dart of two triangles of area 0.3.
ARROW = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [1, 0.5, 0], [0, 2, 0]])
DART = np.array([[0, 0, 0], [2, 0, 0], [0.3, 0.3, 0], [0, 2, 0]])


def signed_areas(mesh) -> np.ndarray:
    a, b, c = (np.asarray(mesh.V, float)[mesh.F[:, k]] for k in range(3))
    return np.cross(b - a, c - a)[:, 2] / 2


def objects(rows):
    array = np.empty(len(rows), object)
    array[:] = rows
    return array


class OfDlpack:
    """An array of another library."""

    def __init__(self, values):
        self._array = np.array(values)
        self.shape = self._array.shape

    def __dlpack__(self, **options):
        return self._array.__dlpack__(**options)

    def __dlpack_device__(self):
        return self._array.__dlpack_device__()


def like_pyvista(V, polygon):
    faces = np.array([len(polygon), *polygon])
    return types.SimpleNamespace(points=V, faces=faces, point_data={}, n_points=len(V), is_all_triangles=False)


@pytest.mark.parametrize("made", [
    lambda V, polygon: (V, [polygon]),
    lambda V, polygon: (V, np.array([polygon])),
    lambda V, polygon: (V, np.array([polygon], float)),
    lambda V, polygon: (V + [691_000, 5_335_000, 0], [polygon]),
    lambda V, polygon: (V, [polygon, [0, 1, 2]]),
    lambda V, polygon: (V, objects([polygon, [0, 1, 2]])),
    lambda V, polygon: (V, np.array([polygon], object)),
    lambda V, polygon: (V, [OfDlpack(polygon), OfDlpack([0, 1, 2])]),
    lambda V, polygon: {"faces": [polygon], "V": V.tolist()},
    lambda V, polygon: {"faces": objects([polygon, [0, 1, 2]]), "V": V},
    like_pyvista,
], ids=["list", "array", "floats", "far", "ragged", "objects", "object rows", "dlpack", "dict", "dict of objects", "pyvista"])  # fmt: skip
@pytest.mark.parametrize("V, area", [(ARROW, 2.5), (DART, 0.6)], ids=["arrow", "dart"])
def test_concave_polygons_are_covered_once(made, V, area):
    for first in range(len(V)):
        mesh = as_mesh(made(V, np.roll(range(len(V)), first).tolist()))
        areas = signed_areas(mesh)[: len(V) - 2]
        assert (areas > 0).all(), f"a triangle is turned over, beginning at {first}"
        # 0.3 in float32 is off by 1e-8.
        np.testing.assert_allclose(areas.sum(), area, atol=1e-6)
        np.testing.assert_array_equal(mesh.source_face[: len(V) - 2], 0)


def test_convex_polygons_are_cut_from_their_first_corner():
    V = np.array([[np.cos(a), np.sin(a), 0] for a in np.arange(6) * np.pi / 3])
    np.testing.assert_array_equal(as_mesh((V, [[1, 2, 3, 4, 5, 0]])).F, [[1, 2, 3], [1, 3, 4], [1, 4, 5], [1, 5, 0]])
    mixed = as_mesh((V, [[0, 1, 2, 3], [3, 4, 5]]))
    np.testing.assert_array_equal(mixed.F, [[0, 1, 2], [0, 2, 3], [3, 4, 5]])
    np.testing.assert_array_equal(mixed.source_face, [0, 0, 1])
    assert as_mesh((V, np.zeros((0, 4), int))).F.shape == (0, 3)


@pytest.mark.parametrize("corners", [8_193, 100_000])
def test_any_number_of_corners(corners):
    t = np.arange(corners) * 2 * np.pi / corners
    r = 1 + 0.5 * np.cos(9 * t)
    V = np.stack([r * np.cos(t), r * np.sin(t), 0 * t], axis=1)
    areas = signed_areas(as_mesh((V, [np.arange(corners)])))
    assert (areas >= 0).all()
    # Half the integral of r^2 is pi (1 + 0.5^2 / 2); chords fall short of it by less than their angle.
    np.testing.assert_allclose(areas.sum(), np.pi * 1.125, atol=7 / corners)


@pytest.mark.parametrize("F, message", [
    ([[0, 1, 2, 4]], "array F: expected vertex indices from 0 to 3, got 4 in row 0 of 1"),
    ([[0, 1, 2], [0, 1, 2, -1]], "array F: expected vertex indices from 0 to 3, got -1 in row 1 of 2"),
    (np.array([[0, 1, 2, 0.5]]), "array F: expected whole numbers"),
    ([[0, 1, 2], [0, 1]], "polygons of at least 3 corners each"),
])
def test_wrong_corners_are_named(F, message):
    with pytest.raises(easypbr.ArgumentError, match=message):
        as_mesh({"V": DART, "F": F})


@pytest.mark.parametrize("what, message", [
    ([[0, 1, 2], [3, 4]], "points: expected as many numbers in each row, got 3 in row 0 and 2 in row 1"),
    ([[0, 1, 2], 3], "got 3 in row 0 and a single number in row 1"),
    ([[0, 1, 2], [3, 4, [5]]], "points: expected an array of numbers"),
    ((ARROW, [[0.0, 1.0, 2.0], [0.0, 1.0, 2.0, 3.5]]), r"expected \(V, F\), with m x 3 vertex indices or polygons"),
    ({"points": [[0, 1, 2], [3, 4]]}, "points: expected an array of numbers"),
    ({"points": ARROW, "heat": [[1], [2, 3]]}, "scalars 'heat': expected an array of numbers"),
    ({"points": ARROW, "colors": [[1], [2, 3]]}, "colours: expected an array of numbers"),
    ({"points": ARROW, "faces": [[0, 1, [2, 3]], [0, 1, 2]]}, "faces: expected an array of numbers"),
])
def test_rows_of_different_lengths_are_errors_of_ours(what, message):
    with pytest.raises(easypbr.ArgumentError, match=message):
        as_mesh(what)


def test_polygons_without_vertices_are_refused():
    with pytest.raises(easypbr.ArgumentError, match="expected V .* beside F, got none"):
        as_mesh({"F": [[0, 1, 2, 3]]})


def white_pixels(what, settings, **look) -> np.ndarray:
    """Those that lines cover as a whole."""
    look |= {"show_wireframe": True, "line_color": "#ffffff", "line_width": 3, "lit": False, "background": "#000000"}
    picture = easypbr.render(what, size=(120, 120), samples=1, antialias="none", camera="front", settings=settings, **look)
    return (picture[..., :3] == 255).all(axis=2)


@pytest.mark.parametrize("settings", [{}, {"clip.box": [-9, 1.5, -9, 9, 9, 9]}], ids=["whole", "clipped"])
@pytest.mark.parametrize("values", [
    {"values": np.arange(16.0)},
    {"labels": np.arange(16) % 3},
    {"labels": np.arange(25) % 3},
], ids=["values", "labels", "vertex labels"])  # fmt: skip
def test_wireframes_of_coloured_polygons_have_no_diagonals(values, settings):
    x, y = np.meshgrid(np.arange(5.0), np.arange(5.0))
    corner = (5 * np.arange(4)[:, None] + np.arange(4)).reshape(-1, 1)
    mesh = {"V": np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3), "F": corner + [0, 1, 6, 5]}
    plain = white_pixels(mesh, settings, color="#404040")
    assert plain.sum() > 1000
    np.testing.assert_array_equal(white_pixels(mesh | values, settings), plain)

"""What people have at hand: arrays, tables, dicts, and objects of other libraries, as one mesh."""

import sys
import types

import numpy as np
import pytest

import easypbr
from easypbr import Mesh, as_mesh, render, shapes

POINTS = np.random.default_rng(0).random((40, 3))
COLORS = np.random.default_rng(1).integers(0, 256, (40, 3))
SMALL = {"size": (48, 36), "samples": 1}


def drawn(what, **settings) -> np.ndarray:
    return render(what, **SMALL, **settings)


# Arrays of points.


@pytest.mark.parametrize("points", [
    POINTS,
    POINTS.astype(np.float32),
    POINTS.tolist(),
    [tuple(row) for row in POINTS],
    list(POINTS),
    (POINTS,),
    [POINTS],
    (POINTS, None),
    {"points": POINTS},
    {"xyz": POINTS},
    {"vertices": POINTS},
    {"V": POINTS},
], ids=["f8", "f4", "lists", "tuples", "rows", "(V,)", "[V]", "(V, None)", "points", "xyz", "vertices", "V"])  # fmt: skip
def test_points_are_a_cloud(points):
    mesh = as_mesh(points)
    np.testing.assert_allclose(mesh.V, POINTS, atol=1e-7)
    assert len(mesh.F) == 0 and not mesh.children


def test_an_array_of_points_is_drawn():
    np.testing.assert_array_equal(drawn(POINTS), drawn(Mesh(POINTS)))


@pytest.mark.parametrize("color", [
    COLORS / 255,
    COLORS.astype(float),
    COLORS.astype(np.uint8),
    COLORS.astype(np.int64),
], ids=["0 to 1", "0 to 255", "uint8", "int64"])  # fmt: skip
def test_colors_of_every_range(color):
    for mesh in (as_mesh(np.hstack([POINTS, color])), as_mesh({"points": POINTS, "colors": color})):
        np.testing.assert_allclose(mesh.C, COLORS / 255, atol=1e-6)


def test_further_columns_are_those_of_a_text_file(tmp_path):
    normals = POINTS / np.linalg.norm(POINTS, axis=1, keepdims=True)
    heat, label = np.linspace(0.5, 3.7, 40)[:, None], np.arange(40.0)[:, None] % 4
    for columns in ([heat], [COLORS], [normals, COLORS], [heat, COLORS], [COLORS, label], [heat, 5 - heat], [label, COLORS, heat]):
        array = np.hstack([POINTS, *columns])
        np.savetxt(tmp_path / "points.xyz", array)
        read, made = Mesh(tmp_path / "points.xyz"), as_mesh(array)
        for name in ("V", "N", "C", "L", "I"):
            np.testing.assert_allclose(getattr(made, name), getattr(read, name), atol=1e-6, err_msg=name)
        assert list(made.scalars) == list(read.scalars)


@pytest.mark.parametrize("what, message", [
    (POINTS[:, :2], "points: expected n x 3 positions, or n x 6 with colours, got 40 x 2"),
    (POINTS[0], "points: expected n x 3 positions"),
    (np.zeros((2, 3, 2)), "got 2 x 3 x 2"),
    (np.zeros(4, [("a", "f4"), ("b", "f4")]), "a table: expected columns x, y and z, got a, b"),
    (np.array([["a", "b", "c"]]), "points: expected numbers, got <U1"),
    ([], "an empty list: there is nothing to show; expected a path"),
    (3, "cannot show a builtins.int: expected a path, an easypbr.Mesh, points"),
    (None, "cannot show a builtins.NoneType"),
    ((POINTS, [[0, 1, 2]], POINTS), r"^\(40 x 3, list, 40 x 3\): expected \(V, F\); give further arrays in a dict"),
    ({"points": POINTS, "colors": POINTS * 300}, "colours: expected 0 to 1 or 0 to 255, got"),
    ({"points": POINTS, "colors": -POINTS}, "colours: expected 0 to 1 or 0 to 255, got"),
    ({"points": POINTS, "V": POINTS}, "'V' is V, which is given already"),
    ({"points": POINTS, "heat": POINTS}, "no array 'heat'; a dict may hold V, F"),
    ({"points": POINTS, "heat": POINTS[:7, 0]}, "scalars 'heat': expected 40 values, one for each vertex, got 7"),
    ({"points": POINTS, "faces": [[0, 1, 2, 3]], "heat": [1, 2]}, "40 values, one for each vertex, or 1, one for each face, got 2"),
    ({"faces": [[0, 1, 2]]}, "expected V .or points, xyz, vertices, .* beside F, got none"),
    ({"F": [[0, 1, 2, 3]], "V": None}, "expected V .or points, xyz, vertices, .* beside F, got none"),
    ({"edges": "line"}, "expected V .* beside E, got none"),
    ({"points": POINTS, "heat": np.zeros((7, 1))}, "scalars 'heat': expected 40 values, one for each vertex, got 7"),
    ([shapes.box(), 7], "cannot show a builtins.int"),
])  # fmt: skip
def test_errors_name_what_is_accepted(what, message):
    with pytest.raises(easypbr.Error, match=message):
        as_mesh(what)


def test_faces_beside_vertices_are_no_path(square):
    V, F = square
    with pytest.raises(easypbr.ArgumentError, match=r"out: expected a path, got a 2 x 3 array.*render\(\(V, F\)\)"):
        render(V, F)


# Dicts and tables.


def test_dicts_as_polyscope_and_npz_have_them(square):
    V, F = square
    mesh = as_mesh({"vertices": V, "faces": F, "normals": V, "heat": V[:, 0], "labels": [0, 1, 2, 3], "name": "square"})
    np.testing.assert_array_equal(mesh.N, V)
    np.testing.assert_array_equal(mesh.scalars["heat"], V[:, 0])
    np.testing.assert_array_equal(mesh.L, range(4))
    assert mesh.name == "square"
    curve = as_mesh({"nodes": V, "edges": "loop"})
    np.testing.assert_array_equal(curve.E, [[0, 1], [1, 2], [2, 3], [3, 0]])
    np.testing.assert_array_equal(as_mesh({"nodes": V, "edges": "line"}).E, [[0, 1], [1, 2], [2, 3]])
    np.testing.assert_array_equal(as_mesh({"nodes": V, "edges": "segments"}).E, [[0, 1], [2, 3]])
    with pytest.raises(easypbr.ArgumentError, match="'line', 'loop' or 'segments', got 'circle'"):
        as_mesh({"nodes": V, "edges": "circle"})


class Frame:
    """What of a pandas frame is used: columns by name, each an array; a shape."""

    def __init__(self, columns):
        self._columns = columns
        self.columns = list(columns)
        self.shape = (len(next(iter(columns.values()))), len(columns))

    def __getitem__(self, name):
        return self._columns[name]

    def __array__(self, *_):
        raise AssertionError("a table is read by its columns")


def frame(columns):
    """pandas' own where it is installed."""
    try:
        import pandas
    except ImportError:
        return Frame(columns)
    return pandas.DataFrame(columns)


def test_tables_with_x_y_z(caplog):
    columns = {"id": np.arange(40), "x": POINTS[:, 0], "Y": POINTS[:, 1], "z": POINTS[:, 2]}
    columns |= {"red": COLORS[:, 0], "green": COLORS[:, 1], "blue": COLORS[:, 2], "intensity": POINTS[:, 0]}
    columns |= {"label": np.arange(40) % 3, "note": np.array(["a"] * 40, dtype=object)}
    mesh = as_mesh(frame(columns))
    np.testing.assert_allclose(mesh.V, POINTS, atol=1e-7)
    np.testing.assert_allclose(mesh.C, COLORS / 255, atol=1e-6)
    np.testing.assert_allclose(mesh.I, POINTS[:, 0], atol=1e-7)
    np.testing.assert_array_equal(mesh.L, np.arange(40) % 3)
    assert list(mesh.scalars) == ["id"]
    assert "columns that hold no numbers: note" in caplog.text
    with pytest.raises(easypbr.ArgumentError, match="expected columns x, y and z, got a, b"):
        as_mesh(frame({"a": POINTS[:, 0], "b": POINTS[:, 1]}))


def test_columns_of_flags():
    """As 0 and 1, whatever they are called."""
    flags = np.arange(40) % 3 == 0
    columns = dict(zip("xyz", POINTS.T)) | {"ground": flags, "r": flags, "intensity": flags, "label": flags}
    mesh = as_mesh(frame(columns))
    for values in (mesh.scalars["ground"], mesh.scalars["r"], mesh.I, mesh.L):
        np.testing.assert_array_equal(values, flags)


def test_scalars_of_one_column_in_a_dict(square):
    V, F = square
    mesh = as_mesh({"V": V, "F": F, "heat": np.arange(4.0)[:, None], "area": [[1], [2]]})
    np.testing.assert_array_equal(mesh.scalars["heat"], np.arange(4))
    np.testing.assert_array_equal(mesh.scalars["area"], [1, 2])


# Masked arrays.


def test_masked_values_are_missing(caplog):
    """NaN, as in what a mesh stores; rows of a cloud without a position are left out."""
    points = np.ma.masked_less(POINTS, 0.1)
    kept = ~np.ma.getmaskarray(points).any(axis=1)
    for mesh in (as_mesh(points), as_mesh({"points": points}), Mesh(points)):
        np.testing.assert_allclose(mesh.V, POINTS[kept], atol=1e-7)
    assert f"{40 - kept.sum()} of 40 points have no finite position" in caplog.text
    heat = np.ma.masked_greater(POINTS[:, 0], 0.5)
    mesh = as_mesh({"points": POINTS, "heat": heat})
    mesh.add_scalar("again", heat)
    for values in mesh.scalars.values():
        np.testing.assert_array_equal(np.isnan(values), heat.mask)
    np.testing.assert_allclose(as_mesh(np.ma.array(POINTS)).V, POINTS, atol=1e-7)


def test_masked_whole_numbers_are_refused():
    labels = np.ma.masked_less(np.arange(40), 3)
    message = r"a masked array of int64 with 3 masked values: expected floats, whose masked values become NaN.*array.filled\(value\)"
    with pytest.raises(easypbr.ArgumentError, match=message):
        as_mesh({"points": POINTS, "labels": labels})
    mesh = Mesh(POINTS)
    with pytest.raises(easypbr.ArgumentError, match=message):
        mesh.L = labels
    with pytest.raises(easypbr.ArgumentError, match="masked array of bool with 3 masked"):
        mesh.L = np.ma.array(np.zeros(40, bool), mask=labels.mask)
    mesh.L = np.ma.array(np.arange(40))
    np.testing.assert_array_equal(mesh.L, np.arange(40))


# Arrays of other libraries.


class OfCuda:
    """An array in the memory of a GPU, as CuPy has them."""

    def __init__(self, array):
        self._array = array
        self.shape = array.shape

    def __dlpack_device__(self):
        return (2, 0)

    def __dlpack__(self, **_):
        raise BufferError("numpy cannot take what lies on a GPU")

    def get(self):
        return self._array


class OfJax:
    """An array on the CPU that speaks DLPack alone."""

    def __init__(self, array):
        self._array = array
        self.shape = array.shape

    def __dlpack_device__(self):
        return (1, 0)

    def __dlpack__(self, **_):
        return self._array.__dlpack__()


class OfDlpack(OfJax):
    """Without the shape as an attribute."""

    def __init__(self, array):
        self._array = array


class OfArray:
    """An array that numpy takes, with nothing else."""

    def __init__(self, array):
        self._array = array

    def __array__(self, dtype=None, copy=None):
        return self._array


class OfInterface:
    def __init__(self, array):
        self._array = array
        self.__array_interface__ = array.__array_interface__


@pytest.mark.parametrize("kind", [OfDlpack, OfArray, OfInterface])
def test_arrays_without_a_shape(square, kind):
    V, F = square
    tuples = ((kind(V), kind(F)), (V, kind(F)), (V, [kind(face) for face in F]), ([kind(row) for row in V], F),
              ([kind(row) for row in V], [kind(face) for face in F]))
    for what in (*tuples, {"V": kind(V), "F": kind(F)}, {"V": V, "F": kind(F)}):
        np.testing.assert_array_equal(as_mesh(what).F, F)
        np.testing.assert_array_equal(as_mesh(what).V, V)
    for mesh in (Mesh(V, kind(F)), Mesh(kind(V), kind(F))):
        np.testing.assert_array_equal(mesh.F, F)
    for what in (kind(V), [kind(row) for row in V], (kind(V), None), (kind(V),)):
        np.testing.assert_array_equal(as_mesh(what).V, V)
    assert len(as_mesh([kind(V), kind(V)]).children) == 2
    holes, kept = with_holes()
    arrays = {"V": kind(holes), "C": kind(COLORS), "L": kind(np.arange(40)), "heat": kind(np.arange(40.0))}
    mesh = as_mesh(arrays | {"scalars": {"cold": kind(np.arange(40.0))}})
    for values in (mesh.L, mesh.scalars["heat"], mesh.scalars["cold"]):
        np.testing.assert_array_equal(values, kept)


def test_what_is_no_array_of_numpy_is_an_error_of_ours(square):
    class Broken:
        def __array__(self, dtype=None, copy=None):
            raise TypeError("not today")

    class BrokenOfCuda(Broken):
        def __dlpack_device__(self):
            return (2, 0)

        def __dlpack__(self, **_):
            raise BufferError("numpy cannot take what lies on a GPU")

    V, F = square
    for kind in (Broken, BrokenOfCuda):
        for what in (kind(), (kind(), F), (V, kind()), {"V": V, "F": kind()}):
            with pytest.raises(easypbr.ArgumentError, match=f"{kind.__name__}: expected numbers that numpy takes: not today"):
                as_mesh(what)
    for what in ({"V": V, "F": 5}, {"V": 5}, {"V": V, "E": 5}):
        with pytest.raises(easypbr.ArgumentError, match="expected (m x 3|n x 3|k x 2)"):
            as_mesh(what)
    with pytest.raises(easypbr.ArgumentError, match="mesh array F: expected n x 3"):
        Mesh(V, 5)


@pytest.mark.parametrize("kind", [OfCuda, OfJax])
def test_arrays_by_dlpack(square, kind):
    V, F = square
    points = as_mesh(kind(POINTS))
    np.testing.assert_allclose(points.V, POINTS, atol=1e-7)
    np.testing.assert_array_equal(as_mesh((kind(V), kind(F))).F, F)
    np.testing.assert_allclose(as_mesh({"points": kind(POINTS), "colors": kind(COLORS)}).C, COLORS / 255, atol=1e-6)
    assert len(as_mesh([kind(POINTS), kind(POINTS)]).children) == 2


def test_tensors(square):
    torch = pytest.importorskip("torch")
    V, F = square
    cloud = torch.tensor(POINTS, requires_grad=True)
    np.testing.assert_allclose(as_mesh(cloud).V, POINTS, atol=1e-7)
    np.testing.assert_array_equal(as_mesh((torch.tensor(V), torch.tensor(F))).F, F)
    assert len(as_mesh([cloud, cloud]).children) == 2


# Points that are not finite.


def with_holes():
    points = POINTS.copy()
    points[[3, 17]] = np.nan
    points[21, 1] = np.inf
    return points, np.delete(np.arange(40), [3, 17, 21])


def test_points_without_a_position_are_left_out_of_arrays_as_of_files(caplog, tmp_path):
    points, kept = with_holes()
    for what in (points, {"points": points, "colors": COLORS, "heat": POINTS[:, 0]}, (points, None), Frame(dict(zip("xyz", points.T)))):
        caplog.clear()
        mesh = as_mesh(what)
        np.testing.assert_allclose(mesh.V, POINTS[kept], atol=1e-7)
        assert "3 of 40 points have no finite position and are left out" in caplog.text
        with pytest.raises(easypbr.ArgumentError, match=r"expected finite positions, got .* in row 3 of 40"):
            as_mesh(what, strict=True)
    both = as_mesh({"points": points, "colors": COLORS, "heat": POINTS[:, 0], "labels": np.arange(40)})
    np.testing.assert_allclose(both.C, COLORS[kept] / 255, atol=1e-6)
    np.testing.assert_allclose(both.scalars["heat"], POINTS[kept, 0], atol=1e-7)
    np.testing.assert_array_equal(both.L, kept)
    np.testing.assert_allclose(Mesh(points).V, POINTS[kept], atol=1e-7)
    np.testing.assert_allclose(Mesh(points, None).V, POINTS[kept], atol=1e-7)
    with pytest.raises(easypbr.ArgumentError, match="row 3 of 40"):
        Mesh(points, strict=True)
    np.save(tmp_path / "points.npy", points)
    caplog.clear()
    np.testing.assert_allclose(as_mesh(tmp_path / "points.npy").V, POINTS[kept], atol=1e-7)
    assert "3 of 40 points have no finite position and are left out" in caplog.text
    for fails in (lambda: as_mesh(tmp_path / "points.npy", strict=True), lambda: render(tmp_path / "points.npy", strict=True, **SMALL)):
        with pytest.raises(easypbr.FormatError, match="points without a finite position"):
            fails()
    with pytest.raises(easypbr.ArgumentError, match="row 3 of 40"):
        render(points, strict=True, **SMALL)


def test_a_cloud_without_any_position_is_an_error():
    with pytest.raises(easypbr.ArgumentError, match="none of 5 has a finite position"):
        as_mesh(np.full((5, 3), np.nan))


def test_vertices_of_faces_must_be_finite_as_in_files(square):
    V, F = square
    V[1, 2] = np.nan
    with pytest.raises(easypbr.ArgumentError, match="array V: expected finite positions.* in row 1 of 4"):
        as_mesh((V, F))


def test_strict_takes_what_is_whole(tmp_path, square):
    mesh = as_mesh(POINTS, strict=True)
    assert len(mesh.V) == 40
    mesh.save(tmp_path / "cloud.ply")
    assert len(as_mesh(tmp_path / "cloud.ply", strict=True).V) == 40
    shapes.sphere(1, 8).save(tmp_path / "ball.obj")
    assert len(as_mesh(tmp_path / "ball.obj", strict=True).F) > 0


# trimesh.


def test_trimesh_paths_are_lines():
    trimesh = pytest.importorskip("trimesh")
    path = trimesh.load_path(np.array([[[0, 0, 0], [1, 0, 0]], [[1, 0, 0], [1, 1, 0]]], dtype=float))
    mesh = as_mesh(path)
    ends = mesh.V[mesh.E].reshape(-1, 6)
    assert {tuple(row) for row in ends.round(6).tolist()} == {(0, 0, 0, 1, 0, 0), (1, 0, 0, 1, 1, 0)}


def test_an_object_of_an_unexpected_form_is_named():
    odd = types.SimpleNamespace(points=POINTS, lines=3, colors=None, has_lines=True)
    with pytest.raises(easypbr.ArgumentError, match="cannot show a types.SimpleNamespace, which has not the expected form"):
        as_mesh(odd)


def test_no_library_is_imported_for_arrays():
    import subprocess

    code = "import easypbr, sys, numpy as np; easypbr.as_mesh(np.zeros((3, 3)));" \
           "print([name for name in ('torch', 'vtkmodules', 'pyvista', 'trimesh', 'open3d', 'pandas') if name in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip() == "[]"

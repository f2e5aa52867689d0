"""Data that is odd or wrong: a message that says what was expected, or a sensible picture. Never a crash, never garbage."""
import os

import numpy as np
import pytest

import easypbr
from easypbr import Mesh, Scene, Viewer, shapes

NAN = float("nan")
V = np.random.default_rng(0).random((50, 3))


def mesh_of(**arrays) -> Mesh:
    mesh = Mesh()
    mesh.assign(**arrays)
    return mesh


def with_row(values: np.ndarray, row: int, value: float) -> np.ndarray:
    changed = np.array(values, dtype=float)
    changed[row] = value
    return changed


@pytest.mark.parametrize("arrays, message", [
    ({"V": V, "N": V[:49]}, "array N: expected 50 rows, one per vertex, or none; got 49 x 3"),
    ({"V": V, "C": V[:7]}, "array C: expected 50 rows.*got 7 x 3"),
    ({"V": V, "L": np.zeros(49, int)}, "array L: expected 50 rows, one per vertex, or 0, one per face, or none; got 49 x 1"),
    ({"V": V, "I": V[:3, 0]}, "array I: expected 50 rows.*got 3 x 1"),
    ({"V": V[:, :2]}, "array V: expected n x 3, got 50 x 2 float64"),
    ({"V": V[0]}, "array V: expected n x 3, got 3"),
    ({"V": np.array([["a", "b", "c"]])}, "array V: expected numbers, got dtype <U1"),
    ({"V": V * 1j}, "array V: expected numbers, got dtype complex128"),
    ({"V": V, "F": [[0.5, 1, 2]]}, "array F: expected whole numbers"),
    ({"V": V, "F": [[0, 1, 50]]}, "array F: expected vertex indices from 0 to 49, got 50 in row 0 of 1"),
    ({"V": V, "F": [[0, 1, 2], [-1, 1, 2]]}, "array F: expected vertex indices from 0 to 49, got -1 in row 1 of 2"),
    ({"V": V, "E": [[0, 50]]}, "array E: expected vertex indices from 0 to 49, got 50"),
    ({"V": with_row(V, 3, NAN)}, r"array V: expected finite positions, got \(nan, nan, nan\) in row 3 of 50"),
    ({"V": with_row(V, 4, np.inf)}, "array V: expected finite positions, got .*inf.* in row 4 of 50"),
    ({"V": V, "L": np.full(50, 999), "label_map": "semantic_kitti"}, "label 999 in row 0 of 50 is not in the label map"),
    ({"V": V, "L": np.full(50, 1.5)}, "array L: expected whole numbers"),
])
def test_wrong_arrays_are_named(arrays, message):
    mesh = mesh_of(V=[[1, 2, 3]])
    with pytest.raises(easypbr.ArgumentError, match=message):
        mesh.assign(**arrays)
    assert mesh.V.tolist() == [[1, 2, 3]], "the mesh stays as it was"


@pytest.mark.parametrize("name, value, message", [
    ("colormap", "viridiz", "did you mean 'viridis'"),
    ("mode", "surfel", "did you mean 'surfels'"),
    ("color_by", "lable", "expected one of solid"),
    ("point_size", NAN, "expected a number"),
    ("point_size", -1, "expected a number of at least"),
])
def test_wrong_styles_are_named(name, value, message):
    mesh = mesh_of(V=V)
    with pytest.raises(easypbr.ArgumentError, match=f"style.{name}.*{message}"):
        setattr(mesh.style, name, value)


def test_an_unknown_colormap_is_named():
    with pytest.raises(easypbr.UnknownNameError, match="viridiz.*did you mean 'viridis'"):
        easypbr.colormap("viridiz")


def drawn_share(mesh: Mesh, samples: int = 1) -> float:
    """Share of the picture that is not background. What is asked of the layers is that all of them are numbers."""
    scene = Scene()
    scene.show(mesh, "mesh")
    view = Viewer((200, 150), scene=scene)
    picture = view.render(samples=samples)
    for name, layer in view.layers(["normal_world", "depth", "albedo"]).items():
        assert np.isfinite(layer).all(), name
    return (picture[:, :, :3] != 217).any(axis=2).mean()


@pytest.mark.parametrize("positions", [np.zeros((0, 3)), None])
def test_an_empty_cloud_is_nothing_to_show(positions):
    mesh = Mesh() if positions is None else mesh_of(V=positions)
    with pytest.raises(easypbr.ArgumentError, match="nothing to show"):
        drawn_share(mesh)
    scene = Scene()
    scene.show(mesh, "empty")
    scene.show(shapes.box(), "box")
    assert Viewer((40, 30), scene=scene).render(samples=1)[15, 20, 0] != 217, "beside something else it is no error"


@pytest.mark.parametrize("count", [1, 9])
def test_points_at_one_place_are_a_dot(count):
    # A disc 8 pixels wide: 50 pixels, and it touches 69 where its centre is that of a pixel. Of those that its circle runs
    # through, some are too faint to count.
    assert 42 <= drawn_share(mesh_of(V=[[1, 2, 3]] * count)) * 200 * 150 <= 69


def test_numbers_beyond_single_precision_are_named():
    large = shapes.box()
    large.T_parent_mesh = np.diag([1e200, 1e200, 1e200, 1])
    with pytest.raises(easypbr.ArgumentError, match=r"mesh 'mesh': its pose in the world has numbers up to 1e\+200"):
        drawn_share(large)
    with pytest.raises(easypbr.ArgumentError, match=r"less than 1e\+150 apart, got \(0, 0, 1e\+300\)"):
        easypbr.Camera.look_at((0, 0, 1e300), (0, 0, 0))


@pytest.mark.parametrize("factor", [1e-12, 1e12])
def test_clouds_of_any_size_are_drawn(factor):
    # 50 discs 2.5 pixels wide, 1.5 % of the diagonal of a cube 100 pixels high: 5 pixels each, few of which hide each other.
    assert 0.005 < drawn_share(mesh_of(V=V * factor)) < 0.03


def some_nan(values: np.ndarray) -> np.ndarray:
    return with_row(values, slice(None, None, 3), NAN)


BALL = shapes.sphere(1, 32)
SURFELS = BALL.to_surfels()


@pytest.mark.parametrize("mesh, changed", [
    (BALL, {"N": some_nan(BALL.N)}),
    (BALL, {"N": 0 * BALL.N}),
    (BALL, {"C": some_nan(np.ones_like(BALL.V))}),
    (BALL, {"F": np.vstack([BALL.F, [[0, 0, 0]] * 9])}),
    (SURFELS, {"N": some_nan(SURFELS.N)}),
    (SURFELS, {"N": 0 * SURFELS.N}),
    (SURFELS, {"T": some_nan(SURFELS.T)}),
    (SURFELS, {"T": with_row(SURFELS.T, slice(None, None, 3), 0)}),
    (SURFELS, {"B": some_nan(SURFELS.B)}),
    (SURFELS, {"B": -SURFELS.B}),
    (mesh_of(V=BALL.V), {"N": some_nan(BALL.N)}),
    (mesh_of(V=BALL.V), {"N": 0 * BALL.N}),
    (mesh_of(V=BALL.V), {"C": some_nan(np.ones_like(BALL.V))}),
    (mesh_of(V=BALL.V), {"I": some_nan(BALL.V[:, 0])}),
    (mesh_of(V=BALL.V), {"scalars": {"nothing": np.full(len(BALL.V), NAN)}}),
])
def test_what_is_no_number_or_has_no_direction_leaves_the_rest(mesh, changed):
    odd = mesh.clone()
    odd.assign(**changed)
    usual = drawn_share(mesh)
    assert 0.8 * usual < drawn_share(odd) < 1.3 * usual


@pytest.mark.parametrize("points", [[], [[1, 2, 3]], [[1, 2, 3]] * 20])
def test_surfels_need_different_points(points):
    with pytest.raises(easypbr.ArgumentError, match="estimate_surfels: expected"):
        mesh_of(V=np.reshape(points, (-1, 3))).estimate_surfels()


def test_a_file_name_may_have_any_bytes(tmp_path, caplog):
    mesh = Mesh(V, None)
    folder = os.fsencode(tmp_path)
    path = os.fsdecode(folder + b"/caf\xe9.ply")
    mesh.save(path)
    read = Mesh(path)
    assert os.fsencode(read.name) == b"caf\xe9" and os.fsencode(read.source) == os.fsencode(path)
    assert "caf" in repr(read)
    scene = Scene()
    scene.show(read, read.name)
    assert scene.names() == [read.name] and scene.get(read.name) == read
    with pytest.raises(easypbr.FileError, match="No such file"):
        Mesh(os.fsdecode(folder + b"/gone\xe9.ply"))
    # Nor do names in a file need to be UTF-8: it is read with a warning that has one.
    with open(tmp_path / "a.obj", "wb") as file:
        file.write(b"mtllib gr\xfcn.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    assert len(Mesh(tmp_path / "a.obj").F) == 1
    assert "gr\udcfcn.mtl" in caplog.text


class NoArray:
    """What raises when numpy makes an array of it."""

    def __init__(self, error):
        self._error = error

    def __array__(self, dtype=None, copy=None):
        raise self._error


def uses_of_arrays(mesh, tmp_path):
    """Calls that take an array each."""
    return [
        lambda array: setattr(mesh, "V", array),
        lambda array: setattr(mesh, "L", array),
        lambda array: setattr(mesh, "T_parent_mesh", array),
        lambda array: mesh.assign(V=array),
        lambda array: easypbr.Mesh(array),
        lambda array: easypbr.Environment(array),
        lambda array: easypbr.save_image(array, tmp_path / "a.png"),
    ]


@pytest.mark.parametrize("error", [
    KeyboardInterrupt(), SystemExit(3), MemoryError("full"), OSError("gone"), RuntimeError("mine"),
])  # fmt: skip
def test_what_an_object_raises_while_it_becomes_an_array_passes(square, tmp_path, error):
    mesh = easypbr.Mesh(*square)
    for use in uses_of_arrays(mesh, tmp_path):
        with pytest.raises(type(error)) as raised:
            use(NoArray(error))
        assert raised.value is error
    np.testing.assert_array_equal(mesh.V, square[0])
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("error", [TypeError("n\u00f6"), ValueError("n\u00f6"), OverflowError("n\u00f6")])
def test_what_is_no_array_is_the_cause_of_an_argument_error(square, tmp_path, error):
    for use in uses_of_arrays(easypbr.Mesh(*square), tmp_path):
        with pytest.raises(easypbr.ArgumentError, match=": expected an array of numbers: n\u00f6$") as raised:
            use(NoArray(error))
        assert raised.value.__cause__ is error


@pytest.mark.parametrize("error", [BufferError("on a GPU"), RuntimeError("on a GPU")])
def test_dlpack_that_numpy_does_not_take_is_an_argument_error(square, error):
    class OfDlpack:
        def __dlpack_device__(self):
            return (1, 0)

        def __dlpack__(self, **_):
            raise error

    with pytest.raises(easypbr.ArgumentError, match="a .*OfDlpack: expected numbers that numpy takes by DLPack: on a GPU"):
        easypbr.Mesh(*square).V = OfDlpack()
    with pytest.raises(easypbr.ArgumentError, match="on a GPU") as raised:
        easypbr.as_mesh(OfDlpack())
    assert raised.value.__cause__ is error


def test_scalars_that_float32_does_not_tell_apart_are_a_warning(caplog):
    cloud = Mesh()
    cloud.V = np.random.default_rng(1).random((1000, 3))
    cloud.add_scalar("heat", np.linspace(0, 1, 1000))
    cloud.add_scalar("small", np.arange(1000) + 2**24 - 1000)
    assert not caplog.text
    cloud.add_scalar("stamp", 1.7e9 + np.linspace(0, 60, 1000))
    assert caplog.text.count("'stamp'") == 1 and "subtract an offset" in caplog.text
    caplog.clear()
    cloud.scalars["id"] = np.full(1000, 5, np.int64) + np.arange(1000) * 2**40 + 1
    assert caplog.text.count("'id'") == 1


@pytest.mark.parametrize("values, text", [
    (10**18 + np.arange(10), "holds 1000000000000000000 and 1000000000000000001 as one number"),
    (np.uint64(2**63) + np.arange(10, dtype=np.uint64), "holds 9223372036854775808 and 9223372036854775809 as one number"),
    (np.array([7, 2**53 + 1]), "holds 9007199254740993 as 9007199254740992"),
], ids=["int64", "uint64", "one"])
def test_integers_beyond_double_precision_are_a_warning(caplog, values, text):
    easypbr.as_mesh({"points": np.random.default_rng(0).random((len(values), 3)), "id": values})
    assert caplog.text.count("scalars 'id' are kept as float32") == 1 and text in caplog.text


def test_values_of_arrows_that_float32_does_not_tell_apart_are_a_warning(caplog):
    starts = np.random.default_rng(0).random((10, 3))
    easypbr.shapes.arrows(starts, starts, values=np.arange(10.0))
    assert not caplog.text
    easypbr.shapes.arrows(starts, starts, values=1.7e9 + np.arange(10) * 0.1)
    assert caplog.text.count("scalars 'value' are kept as float32, which holds 1700000000 and 1700000000.1 as one number") == 1


def test_intensities_that_float32_does_not_tell_apart_are_a_warning(caplog, tmp_path):
    stamps = 1.7e9 + np.linspace(0, 60, 1000)
    points = np.random.default_rng(1).random((1000, 3))
    cloud = Mesh(points)
    cloud.I = stamps - stamps[0]
    cloud.I = stamps.astype(np.float32)
    assert not caplog.text
    np.save(tmp_path / "stamps.npy", np.column_stack([points, stamps]))

    def assign():
        cloud.I = stamps

    for make in (assign, lambda: easypbr.as_mesh(np.column_stack([points, stamps])), lambda: Mesh(tmp_path / "stamps.npy")):
        caplog.clear()
        make()
        assert caplog.text.count("intensities are kept as float32") == 1 and "subtract an offset" in caplog.text

"""Labels, label maps, scalars and the colours they become."""
import numpy as np
import pytest

import easypbr
from easypbr import LabelMap, Mesh


def square() -> Mesh:
    """Two triangles over the corners of a unit square."""
    return Mesh(V=[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], F=[[0, 1, 2], [0, 2, 3]])


def test_labels_belong_to_vertices_or_faces():
    mesh = square()
    mesh.L = np.array([0, 1, 1, 2], np.uint8)
    assert mesh.L.tolist() == [0, 1, 1, 2] and mesh.L.dtype == np.int32
    mesh.L = [5, -1]
    assert mesh.L.tolist() == [5, -1]
    mesh.L = np.array([True, False])
    assert mesh.L.tolist() == [1, 0]
    mesh.L = None
    assert len(mesh.L) == 0


@pytest.mark.parametrize("labels, message", [
    (np.zeros((4, 20), np.float32), r"mesh array L: expected n labels, got 4 x 20; scores of classes.*argmax\(-1\)"),
    (np.zeros((1, 4, 20)), "got 1 x 4 x 20; .*argmax"),
    (np.array([0.1, 0.7, 0.2, 0.0]), "mesh array L: expected whole numbers .*got others in 4 float64; .*argmax"),
    (np.array([0, 2, np.nan, 1]), "got others in 4 float64; NaN is no label: give -1"),
    ([1, 2, 3], "mesh array L: expected 4 rows, one per vertex, or 2, one per face, or none; got 3 x 1"),
    (["road"] * 4, "mesh array L: expected numbers, got dtype <U4"),
    (np.full(4, 2**31, np.uint32), "mesh array L: expected whole numbers from -2147483648 to 2147483647"),
])
def test_what_is_no_label_is_refused(labels, message):
    with pytest.raises(easypbr.ArgumentError, match=message):
        square().L = labels


def test_logits_are_told_by_their_shape_alone():
    class Tensor:
        """As a tensor that needs a gradient: it refuses to become an array."""

        shape = (4, 20)

        def __array__(self):
            raise RuntimeError("detach it first")

    with pytest.raises(easypbr.ArgumentError, match="argmax"):
        square().L = Tensor()


def test_label_maps_have_names_and_colours():
    plain = LabelMap(["road", "car"])
    assert plain.labels == [0, 1] and plain.names == ["road", "car"] and len(plain) == 2
    assert plain.colors.dtype == np.uint8 and plain.colors.shape == (2, 3)
    assert tuple(plain.colors[1]) == plain.color_of(1)
    assert 1 in plain and 2 not in plain
    sparse = LabelMap({252: "moving", 0: "none"}, colors=["#ff0000", "black"], unlabelled=0, name="motion")
    assert sparse.labels == [0, 252] and sparse.color_of(252) == (255, 0, 0)
    assert (sparse.name, sparse.unlabelled, sparse.unknown) == ("motion", 0, "refused")
    assert repr(sparse) == "<easypbr.LabelMap 'motion': 2 labels from 0 to 252>"
    numbers = np.array([[0, 128, 255], [1, 2, 3]], np.uint8)
    assert LabelMap(["a", "b"], numbers, labels=[7, 3]).color_of(7) == (0, 128, 255)
    assert LabelMap(["a", "b"], numbers / 255).colors.tolist() == numbers.tolist()
    assert LabelMap.semantic_kitti().color_of(10) == (100, 150, 245)
    assert LabelMap.cityscapes_train().name_of(255) == "unlabeled"


@pytest.mark.parametrize("numbers", [
    [(1, 0, 0), (0, 1, 0)],
    [(1.0, 0, 0), (0, 1, 0)],
    [(255, 0, 0), (0, 255, 0)],
    [(255.0, 0, 0), (0, 255, 0)],
    np.array([(1, 0, 0), (0, 1, 0)], np.uint8),
    np.array([(65535, 0, 0), (0, 65535, 0)], np.uint16),
], ids=["int 1", "float 1", "int 255", "float 255", "uint8", "uint16"])  # fmt: skip
def test_colors_of_label_maps_are_those_of_meshes(numbers):
    mesh = Mesh(np.eye(3)[:2])
    mesh.C = numbers
    # To the nearest of 256 codes.
    np.testing.assert_array_equal(LabelMap(["a", "b"], numbers).colors, np.rint(mesh.C * 255))


@pytest.mark.parametrize("arguments, message", [
    ({"names": []}, "expected classes, got none"),
    ({"names": ["a"], "colors": np.zeros((2, 3))}, "expected a colour for each of 1 classes, got 2"),
    ({"names": ["a"], "colors": np.zeros((1, 4))}, "expected texts or an n x 3 array, got 1 x 4 float64"),
    ({"names": ["a"], "colors": [[0, 0, 256]]}, "LabelMap colors, .* expected 0 to 1 or 0 to 255, got 0 to 256"),
    ({"names": ["a"], "colors": [[0, 0, 1.5]]}, "LabelMap colors, .* expected 0 to 1 or 0 to 255, got 0 to 1.5"),
    ({"names": ["a"], "colors": [[0, -1, 0]]}, "LabelMap colors, .* expected 0 to 1 or 0 to 255, got -1 to 0"),
    ({"names": ["a"], "colors": [[0, np.nan, 0]]}, "LabelMap colors: expected finite numbers"),
    ({"names": ["a"], "colors": ["magneta"]}, "did you mean 'magenta'"),
    ({"names": ["a"], "labels": [1, 2]}, "expected a label for each of 1 names, got 2"),
    ({"names": ["a", "b"], "labels": [1, 1]}, "label 1 occurs twice"),
    ({"names": ["a"], "unlabelled": 3}, "the unlabelled class 3 is not among"),
    ({"names": [1, 2]}, r"LabelMap names: expected a list of texts, got \[1, 2\]"),
    ({"names": 3}, "LabelMap names: expected a list of texts, got 3"),
    ({"names": {"a": "b"}}, "LabelMap names: expected labels of 32 bits as keys, got 'a'"),
    ({"names": {2**40: "b"}}, "LabelMap names: expected labels of 32 bits as keys, got 1099511627776"),
    ({"names": {1: 2}}, "LabelMap names: expected texts, got 2"),
    ({"names": ["a", "b"], "colors": ["red", 3]}, "LabelMap colors: expected texts, got 3"),
    ({"names": ["a"], "unknown": "ignored"}, "expected 'refused' or 'unlabelled', got 'ignored'"),
])
def test_bad_label_maps_are_refused(arguments, message):
    with pytest.raises(easypbr.ArgumentError, match=message):
        LabelMap(**arguments)


def test_a_mesh_has_a_label_map():
    mesh = square()
    assert mesh.label_map is None
    mesh.label_map = "cityscapes"
    assert mesh.label_map.name_of(7) == "road"
    with pytest.raises(easypbr.UnknownNameError, match="did you mean 'cityscapes'"):
        mesh.label_map = "cityscape"
    with pytest.raises(easypbr.ArgumentError, match="expected a LabelMap"):
        mesh.label_map = 3
    with pytest.raises(easypbr.UnknownNameError, match="label 99 is not in"):
        mesh.label_map.name_of(99)
    with pytest.raises(easypbr.ArgumentError, match="label 99 in row 1 of 4 is not in the label map 'cityscapes'"):
        mesh.L = [0, 99, 1, 2]
    mesh.assign(L=[0, 99, 1, 2], label_map=LabelMap(["a"], unknown="unlabelled"))
    mesh.label_map = None
    assert mesh.label_map is None


def test_label_maps_are_files(tmp_path):
    LabelMap.scannet().save(tmp_path / "map.json")
    back = LabelMap.load(tmp_path / "map.json")
    assert back.names == LabelMap.scannet().names and (back.colors == LabelMap.scannet().colors).all()
    mesh = square()
    mesh.label_map = tmp_path / "map.json"
    assert mesh.label_map.name_of(1) == "wall"
    (tmp_path / "bad.txt").write_text("0 road 1 2\n")
    with pytest.raises(easypbr.FormatError, match="line 1"):
        LabelMap.load(tmp_path / "bad.txt")
    with pytest.raises(easypbr.FileError):
        LabelMap.load(tmp_path / "none.txt")


@pytest.mark.parametrize("flags", [
    [True, False, True, True], np.array([True, False, True, True]), np.array([[1], [0], [1], [1]], bool), "torch",
], ids=["list", "array", "column", "torch"])  # fmt: skip
def test_booleans_are_labels_and_scalars(flags):
    if isinstance(flags, str):
        flags = pytest.importorskip("torch").tensor([True, False, True, True])
    mesh = square()
    mesh.add_scalar("a", flags)
    mesh.scalars["b"] = flags
    assert mesh.scalars["a"].tolist() == mesh.scalars["b"].tolist() == [1, 0, 1, 1]
    mesh.assign(scalars={"c": flags}, L=flags)
    assert mesh.scalars["c"].tolist() == mesh.L.tolist() == [1, 0, 1, 1]


def test_scalars_have_names():
    mesh = square()
    mesh.add_scalar("height", [0, 1, 2, 3])
    mesh.add_scalar("area", np.array([[0.5], [np.nan]]))
    assert list(mesh.scalars) == ["height", "area"]
    assert mesh.scalars["height"].dtype == np.float32 and not mesh.scalars["height"].flags.writeable
    mesh.add_scalar("height", [3, 2, 1, 0])
    assert mesh.scalars["height"].tolist() == [3, 2, 1, 0]
    mesh.remove_scalar("height")
    with pytest.raises(easypbr.UnknownNameError, match="has no scalars 'aria' .did you mean 'area'"):
        mesh.remove_scalar("aria")
    mesh.scalars = {"x": [1, 2]}
    assert list(mesh.scalars) == ["x"]
    mesh.assign(scalars={"y": [1, 2, 3, 4]}, L=[0, 0, 1, 1])
    assert list(mesh.scalars) == ["y"]
    mesh.scalars = None
    assert mesh.scalars == {}
    mesh.scalars["z"] = [5, 6]
    assert mesh.scalars["z"].tolist() == [5, 6] and "z" in mesh.scalars and "x" not in mesh.scalars
    del mesh.scalars["z"]
    assert len(mesh.scalars) == 0
    with pytest.raises(KeyError):
        del mesh.scalars["z"]
    with pytest.raises(easypbr.ArgumentError, match="scalars"):
        mesh.scalars["z"] = [1, 2, 3]
    mesh.scalars.update({"a": [1, 2]}, b=[3, 4])
    with pytest.raises(easypbr.ArgumentError, match="scalars"):
        mesh.scalars.update({"a": [5, 6], "c": [1, 2], "d": [1, 2, 3]})
    assert {name: values.tolist() for name, values in mesh.scalars.items()} == {"a": [1, 2], "b": [3, 4]}


@pytest.mark.parametrize("values, message", [
    ([1, 2, 3], r"mesh array scalars\['t'\]: expected 4 rows, one per vertex, or 2, one per face.*got 3 x 1"),
    (np.zeros((4, 2)), r"mesh array scalars\['t'\]: expected n numbers, got 4 x 2 float64"),
    (["a"] * 4, r"mesh array scalars\['t'\]: expected numbers, got dtype <U1"),
])
def test_bad_scalars_are_refused(values, message):
    with pytest.raises(easypbr.ArgumentError, match=message):
        square().add_scalar("t", values)


def test_bad_scalar_dicts_are_refused():
    with pytest.raises(easypbr.ArgumentError, match="expected a dict of name to values"):
        square().scalars = [1, 2]
    with pytest.raises(easypbr.ArgumentError, match="expected a name for array 0"):
        square().add_scalar("", [1, 2, 3, 4])


def test_styles_choose_colours():
    mesh = square()
    mesh.style.color_by = "scalar"
    mesh.style.scalar = "t"
    mesh.style.colormap = "coolwarm"
    mesh.style.nan_color = "#ff0000"
    assert (mesh.style.color_by, mesh.style.scalar, mesh.style.colormap) == ("scalar", "t", "coolwarm")
    with pytest.raises(easypbr.ArgumentError, match="did you mean 'viridis'"):
        mesh.style.colormap = "virids"


@pytest.mark.parametrize("name", ["viridis", "plasma", "inferno", "magma", "turbo", "cividis"])
def test_colour_tables_are_matplotlibs(name):
    """All 256 entries, rounded to the nearest code (matplotlib's own 8-bit tables are cut off instead)."""
    matplotlib = pytest.importorskip("matplotlib")
    assert (easypbr.colormap(name) == np.rint(np.array(matplotlib.colormaps[name].colors) * 255)).all()


def test_colormaps_have_names():
    assert easypbr.colormap("grey").tolist() == [[i, i, i] for i in range(256)]
    with pytest.raises(easypbr.UnknownNameError, match="no colormap 'rainbows'"):
        easypbr.colormap("rainbows")
    with pytest.raises(easypbr.UnknownNameError, match="did you mean 'plasma'"):
        easypbr.colormap("plasme")

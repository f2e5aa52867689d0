"""Structured arrays, packed colours and organised clouds: as those of files."""

import numpy as np
import pytest
from test_inputs import COLORS, POINTS, frame

import easypbr
from easypbr import Mesh, as_mesh

#: Red with alpha 255, whose float is none; green and blue with alpha 128 and 0.
PACKED = np.array([0xFFFF0000, 0x8000FF00, 0x000000FF] * 13 + [0xFFFFFFFF], "u4")
UNPACKED = np.array([[255, 0, 0], [0, 255, 0], [0, 0, 255]] * 13 + [[255, 255, 255]]) / 255


def structured(dtype, **fields):
    array = np.zeros(40, dtype)
    for name, values in fields.items():
        array[name] = values
    return array


def assert_same(made, read):
    for name in ("V", "N", "C", "L", "I"):
        np.testing.assert_allclose(getattr(made, name), getattr(read, name), atol=1e-7, err_msg=name)
    assert list(made.scalars) == list(read.scalars)
    for name, values in read.scalars.items():
        np.testing.assert_array_equal(made.scalars[name], values)


@pytest.mark.parametrize("order", "<>")
def test_structured_arrays_are_read_as_their_file(order, tmp_path):
    types = [("ring", order + "u2"), *((name, order + "f4") for name in ("x", "y", "z", "intensity")), ("label", order + "i4"),
             ("normals", order + "f4", 3), ("rgb", "u1", 3), ("pair", order + "f8", 2)]
    array = structured(types, ring=np.arange(40), intensity=POINTS[:, 0], label=np.arange(40) % 3, rgb=COLORS,
                       normals=POINTS / np.linalg.norm(POINTS, axis=1, keepdims=True), pair=POINTS[:, :2],
                       **dict(zip("xyz", POINTS.T)))
    np.save(tmp_path / "points.npy", array)
    read = Mesh(tmp_path / "points.npy")
    for what in (array, array.view(np.recarray), array.reshape(8, 5), np.ma.array(array), [array]):
        made = as_mesh(what)
        assert_same(made, read)
        np.testing.assert_array_equal(made.scalars["ring"], np.arange(40))
        np.testing.assert_allclose(made.C, COLORS / 255, atol=1e-7)
    assert len(as_mesh([array, array]).children) == 2


@pytest.mark.parametrize("type", ["<f4", ">f4", "<u4", "<i4"])
@pytest.mark.parametrize("name", ["rgb", "rgba"])
def test_packed_colors(name, type):
    """Of structured arrays and of tables. Named parts come first, and a column of eight bytes is none."""
    bits = PACKED.astype(PACKED.dtype.newbyteorder(type[0])).view(type)
    array = structured([("xyz", "f4", 3), (name, type)], xyz=POINTS)
    array[name] = bits
    for what in (array, frame(dict(zip("xyz", POINTS.T)) | {name: bits})):
        mesh = as_mesh(what)
        np.testing.assert_allclose(mesh.C[:, :3], UNPACKED, atol=1e-7)
        assert mesh.C.shape[1] == len(name) and not mesh.scalars
        np.testing.assert_allclose(mesh.C[:3, 3:], np.array([[255], [128], [0]])[:, : len(name) - 3] / 255, atol=1e-7)
    named = dict(zip("xyz", POINTS.T)) | {name: bits} | dict(zip("rgb", COLORS.T))
    np.testing.assert_allclose(as_mesh(frame(named)).C, COLORS / 255, atol=1e-6)
    assert list(as_mesh(frame(dict(zip("xyz", POINTS.T)) | {name: PACKED.astype(float)})).scalars) == [name]


def test_organised_points_are_a_cloud(tmp_path):
    """Rows of pixels, of which those without a measurement are left out."""
    points = POINTS.reshape(8, 5, 3).astype(np.float32)
    points[2, 3] = np.nan
    np.save(tmp_path / "points.npy", points)
    made = as_mesh(points)
    assert_same(made, Mesh(tmp_path / "points.npy"))
    assert len(made.V) == 39
    with_intensity = np.dstack([points, np.arange(40).reshape(8, 5) / 8])
    np.testing.assert_array_equal(as_mesh(with_intensity).I, np.delete(np.arange(40) / 8, 13))


# Masked values.


def masked(**masks):
    """Points with a whole number, a label and a colour each, some of which are masked."""
    array = np.ma.array(structured([("xyz", "f4", 3), ("count", "u2"), ("intensity", "i4"), ("label", "u1"), ("rgb", "u4")],
                                   xyz=POINTS, count=np.arange(40), label=2, rgb=PACKED, intensity=7))
    for name, rows in masks.items():
        array.mask[name][rows] = True
    return array


def test_masked_points_of_structured_arrays_are_left_out(caplog):
    every = dict.fromkeys(("xyz", "count", "intensity", "label", "rgb"), [0, 39])
    for what in (masked(**every), masked(**every).reshape(8, 5)):
        mesh = as_mesh(what)
        np.testing.assert_allclose(mesh.V, POINTS[1:39], atol=1e-7)
        np.testing.assert_array_equal(mesh.scalars["count"], np.arange(1, 39))
        np.testing.assert_allclose(mesh.C, UNPACKED[1:39], atol=1e-7)
        assert (mesh.L == 2).all() and (mesh.I == 7).all()
    assert caplog.text.count("2 of 40 points have no finite position") == 2
    with pytest.raises(easypbr.ArgumentError, match="the 2 that have none"):
        as_mesh(masked(**every), strict=True)


def test_masked_coordinates_of_whole_numbers_are_left_out():
    columns = {name: np.ma.array(np.arange(40), mask=np.arange(40) == row) for row, name in enumerate("xyz")}
    array = structured([(name, "i4") for name in "xyz"], **{name: values.data for name, values in columns.items()})
    array = np.ma.array(array, mask=list(zip(*(values.mask for values in columns.values()))))
    for what in (array, frame(columns)):
        np.testing.assert_array_equal(as_mesh(what).V[:, 0], np.arange(3, 40))


def test_masked_numbers_of_points_are_missing():
    mesh = as_mesh(masked(count=[3], intensity=[4]))
    assert len(mesh.V) == 40
    np.testing.assert_array_equal(np.flatnonzero(np.isnan(mesh.scalars["count"])), [3])
    np.testing.assert_array_equal(np.flatnonzero(np.isnan(mesh.I)), [4])


@pytest.mark.parametrize("name, what", [("label", "labels"), ("rgb", "colours")])
def test_masked_labels_and_colors_of_points_are_refused(name, what):
    with pytest.raises(easypbr.ArgumentError, match=f"{name}: expected {what} of all points, got 2 masked values"):
        as_mesh(masked(**{"xyz": [5], name: [3, 4, 5]}))

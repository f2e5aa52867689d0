"""Files of point clouds that other programs wrote: numpy, text. The formats themselves are tested in C++."""

import numpy as np
import pytest

import easypbr
from easypbr import Mesh


@pytest.fixture
def points():
    return np.random.default_rng(1).normal(size=(1000, 3)).astype(np.float32)


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("dtype", ["<f4", ">f4", "<f8", ">f8", "<f2", "<i4", ">i2", "|i1", "<i8"])
def test_numpy_arrays_of_every_type(points, tmp_path, dtype, order):
    given = np.asarray(points * 20, dtype=dtype, order=order)
    np.save(tmp_path / "a.npy", given)
    np.testing.assert_array_equal(Mesh(tmp_path / "a.npy").V, given.astype(np.float32))


def test_structured_array(points, tmp_path):
    table = np.zeros(1000, [("xyz", "<f4", 3), ("rgb", "u1", 3), ("heat", "<f8"), ("label", "<i8")])
    table["xyz"], table["rgb"] = points, np.arange(3000).reshape(1000, 3) % 256
    table["heat"], table["label"] = points[:, 0], np.arange(1000)
    np.save(tmp_path / "a.npy", table)
    mesh = Mesh(tmp_path / "a.npy")
    np.testing.assert_array_equal(mesh.V, points)
    np.testing.assert_array_equal(np.round(mesh.C * 255), table["rgb"])
    np.testing.assert_array_equal(mesh.L, table["label"])
    np.testing.assert_array_equal(mesh.scalars["heat"], points[:, 0])


@pytest.mark.parametrize("save", [np.savez, np.savez_compressed])
def test_archives_of_named_arrays(points, tmp_path, save):
    faces = np.arange(999).reshape(333, 3)
    colors = np.random.default_rng(2).random((1000, 3))
    save(tmp_path / "a.npz", points=points.astype(float), faces=faces, colors=colors, heat=points[:, 1],
         area=np.arange(333.0), objects=np.array([{}, []], dtype=object))
    mesh = Mesh(tmp_path / "a.npz")
    np.testing.assert_array_equal(mesh.V, points)
    np.testing.assert_array_equal(mesh.F, faces)
    np.testing.assert_array_equal(mesh.C, colors.astype(np.float32))
    np.testing.assert_array_equal(mesh.scalars["heat"], points[:, 1])
    np.testing.assert_array_equal(mesh.scalars["area"], np.arange(333))


def test_names_of_one_letter_are_those_of_dicts(points, tmp_path):
    values = {letter: points[:, 0] + number for number, letter in enumerate("abcdeghijklmnopqrstuwxyz")}
    np.savez(tmp_path / "a.npz", points=points, **values)
    read, made = Mesh(tmp_path / "a.npz").scalars, easypbr.as_mesh({"points": points} | values).scalars
    assert set(read) == set(made) == set(values)
    for letter in values:
        np.testing.assert_array_equal(read[letter], made[letter])


def test_numpy_reads_what_is_written(points, tmp_path):
    mesh = Mesh()
    mesh.V = points + np.array([691_000.0, 5_335_000, 520])
    mesh.C = np.tile(np.array([[255, 128, 0]], np.uint8), (1000, 1))
    mesh.I = points[:, 0]
    mesh.scalars["heat"] = points[:, 1]
    mesh.save(tmp_path / "a.npz")
    archive = np.load(tmp_path / "a.npz")
    assert sorted(archive) == ["C", "I", "V", "heat", "offset"]
    np.testing.assert_array_equal(archive["V"], mesh.V)
    np.testing.assert_array_equal(archive["offset"], mesh.offset)
    mesh.save(tmp_path / "a.npy")
    table = np.load(tmp_path / "a.npy")
    assert table.dtype.names == ("x", "y", "z", "red", "green", "blue", "intensity", "heat")
    np.testing.assert_array_equal(table["y"], mesh.offset[1] + mesh.V[:, 1].astype(float))
    np.testing.assert_array_equal(table["green"], 128)
    mesh.save(tmp_path / "a.xyz")
    np.testing.assert_array_equal(np.loadtxt(tmp_path / "a.xyz")[:, 0], table["x"])
    mesh.save(tmp_path / "a.csv")
    text = np.genfromtxt(tmp_path / "a.csv", delimiter=",", names=True)
    np.testing.assert_array_equal(text["heat"].astype(np.float32), points[:, 1])


def test_text_that_numpy_wrote(points, tmp_path):
    np.savetxt(tmp_path / "a.txt", points)
    np.testing.assert_array_equal(Mesh(tmp_path / "a.txt").V, points)
    np.savetxt(tmp_path / "a.csv", points, delimiter=",", header="x,y,z")
    np.testing.assert_array_equal(Mesh(tmp_path / "a.csv").V, points)


def test_errors_are_python_errors(tmp_path):
    (tmp_path / "a.pcd").write_text("VERSION 0.7\nFIELDS x y z\n")
    with pytest.raises(easypbr.FormatError, match="a.pcd:3: the file ends before its line 'DATA'"):
        Mesh(tmp_path / "a.pcd")
    with pytest.raises(ValueError, match="a.las.*empty"):
        (tmp_path / "a.las").write_bytes(b"")
        Mesh(tmp_path / "a.las")


def test_clouds_are_listed_among_what_is_read():
    for extension in ("pcd", "xyz", "pts", "csv", "txt", "asc", "npy", "npz", "las", "bin"):
        assert extension in easypbr._easypbr.readable_mesh_extensions()


def test_numpy_reads_names_of_scalars_in_other_letters(tmp_path):
    cloud = Mesh()
    cloud.V = np.random.default_rng(1).random((5, 3))
    cloud.scalars.update({"温度": np.arange(5), "湿度": np.arange(5) + 1})
    cloud.save(tmp_path / "c.npy")
    cloud.save(tmp_path / "c.npz")
    rows, arrays = np.load(tmp_path / "c.npy"), np.load(tmp_path / "c.npz")
    for number, name in enumerate(["温度", "湿度"]):
        assert (rows[name] == np.arange(5) + number).all() and (arrays[name] == rows[name]).all()


CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)


@pytest.mark.parametrize("few, most", [(CORNERS, 0.01), (np.random.default_rng(0).uniform(-1, 1, (17, 3)), 0.02),
                                       (np.random.default_rng(0).normal(size=(100, 3)), 0.12)])
def test_few_points_are_dots(few, most):
    """Each 4 to 10 pixels wide: 12 to 80 pixels of 320 x 240, less those that hide each other. None is cut at the border."""
    drawn = easypbr.render(few, size=(320, 240), background="transparent")[..., 3] > 0
    assert 6 * len(few) / drawn.size < drawn.mean() < most
    assert not (drawn[[0, -1]].any() or drawn[:, [0, -1]].any())


def test_points_beside_a_mesh_leave_it_seen():
    mesh = easypbr.shapes.sphere(1, 64)
    points = np.random.default_rng(0).uniform(-1, 1, (17, 3)) * 1.2
    scene = easypbr.Scene()
    scene.show(mesh, "mesh")
    scene.show(Mesh(points), "points")
    seen = easypbr.Viewer((320, 240), scene=scene).layers(["object_id"])["object_id"]
    # "mesh" comes before "points". The discs are less than a thirtieth of the ball's picture, as 17 of 10 pixels are of 20,000.
    assert (seen == 1).sum() > 10 * (seen == 2).sum() > 0


def test_a_small_cloud_in_a_large_scene_is_seen():
    scene = easypbr.Scene()
    scene.show(easypbr.shapes.sphere(1, 64), "mesh")
    scene.show(Mesh(np.array([[0, 0, 1.1], [0.02, 0, 1.1], [0, 0.02, 1.1]])), "points")
    seen = easypbr.Viewer((640, 480), scene=scene).layers(["object_id"])["object_id"]
    # Discs of 1.5 % of 0.03 would be a tenth of a pixel; three of 5 pixels, 4 apart, are 40 to 60 pixels.
    assert (seen == 2).sum() > 20


def test_surfels_of_a_flattened_ball_do_not_shadow_themselves():
    ball = easypbr.shapes.sphere(1, 48).sample_surface(4000).estimate_surfels()
    ball.T_parent_mesh = np.diag([4, 4, 0.4, 1.0])

    def light(shadows):
        settings = {"ssao.enabled": False, "ground.mode": "none", "background.mode": "transparent", "shadows.enabled": shadows}
        return easypbr.render(ball, size=(160, 120), mode="raster", settings=settings)[..., 1].sum(dtype=float)

    # A convex body has no shadow on itself; 0.3 %: neighbours at the rim of the light.
    assert light(True) > 0.995 * light(False)

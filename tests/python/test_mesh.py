import copy
import gc
import pickle
from pathlib import Path

import numpy as np
import pytest

import easypbr
from easypbr import Material, Mesh, auto

LIGHT = easypbr.Light("point", intensity=3)


@pytest.mark.parametrize("dtype", ["float16", "float32", "float64", "int8", "int32", "int64", "uint8", ">f8", ">i4"])
def test_positions_of_any_numeric_type_become_float32(square, dtype):
    V, F = square
    mesh = Mesh(V.astype(dtype), F)
    assert mesh.V.dtype == np.float32
    np.testing.assert_array_equal(mesh.V, V)


@pytest.mark.parametrize("dtype", ["int8", "int32", "int64", "uint8", "uint16", "uint64", "float64"])
def test_indices_of_any_numeric_type_become_int32(square, dtype):
    V, F = square
    mesh = Mesh(V, F.astype(dtype))
    assert mesh.F.dtype == np.int32
    np.testing.assert_array_equal(mesh.F, F)


@pytest.mark.parametrize("records", [
    [("x", "u1"), ("a", "f4")],
    [("a", "f8"), ("x", "f4")],
    [("x", "u1"), ("a", "i2"), ("y", "u1", 2)],
])
def test_fields_of_packed_records(square, records):
    values = np.zeros(4, records)
    values["a"] = [1, 2, 3, 4]
    mesh = Mesh(*square)
    mesh.I = values["a"]
    mesh.add_scalar("a", values["a"])
    assert mesh.I.tolist() == mesh.scalars["a"].tolist() == [1, 2, 3, 4]


def test_strided_and_column_major_arrays_and_lists(square):
    V, F = square
    wide = np.zeros((4, 6))
    wide[:, ::2] = V
    for given in (np.asfortranarray(V), wide[:, ::2], V[::-1][::-1], V.tolist()):
        np.testing.assert_array_equal(Mesh(given, F).V, V)


def test_messages_name_the_array_and_both_shapes(square):
    V, F = square
    with pytest.raises(easypbr.ArgumentError, match=r"V: expected n x 3, got 4 x 2 float64"):
        Mesh(V[:, :2], F)
    with pytest.raises(ValueError, match=r"F: expected n x 3, got 3 int64"):
        Mesh(V, F[0])
    with pytest.raises(ValueError, match=r"array N: expected 4 rows.*got 2 x 3"):
        Mesh(V, F).N = np.ones((2, 3))
    with pytest.raises(ValueError, match=r"F: expected vertex indices from 0 to 3, got 4"):
        Mesh(V, F + 1)
    with pytest.raises(ValueError, match=r"V: expected numbers, got dtype"):
        Mesh(np.array([["a", "b", "c"]]), F)
    with pytest.raises(ValueError, match=r"V: expected finite positions"):
        Mesh(V * np.nan, F)


@pytest.mark.parametrize("value", [2**31, -(2**31) - 1, 0.5])
def test_indices_that_no_int32_holds_are_refused(square, value):
    V, _ = square
    with pytest.raises(ValueError, match="F: expected whole numbers from -2147483648 to 2147483647"):
        Mesh(V, np.array([[0, 1, value]]))


def test_views_are_read_only_and_outlive_the_mesh(square):
    V, F = square
    mesh = Mesh(V, F)
    view = mesh.V
    with pytest.raises(ValueError, match="read-only"):
        view[0, 0] = 7
    assert view.ctypes.data == mesh.V.ctypes.data
    mesh.V = V + 1
    del mesh
    gc.collect()
    # Memory that was freed would be taken by these.
    others = [np.full((4, 3), 9, dtype=np.float32) for _ in range(1000)]
    np.testing.assert_array_equal(view, V)
    assert len(others) == 1000


def test_assignment_copies(square):
    V, F = square
    mesh = Mesh(V.astype(np.float32), F)
    given = V.astype(np.float32)
    mesh.V = given
    given[:] = 5
    np.testing.assert_array_equal(mesh.V, V)


def test_every_array_is_read_back(square):
    V, F = square
    mesh = Mesh(V, F)
    values = {
        "N": np.tile([0, 0, 1.0], (4, 1)),
        "UV": V[:, :2],
        "T": np.tile([1.0, 0, 0], (4, 1)),
        "B": np.arange(4.0),
        "L": np.arange(4),
        "I": np.arange(4.0) / 4,
        "E": [[0, 1], [1, 2]],
        "C": np.ones((4, 4)) / 2,
    }
    for name, value in values.items():
        setattr(mesh, name, value)
        np.testing.assert_array_equal(getattr(mesh, name), value)
        setattr(mesh, name, None)
        assert len(getattr(mesh, name)) == 0


def test_byte_colors_are_scaled(square):
    V, F = square
    mesh = Mesh(V, F)
    mesh.C = np.array([[0, 51, 255]] * 4, dtype=np.uint8)
    # 51 / 255 = 0.2; the nearest float is at most 2^-26 away, twice rounded.
    np.testing.assert_allclose(mesh.C[0], [0, 0.2, 1], atol=1e-7)


CODES = np.array([[255, 0, 51], [0, 204, 0], [102, 0, 255], [255, 255, 255]])


@pytest.mark.parametrize("given", [
    CODES, CODES.tolist(), CODES.astype(np.int32), CODES.astype(np.int16), CODES.astype(np.uint64), CODES.astype(np.float32),
    CODES.astype(float), CODES.astype(np.uint8), CODES / 255, (CODES * 257).astype(np.uint16),
], ids=["int64", "list", "int32", "int16", "uint64", "float32", "float64", "uint8", "0 to 1", "uint16"])  # fmt: skip
def test_colors_of_any_type_are_0_to_1(square, given, tmp_path):
    mesh = Mesh(*square)
    mesh.C = given
    np.testing.assert_allclose(mesh.C, CODES / 255, atol=1e-7)
    mesh.C = None
    mesh.assign(C=given)
    np.testing.assert_allclose(mesh.C, CODES / 255, atol=1e-7)
    np.testing.assert_allclose(easypbr.as_mesh({"points": square[0], "colors": given}).C, CODES / 255, atol=1e-7)
    np.savez(tmp_path / "colors.npz", points=square[0], colors=given)
    np.testing.assert_allclose(Mesh(tmp_path / "colors.npz").C, CODES / 255, atol=1e-7)


@pytest.mark.parametrize("dtype", [np.int64, np.int16, np.int8, np.float64])
def test_zeros_and_ones_are_no_codes(square, dtype, tmp_path):
    ones = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], dtype)
    mesh = Mesh(*square)
    mesh.C = ones
    np.testing.assert_array_equal(mesh.C, ones)
    np.testing.assert_array_equal(easypbr.as_mesh({"points": square[0], "colors": ones}).C, ones)
    np.savez(tmp_path / "ones.npz", points=square[0], colors=ones)
    np.testing.assert_array_equal(Mesh(tmp_path / "ones.npz").C, ones)
    mesh.C = ones.astype(np.uint8)
    assert mesh.C.max() == np.float32(1 / 255), "the type tells"


def test_colors_that_were_rounded_are_clamped(square):
    mesh = Mesh(*square)
    mesh.C = np.array([[1.0000002, 0.5, -1e-7]] * 4)
    np.testing.assert_array_equal(mesh.C, [[1, 0.5, 0]] * 4)


@pytest.mark.parametrize("given, found", [
    ([[300, 0, 0]] * 4, "0 to 300"), ([[-1, 0, 0]] * 4, "-1 to 0"), ([[1.5, 0, 0]] * 4, "0 to 1.5"),
    ([[1.0, 0, 0, 255]] * 4, "an alpha of up to 255"), ([[np.inf, 0, 0]] * 4, "0 to inf"),
])  # fmt: skip
def test_colors_of_neither_range_are_refused(square, given, found):
    mesh = Mesh(*square)
    for change in (lambda: setattr(mesh, "C", given), lambda: easypbr.as_mesh({"points": square[0], "colors": given})):
        with pytest.raises(easypbr.ArgumentError, match=f"colours: expected 0 to 1 or 0 to 255.*got {found}"):
            change()
    assert len(mesh.C) == 0


def test_edit_puts_the_copy_in_place_only_when_the_block_ends_well(square):
    V, F = square
    mesh = Mesh(V, F)
    with mesh.edit("V") as v:
        v[:, 2] = 3
        assert mesh.V[0, 2] == 0
    assert (mesh.V[:, 2] == 3).all()
    with pytest.raises(RuntimeError, match="stop"):
        with mesh.edit("V") as v:
            v[:] = 0
            raise RuntimeError("stop")
    assert (mesh.V[:, 2] == 3).all()
    with pytest.raises(KeyError, match="a mesh has no array 'W'"):
        mesh.edit("W")


def test_an_edit_is_one_block_at_a_time(square):
    mesh = Mesh(*square)
    edit = mesh.edit("V")
    with pytest.raises(easypbr.ArgumentError, match=r'mesh.edit\("V"\): expected __enter__\(\) first, got __exit__\(\)'):
        edit.__exit__(None, None, None)
    with edit as v:
        with pytest.raises(easypbr.ArgumentError, match=r"expected one block at a time, got __enter__\(\) twice"):
            edit.__enter__()
        v[:, 2] = 3
    assert (mesh.V[:, 2] == 3).all()
    with pytest.raises(easypbr.ArgumentError, match="expected __enter__"):
        edit.__exit__(None, None, None)
    # One block after another is fine, also after a block that failed.
    with pytest.raises(RuntimeError, match="stop"):
        with edit as v:
            raise RuntimeError("stop")
    with edit as v:
        v[:, 2] = 4
    assert (mesh.V[:, 2] == 4).all()


def test_assign_replaces_arrays_of_another_length_together(square):
    V, F = square
    mesh = Mesh(V, F)
    mesh.N = np.tile([0, 0, 1.0], (4, 1))
    with pytest.raises(ValueError, match="N: expected 3 rows"):
        mesh.V = V[:3]
    mesh.assign(V=V[:3], F=F[:1], N=None)
    assert mesh.V.shape == (3, 3) and mesh.F.shape == (1, 3) and mesh.N.shape == (0, 3)


def test_handles_share_and_clones_do_not(square):
    mesh = Mesh(*square)
    easypbr.Scene.show(mesh, "square")
    shown = easypbr.Scene.get("square")
    assert shown == mesh and shown is not None
    copy = mesh.clone()
    assert copy != mesh
    mesh.name = "renamed"
    assert shown.name == "renamed" and copy.name == ""


@pytest.mark.parametrize("duplicate", [copy.copy, copy.deepcopy])
def test_copies_are_independent(square, duplicate):
    mesh = Mesh(*square)
    mesh.add_child(Mesh(*square))
    mesh.material.roughness = 0.25
    other, material = duplicate(mesh), duplicate(mesh.material)
    assert len(other.children) == 1 and other.children[0] != mesh.children[0]
    other.V = 2 * mesh.V
    material.roughness = other.material.roughness = 1
    np.testing.assert_array_equal(mesh.V, square[0])
    assert mesh.material.roughness == 0.25
    style, light, camera = duplicate(mesh.style), duplicate(LIGHT), duplicate(easypbr.Camera())
    style.line_width, light.intensity, camera.fov_y_deg = 7, 9, 11
    assert mesh.style.line_width != 7 and LIGHT.intensity == 3


def test_material_attributes_go_through(square):
    mesh = Mesh(*square)
    mesh.material.roughness = 0.25
    material = mesh.material
    material.base_color = (0.5, 0.25, 0)
    assert mesh.material.roughness == 0.25
    assert mesh.material.base_color == (0.5, 0.25, 0)
    with pytest.raises(ValueError, match="material.metallic: expected 0 to 1, got 2"):
        mesh.material.metallic = 2
    with pytest.raises(AttributeError):
        mesh.material.shininess = 1
    with pytest.raises(AttributeError) as caught:
        Material(roughness=0.25, shininess=1)
    assert caught.value.obj is None or caught.value.obj.roughness == 0.25
    mesh.material = Material(metallic=1, base_color="#ffffff")
    assert mesh.material.metallic == 1 and mesh.material.roughness == 0.5
    assert mesh.material.base_color == (1, 1, 1)
    # sRGB 0.5 is linear ((0.5019608 + 0.055) / 1.055)^2.4 = 0.21586.
    mesh.material.base_color = "#808080"
    assert mesh.material.base_color[0] == pytest.approx(0.21586, abs=1e-5)


def test_textures_are_arrays_or_files(square, tmp_path):
    mesh = Mesh(*square)
    assert mesh.material.base_color_texture is None
    picture = np.arange(2 * 3 * 3, dtype=np.uint8).reshape(2, 3, 3)
    mesh.material.base_color_texture = picture
    np.testing.assert_array_equal(mesh.material.base_color_texture, picture)
    easypbr.save_image(picture, tmp_path / "t.png")
    mesh.material.roughness_texture = tmp_path / "t.png"
    np.testing.assert_array_equal(mesh.material.roughness_texture[..., :3], picture)
    mesh.material.base_color_texture = None
    assert mesh.material.base_color_texture is None
    with pytest.raises(FileNotFoundError.__base__, match="missing.png"):
        mesh.material.normal_texture = tmp_path / "missing.png"


@pytest.mark.parametrize("name", ["c.obj", "c.ply"])
def test_saved_meshes_name_the_texture_from_any_folder(tmp_path, monkeypatch, name):
    red = np.full((2, 2, 3), (255, 0, 0), np.uint8)
    easypbr.save_image(red, tmp_path / "red.png")
    (tmp_path / "out").mkdir()
    monkeypatch.chdir(tmp_path)
    given = easypbr.shapes.plane()
    given.material.base_color_texture = Path("red.png")
    given.save("b.obj")
    read = Mesh("b.obj")
    assert Path(read.source) == tmp_path / "b.obj"
    monkeypatch.chdir(tmp_path / "out")
    # One whose texture was given, one whose texture was read.
    for mesh in (given, read):
        mesh.save(name)
        assert b" ../red.png\n" in Path(name).with_suffix(".mtl" if name == "c.obj" else ".ply").read_bytes()
        np.testing.assert_array_equal(Mesh(name).material.base_color_texture, red)


def test_a_pickle_knows_in_which_state_the_file_of_a_texture_was(tmp_path):
    easypbr.save_image(np.full((2, 2, 3), 10, np.uint8), tmp_path / "t.png")
    mesh = easypbr.shapes.plane()
    mesh.material.base_color_texture = tmp_path / "t.png"
    mesh = pickle.loads(pickle.dumps(mesh))
    mesh.save(tmp_path / "same.obj")
    assert "map_Kd t.png" in (tmp_path / "same.mtl").read_text()
    easypbr.save_image(np.full((3, 3, 3), 20, np.uint8), tmp_path / "t.png")
    mesh.save(tmp_path / "changed.obj")
    assert (Mesh(tmp_path / "changed.obj").material.base_color_texture == 10).all()


def test_positions_alone_are_a_cloud(square):
    cloud = Mesh(square[0])
    np.testing.assert_array_equal(cloud.V, square[0])
    assert len(cloud.F) == 0


def test_a_style_says_what_is_chosen(square):
    mesh = Mesh(*square)
    assert repr(mesh.style) == "Style()"
    mesh.style.show_wireframe = True
    mesh.style.colormap = "magma"
    assert repr(mesh.style) == "Style(show_wireframe=True, colormap='magma')"


def test_style(square):
    mesh = Mesh(*square)
    assert mesh.style.flat == auto and mesh.style.visible == auto
    mesh.style.flat = True
    mesh.style.visible = False
    assert mesh.style.flat is True and mesh.style.visible is False
    mesh.style.flat = auto
    assert mesh.style.flat == auto
    with pytest.raises(ValueError, match="setting 'style.flat': expected true or false, or 'auto' or 'follow', got 'yes'"):
        mesh.style.flat = "yes"


def test_pose_and_children(square):
    parent, child = Mesh(*square), Mesh(*square)
    T = np.eye(4)
    T[:3, 3] = 1, 2, 3
    child.T_parent_mesh = T
    np.testing.assert_array_equal(child.T_parent_mesh, T)
    parent.add_child(child)
    assert parent.children == [child]
    with pytest.raises(ValueError, match="cannot become a child"):
        child.add_child(parent)
    with pytest.raises(ValueError, match="T_parent_mesh: expected a 4 x 4 matrix, got 3 x 3 float64"):
        child.T_parent_mesh = np.eye(3)


def test_files(square, tmp_path):
    V, F = square
    for extension in ("ply", "obj", "glb"):
        path = tmp_path / f"square.{extension}"
        Mesh(V, F).save(path)
        loaded = Mesh(str(path))
        while loaded.children:
            loaded = loaded.children[0]
        np.testing.assert_array_equal(loaded.V, V)
        np.testing.assert_array_equal(loaded.F, F)
    with pytest.raises(OSError, match="none.ply"):
        Mesh(tmp_path / "none.ply")
    (tmp_path / "empty.ply").write_text("")
    with pytest.raises(easypbr.FormatError, match="empty.ply"):
        Mesh(tmp_path / "empty.ply")
    with pytest.raises(ValueError, match="plyy"):
        Mesh(V, F).save(tmp_path / "square.plyy")

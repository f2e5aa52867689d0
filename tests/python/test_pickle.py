"""Meshes and what they are made of cross process borders by pickle."""

import copy
import multiprocessing
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import easypbr
from easypbr import (
    ArgumentError,
    Camera,
    CameraPath,
    Environment,
    LabelMap,
    Light,
    Material,
    Mesh,
    RayTree,
    Scene,
    Style,
    Viewer,
    auto,
    follow,
    shapes,
)

IDENTITY = np.eye(4)
K = np.array([[100.0, 0.5, 31], [0, 110, 23], [0, 0, 1]])


def again(value: Any, protocol: int = pickle.HIGHEST_PROTOCOL) -> Any:
    return pickle.loads(pickle.dumps(value, protocol))


def picture(mesh: Mesh) -> np.ndarray:
    scene = Scene()
    scene.show(mesh, "mesh")
    return np.asarray(Viewer((48, 36), {"image": {"samples": 1}, "path": {"enabled": False}}, scene).render())


def full_mesh(folder: Path) -> Mesh:
    """A mesh with something in each of its members that Python can set."""
    mesh = shapes.sphere(1, 8)
    count = len(mesh.V)
    mesh.V = mesh.V + np.array([4e5, 5e6, 0])  # of an offset
    mesh.C = np.linspace(0, 1, 4 * count).reshape(count, 4)
    mesh.N = mesh.V / np.linalg.norm(mesh.V, axis=1, keepdims=True)
    mesh.L = np.arange(count) % 3
    mesh.I = np.linspace(0, 1, count)
    mesh.E = [[0, 1], [1, 2]]
    mesh.label_map = LabelMap(["a", "b", "c"], ["red", "lime", "blue"], unlabelled=0, name="own")
    mesh.add_scalar("height", mesh.V[:, 2])
    mesh.name = "full"
    pixels = np.zeros((4, 4, 3), np.uint8)
    pixels[::2] = 200
    mesh.material = Material(
        name="paint", base_color=(0.1, 0.5, 0.9), roughness=0.3, clearcoat=0.5, alpha_mode="blend", opacity=0.7
    )
    mesh.material.base_color_texture = pixels
    mesh.material.emissive_texture = pixels.astype(np.float32)
    mesh.add_material(Material(unlit=True, double_sided=False, attenuation_distance=float("inf")))
    mesh.style = Style(color_by="label", point_size=3, colormap="plasma", visible=True, nan_color="red")
    mesh.T_parent_mesh = [[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]
    child = shapes.box()
    child.name = "child"
    child.material.base_color_texture = pixels
    mesh.add_child(child)
    return mesh


@pytest.mark.parametrize("protocol", range(2, pickle.HIGHEST_PROTOCOL + 1))
def test_a_mesh_comes_back_whole(tmp_path: Path, protocol: int) -> None:
    mesh = full_mesh(tmp_path)
    found = again(mesh, protocol)
    assert found != mesh
    for name in ("V", "N", "C", "UV", "F", "E", "L", "I", "offset", "T_parent_mesh"):
        expected = np.asarray(getattr(mesh, name))
        assert np.asarray(getattr(found, name)).dtype == expected.dtype
        assert np.array_equal(getattr(found, name), expected), name
    assert found.name == "full"
    assert found.label_map.names == ["a", "b", "c"] and found.label_map.unlabelled == 0
    assert np.array_equal(found.scalars["height"], mesh.scalars["height"])
    assert len(found.materials) == 2 and found.materials[1].unlit and not found.materials[1].double_sided
    assert found.material.alpha_mode == "blend" and found.material.name == "paint"
    assert np.array_equal(found.material.base_color_texture, mesh.material.base_color_texture)
    assert found.material.emissive_texture.dtype == np.float32
    assert repr(found.style) == repr(mesh.style)
    assert [child.name for child in found.children] == ["child"]
    assert np.array_equal(picture(found), picture(mesh))


def test_what_python_cannot_set_comes_back_too(tmp_path: Path) -> None:
    # A glTF file with tangents, a wrapped texture and two materials by parts; up is that of its format.
    mesh = full_mesh(tmp_path)
    mesh.save(tmp_path / "mesh.glb")
    read = Mesh(tmp_path / "mesh.glb")
    found = again(read)
    assert found.source == read.source
    assert np.array_equal(picture(found), picture(read))
    found.save(tmp_path / "found.glb")
    read.save(tmp_path / "read.glb")
    assert (tmp_path / "found.glb").read_bytes() == (tmp_path / "read.glb").read_bytes()


def test_splats_and_surfels_come_back() -> None:
    rng = np.random.default_rng(1)
    splats = Mesh(rng.random((20, 3)), None)
    splats.assign(
        scales=rng.random((20, 3)), rotations=rng.random((20, 4)) + 0.1, opacities=rng.random(20), sh=rng.random((20, 27))
    )
    found = again(splats)
    for name in ("scales", "rotations", "opacities", "sh"):
        assert np.array_equal(getattr(found, name), getattr(splats, name))
    empty = again(Mesh())
    assert len(empty.V) == 0 and len(empty.F) == 0


def test_textures_that_are_shared_are_kept_once() -> None:
    mesh = shapes.box()
    pixels = np.random.default_rng(1).integers(0, 255, (256, 256, 3), np.uint8)
    mesh.material.base_color_texture = pixels
    one = len(pickle.dumps(mesh))
    mesh.add_material(mesh.material)
    child = mesh.clone()
    mesh.add_child(child)
    # Three materials: two more of 196,608 bytes each if their image were not kept once.
    assert len(pickle.dumps(mesh)) < one + pixels.nbytes


def test_arrays_can_be_out_of_band() -> None:
    mesh = shapes.sphere(1, 64)
    buffers: list[pickle.PickleBuffer] = []
    text = pickle.dumps(mesh, protocol=5, buffer_callback=buffers.append)
    assert len(text) < 4096 < sum(buffer.raw().nbytes for buffer in buffers)
    assert np.array_equal(pickle.loads(text, buffers=buffers).V, mesh.V)


def test_materials_and_styles_come_back() -> None:
    material = Material(roughness=0.25, metallic=1, shader="void surface(inout Surface s) { s.roughness = 1.0; }")
    found = again(material)
    assert (found.roughness, found.metallic, found.shader) == (0.25, 1, material.shader)
    assert again(Material()).alpha_mode == "auto"
    style = Style(mode="points", colormap=np.array([[0, 0, 0], [255, 128, 0]], np.uint8), color_steps=4)
    assert repr(again(style)) == repr(style)
    # The material of a mesh becomes one of its own.
    mesh = shapes.box()
    own = again(mesh.material)
    own.roughness = 1
    assert mesh.material.roughness == 0.5


def test_lights_cameras_and_environments_come_back() -> None:
    light = Light("spot", position=(1, 2, 3), color="#ff8000", outer_cone_deg=30)
    found = again(light)
    assert (found.type, found.position, found.color) == ("spot", light.position, light.color)
    assert found.radius == auto and again(Light(radius=0.5)).radius == 0.5
    camera = Camera.from_opencv(K, IDENTITY, (64, 48), distortion=[0.1, 0.01, 0, 0, 0])
    other = again(camera)
    assert np.array_equal(other.opencv_K((64, 48)), camera.opencv_K((64, 48)))
    assert other.distortion == camera.distortion
    assert np.array_equal(other.T_world_cam, camera.T_world_cam)
    flat = Camera.look_at((1, 2, 3), (0, 0, 0))
    flat.projection, flat.ortho_height = "orthographic", 7.5
    assert (again(flat).projection, again(flat).ortho_height) == ("orthographic", 7.5)
    keys = [Camera.look_at((1, 2, 3), (0, 0, 0)), Camera.look_at((3, 2, 1), (0, 0, 0))]
    path = CameraPath(keys, segment_s=2, ease="in_out")
    # Rotations are brought to unit length again: the last bits.
    assert np.allclose(again(path).pose(0.7), path.pose(0.7), rtol=0, atol=1e-15)
    assert again(path).key_times_s == path.key_times_s
    environment = Environment(np.full((4, 8, 3), 2.5, np.float32))
    assert np.array_equal(again(environment).to_numpy(), environment.to_numpy())
    assert again(Environment()).empty and again(environment).name == environment.name


def test_settings_come_back_as_dicts() -> None:
    assert again(auto) == auto and again(follow) == follow
    view = Viewer((16, 12), {"camera": {"fov_y_deg": 50}}, Scene())
    view.scene.show(shapes.box(), "box")
    view.render(samples=1)
    values = again(view.settings.to_dict())
    other = Viewer(scene=Scene())
    other.settings.update(values)
    assert other.settings.to_dict() == view.settings.to_dict()


def test_scenes_and_viewers_say_what_can_be_pickled_instead() -> None:
    scene = Scene()
    scene.show(shapes.box(), "box")
    view = Viewer((8, 8), scene=scene)
    for value, name in ((scene, "Scene"), (view, "Scene"), (view.settings, "Viewer"), (view.moment(), "Moment"),
                        (RayTree(shapes.box()), "RayTree")):
        with pytest.raises(TypeError, match=f"a {name} cannot be pickled: make one in each process"):
            pickle.dumps(value)
        with pytest.raises(TypeError, match="cannot be pickled"):
            copy.deepcopy(value)


def annotated(seed: int = 0) -> Any:
    """Two spheres, one behind the other and partly outside of the image: instances and what is at a pixel."""
    scene = Scene()
    scene.show(shapes.sphere(0.5), "near")
    far = shapes.sphere(0.7)
    far.T_parent_mesh = [[1, 0, 0, 0.9], [0, 1, 0, 0], [0, 0, 1, -1 - seed], [0, 0, 0, 1]]
    scene.show(far, "far")
    view = Viewer((48, 36), scene=scene)
    view.camera = Camera.look_at((0, 0, 3), (0, 0, 0))
    return view.render_layers(["instances"], classes={"far": 3})["instances"], view.pick(24, 18)


def members(value: Any) -> dict[str, Any]:
    return {name: getattr(value, name) for name in dir(value) if not name.startswith("_")}


def equal_members(value: Any, other: Any) -> bool:
    assert type(value) is type(other) and members(value).keys() == members(other).keys()
    return all(np.array_equal(value, other, equal_nan=True) if isinstance(value, np.ndarray) else value == other
               for value, other in zip(members(value).values(), members(other).values(), strict=True))


def test_instances_and_picks_keep_all_members() -> None:
    instances, pick = annotated()
    assert [(value.name, value.semantic_id) for value in instances] == [("far", 3), ("near", 0)]
    assert all(value.mask.any() for value in instances) and 0 < instances[0].truncation < 1
    for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
        for value in (*instances, pick):
            for other in (again(value, protocol), copy.deepcopy(value), copy.copy(value)):
                assert equal_members(value, other)
    assert not equal_members(instances[0], again(instances[1]))


def test_instances_come_from_other_processes() -> None:
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        instances, pick = pool.map(annotated, [1], chunksize=1)[0]
    own, own_pick = annotated(1)
    assert equal_members(pick, own_pick)
    assert all(equal_members(value, other) for value, other in zip(instances, own, strict=True))


def test_bad_states_of_instances_are_refused() -> None:
    instance = annotated()[0][0]
    state = instance.__getstate__()
    area = state["visible"]["area"]
    for bad in (
        state | {"picture_width": 3},
        state | {"picture_height": -1},
        state | {"visible": {"area": area, "pixels": b"1"}},
        state | {"visible": {"area": area | {"x": -1}, "pixels": state["visible"]["pixels"]}},
        state | {"amodal": {"area": {"x": 0, "y": 0, "width": -1, "height": -1}, "pixels": b"1"}},
    ):
        with pytest.raises(ArgumentError, match="pickle: Instance: expected"):
            type(instance).__new__(type(instance)).__setstate__(bad)


def test_states_of_newer_versions_and_bad_ones_are_refused() -> None:
    state = shapes.box().__getstate__()
    for change, message in (
        ({"hair": 1}, "'hair' is not known: it was written by a newer version"),
        ({"F": np.array([[0, 1, 99]])}, "F"),
        ({"offset": [1.0, 2.0]}, "offset: expected 3 numbers, got 2"),
        ({"materials": [{"alpha_mode": 7}]}, "alpha_mode: expected 0 to 3, got 7"),
    ):
        with pytest.raises(ArgumentError, match=message):
            Mesh.__new__(Mesh).__setstate__({**state, **change})


def _vertices(mesh: Mesh) -> int:
    return len(mesh.V)


def test_a_pool_of_processes_takes_meshes() -> None:
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.map(_vertices, [shapes.box(), shapes.sphere(1, 8)]) == [
            len(shapes.box().V),
            len(shapes.sphere(1, 8).V),
        ]


def test_a_pickle_is_read_by_a_program_that_has_not_imported_easypbr(tmp_path: Path) -> None:
    (tmp_path / "mesh.pickle").write_bytes(pickle.dumps(shapes.box()))
    code = "import pickle, sys; print(len(pickle.load(open(sys.argv[1], 'rb')).F))"
    found = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path / "mesh.pickle")], capture_output=True, text=True, check=True
    )
    assert found.stdout.strip() == "12"
    assert easypbr.Mesh is type(pickle.loads((tmp_path / "mesh.pickle").read_bytes()))

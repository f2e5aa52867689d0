"""What newcomers write first: words of other programs, cameras by name, the timer, arrays for other libraries."""

import ctypes
import pickle
import subprocess
import sys
import time

import numpy as np
import pytest

import easypbr
from easypbr import Camera, Mesh, Scene, Viewer, _easypbr, render, shapes

SMALL = {"size": (64, 48), "samples": 1}


@pytest.fixture(scope="module")
def cone():
    """It looks different from every side that is compared, and has its front towards +z."""
    mesh = Mesh([[-1, 0, 0], [1, 0, 0], [0, 2, 0], [0, 0, 0.5]], [[0, 1, 3], [1, 2, 3], [2, 0, 3], [0, 2, 1]])
    mesh.C = np.array([[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]], dtype=np.uint8)
    return mesh


# Words


@pytest.mark.parametrize("given, error, message", [
    ({"base_color": "red"}, TypeError, "there is no 'base_color': it is called color="),
    ({"env": "map.hdr"}, TypeError, "there is no 'env': it is called environment='map.hdr'"),
    ({"layers": ["depth"]}, TypeError, r"there is no 'layers': layers come from Viewer\(scene=scene\).render_layers"),
    ({"camera_position": (1, 2, 3)}, TypeError, r"it is called camera=\{'position': "),
    ({"show_edges": True}, TypeError, "it is called show_wireframe="),
    ({"cmap": "viridis"}, TypeError, "it is called colormap="),
    ({"background_color": "white"}, TypeError, "it is called background="),
    ({"fov": 40}, TypeError, "it is called fov_y_deg="),
    ({"window_size": (3, 4)}, TypeError, "it is called size="),
    ({"spp": 4}, TypeError, "it is called samples="),
    ({"soft_shadows": True}, TypeError, r"it is called settings=\{'shadows.mode': ...\}"),
    ({"ground": False}, TypeError, r"it is called settings=\{'ground.mode': ...\}, one of 'none', 'shadow', 'plane'"),
    ({"shadows": False}, TypeError, r"it is called settings=\{'shadows.enabled': ...\}, True or False"),
    ({"transparent": True}, TypeError, "it is called background='transparent'"),
    ({"material": "red"}, TypeError, r"a group of settings: 'material\."),
    ({"clim": (0, 1)}, TypeError, "it is called color_min=0, color_max=1"),
    ({"flip_scalars": True}, TypeError, "the colour map's name with _r: colormap='viridis_r'"),
    ({"scalar_bar_args": {}}, TypeError, "give colorbar=True, title='height'"),
    ({"style": "wireframe"}, TypeError, "give show_wireframe=True"),
    ({"rougness": 1}, TypeError, "did you mean 'material.roughness'"),
    ({"samples": "4"}, ValueError, "samples: expected a whole number from 1 to 65536, got '4'"),
    ({"samples": 2.5}, ValueError, "samples: expected a whole number from 1 to 65536, got 2.5"),
    ({"samples": np.True_}, ValueError, "samples: expected a whole number from 1 to 65536, got True"),
    ({"samples": 0}, ValueError, "samples"),
    ({"roughness": "rough"}, ValueError, "material.roughness"),
])  # fmt: skip
def test_wrong_words_are_answered_in_ours(cone, given, error, message):
    options = {"size": (64, 48), **given}
    with pytest.raises(error, match=message):
        render(cone, **options)


def test_every_synonym_leads_to_a_setting_or_to_advice():
    names = {field.name for field in _easypbr.fields()}
    words = [synonym.word for synonym in _easypbr.synonyms()]
    assert words == sorted(set(words)), "the table is searched in this order"
    for synonym in _easypbr.synonyms():
        assert (synonym.setting in names) != bool(synonym.advice), synonym.word
        assert _easypbr.synonym("--" + synonym.word.upper().replace("_", "-")).word == synonym.word
        assert synonym.word not in names
        if synonym.setting:
            with pytest.raises(TypeError, match="it is called"):
                render(np.zeros((1, 3)), **{synonym.word: 1})
    assert _easypbr.synonym("nothing") is None


def test_pyvista_s_words_are_known():
    """The parameters of its Plotter.add_mesh() and plot(), but for those that are EasyPBR's too or belong to its own plotter."""
    words = """style scalars clim show_edges edge_color edge_opacity flip_scalars lighting n_colors interpolate_before_map cmap
    reset_camera scalar_bar_args show_scalar_bar name texture render_points_as_spheres render_lines_as_tubes smooth_shading
    split_sharp_edges ambient diffuse specular_power nan_opacity culling rgb categories silhouette use_transparency below_color
    above_color annotations pickable preference pbr user_matrix component copy_mesh backface_params show_vertices
    color_missing_with_nan interpolation vertex_color off_screen interactive cpos window_size show_bounds show_axes show_grid notebook
    jupyter_backend screenshot return_img eye_dome_lighting volume parallel_projection return_cpos anti_aliasing zoom ssao
    hidden_line_removal transparent_background theme line_smoothing log_scale""".split()
    assert [word for word in words if _easypbr.synonym(word) is None] == []


def test_words_of_open3d_polyscope_and_blender_are_known():
    """Of draw_geometries() and draw(), of register_surface_mesh() and add_scalar_quantity(), of scene.render."""
    settings = {"mesh_show_back_face": "style.two_sided", "show_skybox": "background.mode", "smooth_shade": "style.flat",
                "engine": "path.enabled", "film_transparent": "background.mode"}
    assert {word: getattr(_easypbr.synonym(word), "setting", None) for word in settings} == settings
    assert [word for word in ("window_name", "front", "datatype") if _easypbr.synonym(word) is None] == []


def test_words_of_images_are_not_taken_for_other_settings(cone):
    """`width` is the last part of outline.width alone, and `height` of ground.height."""
    for word in ("width", "height", "resolution"):
        with pytest.raises(TypeError, match=f"there is no '{word}': it is called size=.800, 600."):
            render(cone, **{word: 2})
    with pytest.raises(TypeError, match=r"settings=\{'outline.width': \.\.\.\}"):
        render(cone, width=2)
    render(cone, size=(64, 48), settings={"outline.width": 2})


def test_settings_know_the_words_too(cone):
    with pytest.raises(KeyError, match="there is no setting 'camera.fov' .it is called 'camera.fov_y_deg'"):
        Viewer(scene=Scene()).settings["camera.fov"] = 3
    with pytest.raises(AttributeError, match="it is called 'material.color'"):
        Viewer(scene=Scene()).settings.material.base_color = "red"


# Cameras


@pytest.mark.parametrize("name, azimuth, elevation", [
    ("front", 0, 0), ("back", 180, 0), ("right", 90, 0), ("left", -90, 0), ("top", 0, 90), ("bottom", 0, -90), ("iso", 45, 35.26439),
])  # fmt: skip
def test_views_by_name(cone, name, azimuth, elevation):
    expected = render(cone, **SMALL, azimuth_deg=azimuth, elevation_deg=elevation)
    assert np.abs(render(cone, **SMALL, camera=name).astype(int) - expected).mean() < 0.1
    assert np.abs(render(cone, **SMALL).astype(int) - expected).mean() > 1


def test_cameras_of_every_form(cone):
    camera = Camera.look_at((3, 2, 5), (0, 0.5, 0), fov_y_deg=30)
    expected = render(cone, **SMALL, camera=camera)
    for given in (
        {"position": (3, 2, 5), "target": (0, 0.5, 0), "fov_y_deg": 30},
        {"eye": (3, 2, 5), "look_at": (0, 0.5, 0), "fov": 30},
        {"position": (3, 2, 5), "focal_point": (0, 0.5, 0), "up": (0, 1, 0), "fov": 30},
        camera.T_world_cam,
        camera.T_world_cam.tolist(),
        [(3, 2, 5), (0, 0.5, 0), (0, 1, 0)],
    ):
        np.testing.assert_array_equal(render(cone, **SMALL, camera=given), expected)
    view = Viewer(SMALL["size"], scene=_scene_of(cone))
    view.camera = camera.T_world_cam
    view.camera = "front"
    np.testing.assert_array_equal(view.render(samples=1), render(cone, **SMALL, camera="front"))


@pytest.mark.parametrize("camera, message", [
    ("fornt", "there is no view 'fornt': expected a Camera, one of 'front', 'back'"),
    (3, "camera: expected a Camera, .*; got a number"),
    (np.eye(3), "camera: .*; got 3 x 3"),
    (object(), "camera: .*; got a object"),
    ({"positon": (1, 2, 3)}, "there is no setting 'camera.positon' .did you mean 'camera.position'"),
    ({"eye": (1, 2, 3), "position": (1, 2, 3)}, "'position' is position, which is given already"),
    ({"up": (0, 0, 1)}, "an up vector needs position and target"),
])  # fmt: skip
def test_what_is_no_camera(cone, camera, message):
    with pytest.raises(easypbr.Error, match=message):
        render(cone, **SMALL, camera=camera)


def test_cameras_of_a_file_by_name(tmp_path):
    sys.path.insert(0, str(easypbr_root() / "tests/docs"))
    import snippets

    snippets.write_gltf(tmp_path / "scene.gltf")
    found = easypbr.load_scene(tmp_path / "scene.gltf").cameras["front"]
    seen = render(tmp_path / "scene.gltf", **SMALL, camera="front")
    np.testing.assert_array_equal(seen, render(tmp_path / "scene.gltf", **SMALL, camera=found))
    with pytest.raises(easypbr.ArgumentError, match="the cameras of the file are 'front'"):
        render(tmp_path / "scene.gltf", **SMALL, camera="Camera")


def easypbr_root():
    from pathlib import Path

    return Path(__file__).parents[2]


# Time


def test_time_goes_on_in_a_loop_of_render(cone):
    view = Viewer((16, 12), scene=_scene_of(cone))
    assert (view.time, view.delta_time) == (0, 0)
    began = time.monotonic()
    times = []
    for _ in range(3):
        view.render(samples=1)
        times.append(view.time)
        assert view.time == view.time, "it stands still between frames"
        time.sleep(0.05)
    assert times[0] == 0 and times[1] >= 0.05 and times[2] - times[1] >= 0.05
    assert times[2] <= time.monotonic() - began
    assert view.delta_time == pytest.approx(times[2] - times[1])
    view.time = 3.5
    view.render(samples=1)
    assert (view.time, view.delta_time) == (3.5, 0)
    view.fixed_step = 0.25
    for expected in ((3.5, 0), (3.75, 0.25)):
        view.render(samples=1)
        assert (view.time, view.delta_time) == expected


def test_fixed_steps_begin_as_a_recording_does(cone, tmp_path):
    view = Viewer((16, 12), scene=_scene_of(cone))
    view.fixed_step = 0.125
    for _ in range(2):
        for expected in ((0, 0), (0.125, 0.125), (0.25, 0.125)):
            view.render(samples=1)
            assert (view.time, view.delta_time) == expected
        view.time = 0
    view.fixed_step, times = None, []
    with view.recorder.start(tmp_path / "%d.png", fps=8, samples=1):
        for _ in range(3):
            times.append((view.time, view.delta_time))
            view.recorder.add_frame()
    assert times == [(0, 0), (0.125, 0.125), (0.25, 0.125)]


def test_steps_may_differ(cone):
    view = Viewer((16, 12), scene=_scene_of(cone))
    times = []
    for step in (0.5, 0.25, 0.125):
        view.fixed_step = step
        view.render(samples=1)
        times.append(view.time)
    assert times == [0, 0.25, 0.375]


def test_a_failed_image_takes_no_time(cone):
    view = Viewer((16, 12), scene=_scene_of(cone))
    view.fixed_step = 0.25
    with pytest.raises(easypbr.Error):
        view.render((10**6, 10**6))
    for expected in ((0, 0), (0.25, 0.25)):
        view.render(samples=1)
        assert (view.time, view.delta_time) == expected
    view.settings.environment.file = "nowhere.hdr"
    with pytest.raises(easypbr.Error):
        view.render(samples=1)
    assert (view.time, view.delta_time) == (0.25, 0.25)


def test_recordings_keep_their_own_time(cone, tmp_path):
    view = Viewer((16, 12), scene=_scene_of(cone))
    with view.recorder.start(tmp_path / "%d.png", fps=10, samples=1):
        for frame in range(3):
            view.render(samples=1)
            assert view.time == pytest.approx(frame / 10)
            view.recorder.add_frame()


def test_the_timer_can_be_asked_at_any_point():
    began = time.monotonic()
    view = Viewer(scene=Scene())
    first = view.elapsed
    time.sleep(0.02)
    assert 0 <= first < view.elapsed <= time.monotonic() - began
    assert view.elapsed >= 0.02


# Arrays for other libraries


class Consumer:
    """A library that takes DLPack: of version 1.0, or the one before it."""

    capsule_name = ctypes.pythonapi.PyCapsule_GetName
    capsule_name.restype, capsule_name.argtypes = ctypes.c_char_p, [ctypes.py_object]
    pointer = ctypes.pythonapi.PyCapsule_GetPointer
    pointer.restype, pointer.argtypes = ctypes.c_void_p, [ctypes.py_object, ctypes.c_char_p]

    class Versioned(ctypes.Structure):
        _fields_ = [("major", ctypes.c_uint32), ("minor", ctypes.c_uint32), ("context", ctypes.c_void_p),
                    ("deleter", ctypes.c_void_p), ("flags", ctypes.c_uint64), ("data", ctypes.c_void_p)]  # fmt: skip

    class Old(ctypes.Structure):
        _fields_ = [("data", ctypes.c_void_p)]

    @classmethod
    def new(cls, array):
        capsule = array.__dlpack__(max_version=(1, 0))
        assert cls.capsule_name(capsule) == b"dltensor_versioned"
        return cls.Versioned.from_address(cls.pointer(capsule, b"dltensor_versioned")), capsule

    @classmethod
    def old(cls, array):
        capsule = array.__dlpack__()
        assert cls.capsule_name(capsule) == b"dltensor"
        return cls.Old.from_address(cls.pointer(capsule, b"dltensor")), capsule


def test_arrays_of_a_mesh_leave_by_dlpack():
    mesh = shapes.sphere(1, 8)
    for array in (mesh.V, mesh.F, mesh.V[2:5], mesh.V[:, 0]):
        assert array.__dlpack_device__() == (1, 0) and not array.flags.writeable
        tensor, capsule = Consumer.new(array)
        assert tensor.major == 1 and tensor.flags & 1, "read-only"
        assert tensor.data == array.ctypes.data, "without a copy"
        tensor, capsule = Consumer.old(array)
        assert tensor.data != array.ctypes.data, "a consumer that does not know of it may write"
        copy = np.from_dlpack(array)
        np.testing.assert_array_equal(copy, array)
    with pytest.raises(BufferError, match="read-only"):
        mesh.V.__dlpack__(copy=False)
    with pytest.raises(BufferError, match="memory of the CPU"):
        mesh.V.__dlpack__(dl_device=(2, 0))


def test_torch_takes_the_arrays_of_a_mesh():
    torch = pytest.importorskip("torch")
    mesh = shapes.sphere(1, 8)
    before = np.array(mesh.V)
    tensor = torch.from_dlpack(mesh.V)
    np.testing.assert_array_equal(tensor.numpy(), before)
    tensor += 1
    np.testing.assert_array_equal(mesh.V, before)
    assert torch.from_dlpack(mesh.F).dtype == torch.int32


def test_what_is_computed_from_an_array_is_plain():
    V = shapes.sphere(1, 8).V
    for result in (V * 2, V + V, np.sin(V), V.sum(axis=0), np.asarray(V), np.array(V), V @ np.eye(3)):
        assert type(result) is np.ndarray
    assert isinstance(V.max(), np.floating)
    out = np.empty_like(np.asarray(V))
    assert np.add(V, 1, out=out) is out
    restored = pickle.loads(pickle.dumps(V))
    assert type(restored) is np.ndarray
    np.testing.assert_array_equal(restored, V)


# Files


def test_vcglib_names_textures_by_this_file(tmp_path):
    easypbr.save_image(np.full((2, 2, 3), (200, 10, 20), np.uint8), tmp_path / "scan_A.png")
    (tmp_path / "scan.ply").write_text(
        "ply\nformat ascii 1.0\ncomment VCGLIB generated\ncomment TextureFile <this>_A.png\nelement vertex 3\nproperty float x\n"
        "property float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\n"
        "property list uchar float texcoord\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 1 0 0 1\n"
    )
    texture = Mesh(tmp_path / "scan.ply").material.base_color_texture
    assert texture.shape[:2] == (2, 2) and tuple(texture[0, 0, :3]) == (200, 10, 20)


def test_importing_leaves_nothing_behind():
    done = subprocess.run([sys.executable, "-c", "import easypbr; easypbr.shapes.sphere().V"], capture_output=True, text=True, check=True)
    assert (done.stdout, done.stderr) == ("", "")


def _scene_of(mesh: Mesh) -> Scene:
    scene = Scene()
    scene.show(mesh, "mesh")
    return scene

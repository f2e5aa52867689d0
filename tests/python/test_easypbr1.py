"""easypbr.compat.easypbr1: scripts of the first EasyPBR after one line. Expected values are derived from geometry here."""

import re
from pathlib import Path

import numpy as np
import pytest

import easypbr
import easypbr.compat.easypbr1 as old
from easypbr.compat.easypbr1 import Camera, ColorMngr, Frame, Gui, LabelMngr, Mat, Mesh, Profiler, Scene, Viewer
from easypbr.compat.easypbr1 import config as old_config

SIZE = [64, 48]


@pytest.fixture(autouse=True)
def empty_scene(monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    Scene.clear()
    easypbr.Scene.clear()
    yield
    Scene.clear()


@pytest.fixture
def view():
    viewer = Viewer.create()
    viewer.m_viewport_size = SIZE
    viewer.own.settings.image.samples = 1
    return viewer


def ball(radius=1.0, center=(0, 0, 0)):
    mesh = Mesh()
    mesh.create_sphere(center, radius)
    return mesh


# The script of the README, and readback.


def test_a_script_as_it_was_written(tmp_path, view):
    easypbr.shapes.teapot(1, 8).save(tmp_path / "pot.ply")
    mesh = Mesh(str(tmp_path / "pot.ply"))
    mesh.m_vis.m_solid_color = [1.0, 0.1, 0.1]
    mesh.m_vis.set_color_solid()
    Scene.show(mesh, "pot")
    Scene.set_floor_visible(False)
    for _ in range(2):
        view.update()
    view.m_recorder.record("picture.png", str(tmp_path / "out"))
    assert view.m_recorder.is_finished() and view.m_recorder.nr_images_recorded() == 1
    picture = easypbr.load_image(tmp_path / "out/picture.png")
    assert picture.shape == (48, 64, 4)
    # Red in the middle, where the pot is: by sRGB's curve 0.1 is a linear 0.01, so that red is far above green.
    assert picture[28, 32, 0] > 2 * int(picture[28, 32, 1])
    assert view.m_nr_drawn_frames == 2


def test_readback_is_bottom_row_first(view, tmp_path):
    Scene.show(ball(1, (0, 2, 0)), "above")
    view.m_camera.set_position([0, 0, 6])
    view.m_camera.set_lookat([0, 0, 0])
    view.m_camera.m_fov = 60
    view.draw()
    mat = view.rendered_mat_no_gui(True)
    assert (mat.rows, mat.cols, mat.channels()) == (48, 64, 4)
    upright = mat.rgba2bgra().flip_y()
    np.testing.assert_array_equal(upright.data[:, :, [2, 1, 0, 3]], view.own.render(size=SIZE))
    upright.to_file(tmp_path / "a.png")
    np.testing.assert_array_equal(easypbr.load_image(tmp_path / "a.png"), view.own.render(size=SIZE))
    depth = view.gbuffer_mat_with_name("depth_gtex").data[:, :, 0]
    assert depth[24:].any() and not depth[:24].any(), "what is above is in the last rows"


def test_targets(view):
    Scene.show(ball(), "ball")
    view.m_camera.set_position([0, 0, 3])
    view.m_camera.set_lookat([0, 0, 0])
    middle = {name: view.gbuffer_mat_with_name(name).data[24, 32] for name in
              ("depth_gtex", "normal_gtex", "mesh_id_gtex", "metalness_and_roughness_gtex")}  # fmt: skip
    # A pixel's centre is half a pixel off the axis: 0.5 / 48 of 16.9 degrees, 1e-2 at a distance of 2.
    assert middle["depth_gtex"][0] == pytest.approx(2, abs=1e-2)
    # Triangles of a sphere of 32 segments are flat: their normals differ by up to 180 / 32 degrees, 0.05 of 0.5 n + 0.5.
    np.testing.assert_allclose(middle["normal_gtex"], [0.5, 0.5, 1], atol=0.05)
    assert middle["mesh_id_gtex"][0] == 1
    assert len(middle["metalness_and_roughness_gtex"]) == 2
    with pytest.raises(easypbr.UnknownNameError, match="there is no target 'normals'"):
        view.gbuffer_mat_with_name("normals")


# Cameras.


def test_saved_viewpoints(view):
    """90 degrees about y: from +x towards the origin. The first EasyPBR's vertical field of view is m_fov / aspect."""
    half = np.sqrt(0.5)
    camera = Camera()
    camera.from_string(f"3 0.5 0 0 {half} 0 {half} 0 0.5 0 60 0.01 1000")
    np.testing.assert_allclose(camera.position(), [3, 0.5, 0])
    np.testing.assert_allclose(camera.direction(), [-1, 0, 0], atol=1e-12)
    np.testing.assert_allclose(camera.lookat(), [0, 0.5, 0], atol=1e-12)
    again = Camera()
    again.from_string(camera.to_string())
    np.testing.assert_allclose(again.model_matrix(), camera.model_matrix(), atol=1e-7)
    assert again.m_fov == 60
    Scene.show(ball(), "ball")
    view.m_camera = camera
    view.draw()
    assert view.own.camera.fov_y_deg == pytest.approx(60 / (64 / 48))
    np.testing.assert_allclose(view.own.camera.T_world_cam, camera.model_matrix(), atol=1e-6)
    with pytest.raises(easypbr.ArgumentError, match="camera: expected 13 numbers"):
        camera.from_string("1 2 3")


def test_orbits_and_pushes():
    camera = Camera()
    camera.set_position([0, 0, 2])
    camera.set_lookat([0, 0, 0])
    camera.orbit_y(90)
    np.testing.assert_allclose(camera.position(), [2, 0, 0], atol=1e-12)
    camera.push_away(2)
    np.testing.assert_allclose(camera.position(), [4, 0, 0], atol=1e-12)
    camera.push_away_by_dist(-1)
    assert camera.dist_to_lookat() == pytest.approx(3)
    np.testing.assert_allclose(camera.lookat(), 0, atol=1e-12)
    other = camera.clone()
    other.orbit_x(30)
    np.testing.assert_allclose(camera.position(), [3, 0, 0], atol=1e-12)
    # About the camera's own x axis, which is -z here: upwards or downwards by 3 sin 30.
    assert abs(other.position()[1]) == pytest.approx(1.5)
    pose = other.m_model_matrix
    pose.set_translation([1, 2, 3])
    np.testing.assert_allclose(other.position(), [1, 2, 3])


def test_a_camera_that_is_only_read_stays_automatic(view):
    Scene.show(ball(), "ball")
    first = view.m_camera.position()
    # The ball fills the picture's height but for the margin: its silhouette is asin(1 / d) off the axis.
    filled = np.arcsin(1 / np.linalg.norm(first)) / np.radians(view.m_camera.m_fov / (64 / 48) / 2)
    assert filled == pytest.approx(0.95, abs=0.02)
    view.draw()
    Scene.show(ball(4), "larger")
    assert np.linalg.norm(view.m_camera.position()) > 2 * np.linalg.norm(first)


def test_lights(view):
    Scene.show(ball(), "ball")
    light = view.spotlight_with_idx(2)
    light.set_position([0, 4, 0.1])
    light.set_lookat([0, 0, 0])
    light.set_power_for_point([0, 0, 0.1], 3)
    light.m_color = [1, 0.5, 0.25]
    own = view.own.lights["rim"]
    np.testing.assert_allclose(own.position, [0, 4, 0.1], atol=1e-6)
    assert own.intensity == pytest.approx(3 * 16)
    np.testing.assert_allclose(own.color, [1, 0.5, 0.25], atol=1e-3)
    with pytest.raises(easypbr.UnknownNameError, match="there is no light 3"):
        view.spotlight_with_idx(3)


def test_lenses_of_cameras_that_are_not_moved(view):
    """m_fov is the vertical one times the aspect ratio, 64 / 48; the fitted camera stays automatic."""
    Scene.show(ball(), "ball")
    view.m_camera.m_fov = 60
    view.m_camera.m_exposure = 3
    view.draw()
    assert view.own.camera.fov_y_deg == pytest.approx(45) and view.own.settings.tonemap.exposure == 3
    # The ball fills the height but for the margin, as in the test above.
    assert np.arcsin(1 / np.linalg.norm(view.m_camera.position())) / np.radians(45 / 2) == pytest.approx(0.95, abs=0.02)
    view.m_camera.set_position([0, 0, 4])
    view.draw()
    assert view.m_camera.m_fov == pytest.approx(60)
    view.m_camera.m_fov = 80
    view.draw()
    assert view.own.camera.fov_y_deg == pytest.approx(60)
    np.testing.assert_allclose(view.m_camera.position(), [0, 0, 4], atol=1e-6)


# Meshes.


def test_arrays_are_changed_in_place(view):
    mesh = Mesh()
    mesh.create_box(1, 1, 1)
    Scene.show(mesh, "box")
    V = mesh.V
    for height in (5.5, 10.5):  # Half a side, and five for each step.
        V[:, 1] += 5
        view.draw()
        assert easypbr.Scene.get("box").bounding_box()[1][1] == pytest.approx(height)
    mesh.V[:, 0] *= 2
    assert mesh.get_scale() == pytest.approx(2)
    mesh.normalize_size()
    view.draw()
    assert mesh.get_scale() == pytest.approx(1), "what was read before is not the mesh's any more"
    mesh.C = np.zeros((len(V), 3))
    mesh.C[:, 0] = 1
    view.draw()
    assert easypbr.Scene.get("box").C[0].tolist() == [1, 0, 0]


def test_poses_in_one_line():
    mesh = ball()
    mesh.model_matrix = mesh.model_matrix.set_translation([1, 2, 3]).rotate_axis_angle([0, 1, 0], 90)
    np.testing.assert_allclose(mesh.model_matrix.translation(), [1, 2, 3])
    # A quarter turn about y brings x to -z.
    np.testing.assert_allclose(mesh.model_matrix.linear() @ [1, 0, 0], [0, 0, -1], atol=1e-12)


def test_arrays_in_any_order_and_of_any_number(view):
    mesh = Mesh()
    mesh.F = [[0, 1, 2]]
    mesh.V = np.eye(3)
    mesh.C = np.eye(3)
    Scene.show(mesh, "mesh")
    np.testing.assert_array_equal(mesh.V, np.eye(3))
    cloud = Mesh()
    for count in (5, 9, 3):
        cloud.V = np.random.default_rng(count).random((count, 3))
        cloud.L_pred = np.arange(count).reshape(-1, 1)
        cloud.m_vis.m_show_points = True
        cloud.m_vis.set_color_semanticpred()
        Scene.show(cloud, "cloud")
        view.draw()
        own = easypbr.Scene.get("cloud")
        assert len(own.V) == count and own.L.tolist() == list(range(count)) and own.style.mode == "points"
    cloud.L_gt = [7, 8, 9]
    cloud.m_vis.set_color_semanticgt()
    view.draw()
    assert easypbr.Scene.get("cloud").L.tolist() == [7, 8, 9]
    mesh.F = [[0, 1, 3]]
    with pytest.raises(easypbr.ArgumentError, match="F"):
        view.draw()
    mesh.F = [[0, 1, 2]]
    view.draw()


def test_options_become_styles():
    mesh = ball()
    options = mesh.m_vis
    options.m_show_wireframe = options.m_show_points = True
    options.m_point_size, options.m_line_width, options.m_metalness, options.m_opacity = 7, 3, 1, 0.5
    own = mesh.handle()
    style = own.style
    assert (style.mode, style.show_points, style.show_wireframe, style.point_size, style.line_width) == ("mesh", True, True, 7, 3)
    assert (own.material.metallic, own.material.opacity) == (1, 0.5)
    options.m_show_mesh = False
    assert (mesh.handle().style.mode, mesh.handle().style.visible) == ("points", True)
    options.m_show_points = False
    assert mesh.handle().style.visible is False, "nothing is to be shown"
    with pytest.raises(AttributeError, match="no 'm_show_pionts' .did you mean 'm_show_points'"):
        options.m_show_pionts = True


def test_lines_show_their_points_too():
    mesh = Mesh()
    mesh.create_line_strip_from_points([[0, 0, 0], [0, 1, 0], [0.2, 2, 0]])
    mesh.m_vis.m_show_points = True
    style = mesh.handle().style
    assert (style.mode, style.show_points) == ("lines", True)


def test_surfels_have_the_radius_that_was_seen():
    mesh = ball()
    mesh.recalculate_normals()
    mesh.compute_tangents(0.2)
    mesh.m_vis.m_show_surfels = True
    own = mesh.handle()
    assert own.style.mode == "surfels"
    np.testing.assert_allclose(np.linalg.norm(own.T, axis=1), 0.2 / np.sqrt(2), rtol=1e-5)
    np.testing.assert_allclose((own.T * own.N).sum(axis=1), 0, atol=1e-6)


def test_shapes_and_poses():
    mesh = Mesh()
    mesh.create_cylinder([1, 0, 0], 3, 0.5, True, True)
    np.testing.assert_allclose(mesh.handle().bounding_box(), [[0, -0.5, -0.5], [3, 0.5, 0.5]], atol=1e-5)
    faces = len(mesh.F)
    mesh.create_cylinder([0, -1, 0], 2, 0.5, False, False)
    np.testing.assert_allclose(mesh.handle().bounding_box()[:, 1], [-1, 1], atol=1e-6)
    assert 0 < len(mesh.F) < faces
    mesh.create_box(1, 2, 4)
    assert mesh.get_scale() == pytest.approx(4)
    mesh.scale_mesh(0.5)
    faces = len(mesh.F)
    mesh.upsample(1, smooth=False)
    assert len(mesh.F) == 4 * faces
    mesh.translate_model_matrix([1, 0, 0])
    mesh.model_matrix.rotate_axis_angle([0, 1, 0], 90)
    np.testing.assert_allclose(mesh.model_matrix.translation(), [1, 0, 0])
    mesh.apply_model_matrix_to_cpu(True)
    # 0.5 x 1 x 2 turned about y, then moved: 2 along x.
    np.testing.assert_allclose(mesh.handle().bounding_box(), [[0, -0.5, -0.25], [2, 0.5, 0.25]], atol=1e-6)
    np.testing.assert_array_equal(mesh.model_matrix.matrix(), np.eye(4))
    mesh.set_model_matrix_from_string("1 2 3 0 0 1 0")
    np.testing.assert_allclose(mesh.model_matrix.linear(), np.diag([-1, -1, 1]), atol=1e-12)
    np.testing.assert_allclose(np.abs(mesh.model_matrix.quat()), [0, 0, 1, 0], atol=1e-12)


def test_removal_and_merging():
    mesh = Mesh()
    mesh.V = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    mesh.F = [[0, 1, 2], [1, 2, 3]]
    mesh.remove_vertices_at_zero()
    assert mesh.V.tolist() == [[1, 0, 0], [0, 1, 0], [0, 0, 1]] and mesh.F.tolist() == [[0, 1, 2]]
    other = ball(0.5)
    other.translate_model_matrix([5, 0, 0])
    mesh.add([other])
    assert mesh.handle().bounding_box()[1][0] == pytest.approx(5.5)
    copy = mesh.clone()
    copy.V = copy.V * 2
    assert copy.get_scale() == pytest.approx(2 * mesh.get_scale())
    assert mesh.radius_search([1, 0, 0], 0.1) == 1
    with pytest.raises(easypbr.ArgumentError, match="expected .* values, got 2"):
        mesh.remove_marked_vertices([True, False], True)


# The scene.


def test_the_scene_by_names(view):
    Scene.show(ball(), "a1")
    Scene.show(ball(2, (4, 0, 0)), "a2")
    Scene.show(ball(), "b")
    assert Scene.nr_meshes() == 3 and Scene.does_mesh_with_name_exist("a2")
    assert Scene.get_scale() == pytest.approx(7, rel=0.01), "from -1 to 6"
    Scene.hide_all()
    view.draw()
    assert easypbr.Scene.get("b").style.visible is False
    Scene.show_all()
    Scene.remove_meshes_starting_with_name("a")
    assert easypbr.Scene.names() == ["b"] and Scene.get_mesh_with_idx(0) is Scene.get_mesh_with_name("b")
    with pytest.raises(easypbr.UnknownNameError, match="there is no mesh 'a1' in the scene: there are b"):
        Scene.get_mesh_with_name("a1")
    Scene.set_floor_visible(False)
    view.draw()
    assert view.own.settings.ground.mode == "none"
    Scene.set_floor_visible(True)


def test_meshes_that_are_empty_at_first(view):
    mesh = Mesh()
    Scene.show(mesh, "later")
    view.draw()
    assert Scene.get_scale() == 0
    mesh.V = np.eye(3)
    mesh.m_vis.m_show_points = True
    view.draw()
    assert Scene.get_scale() == pytest.approx(1) and (view.gbuffer_mat_with_name("depth_gtex").data > 0).any()


def test_the_grid_is_hidden_by_its_name(view):
    Scene.show(ball(), "ball")
    Scene.get_mesh_with_name("grid_floor").m_vis.m_is_visible = False
    view.draw()
    assert view.own.settings.ground.mode == "none"
    assert not Scene.get_mesh_with_name("grid_floor").m_vis.m_is_visible
    Scene.get_mesh_with_name("grid_floor").m_vis.m_is_visible = True
    view.draw()
    assert view.own.settings.ground.mode != "none"


# The rest.


def test_colors_labels_frames(view):
    colors = ColorMngr().eigen2color([0.0, 1.0, 2.0], "viridis")
    np.testing.assert_allclose(colors, easypbr.colormap("viridis")[[0, 128, 255]] / 255)
    # What is no number has the colour of the least.
    np.testing.assert_allclose(ColorMngr().eigen2color([np.nan, 1.0, 2.0], "viridis"), easypbr.colormap("viridis")[[0, 0, 255]] / 255)
    assert LabelMngr(3, -1)._map().color_of(1) == LabelMngr(3, 0)._map().color_of(1), "no class is unlabelled"
    labels = LabelMngr(3, 0)
    labels.set_color_for_label_with_idx(1, [1, 0, 0])
    mesh = ball()
    mesh.m_label_mngr, mesh.L_pred = labels, np.arange(len(mesh.V)) % 3
    assert mesh.handle().label_map.color_of(1) == (255, 0, 0)
    camera = Camera()
    camera.set_position([1, 2, 5])
    frame = Frame()
    frame.from_camera(camera, 640, 480)
    point = np.array([0.3, 0.1, -0.2])
    x, y = frame.project(point)
    depth = -(np.linalg.inv(camera.model_matrix()) @ np.append(point, 1))[2]
    np.testing.assert_allclose(frame.unproject(x, y, depth), point, atol=1e-9)
    np.testing.assert_allclose(frame.pos_in_world(), [1, 2, 5])
    small = frame.subsample(4)
    # Pixel centres lie at integers: (x + 0.5) / 4 - 0.5.
    np.testing.assert_allclose(small.project(point), (np.array([x, y]) + 0.5) / 4 - 0.5)
    assert len(frame.create_frustum_mesh(1.0).E) > 0
    back = Camera()
    back.from_frame(frame)
    np.testing.assert_allclose(back.model_matrix(), camera.model_matrix(), atol=1e-9)


def test_images_and_times(view):
    mat = Mat(np.zeros((4, 6, 3), np.float32) + [0, 0.5, 1])
    Gui.show(mat, "a", mat.flip_x(), "b")
    assert view.own.image_names() == ["a", "b"]
    torch = pytest.importorskip("torch")
    tensor = old.mat2tensor(mat)
    assert tuple(tensor.shape) == (1, 3, 4, 6)
    np.testing.assert_array_equal(old.tensor2mat(tensor).data, mat.data)
    assert torch.is_tensor(tensor)
    Profiler.start("a")
    Profiler.end("a")
    assert Profiler.get_elapsed_ms("a") >= 0
    with pytest.raises(easypbr.ArgumentError, match="it was not started"):
        Profiler.end("b")


def test_configuration_files(tmp_path):
    path = tmp_path / "scene.cfg"
    path.write_text("""// a comment
core: { hidpi: false }
visualization: {
    tonemap: "reinhard"
    cam: { fov: 30 near: "auto" exposure: 1.5 }
    ssao: { enable_ssao: false, kernel_radius: "auto" }
    lights: { nr_spot_lights: 3 spot_light_0: { power: 12.5 color: [1.0, 0.5, 0.25] } }
}
train: { lr: 1e-3 dirs: ["a", "b"] }
""")
    view = Viewer.create(path)
    assert view.own.settings.tonemap.exposure == 1.5 and view.own.settings.ssao.enabled is False
    assert view.own.settings.tonemap.operator == "reinhard"
    assert view.own.lights["key"].intensity == 12.5
    assert view.m_camera.m_fov == 30
    for text, message in (("a: {\n b: ]", r"line 2: expected a value, got ']'"), ("a: what", "line 1: expected a number"),
                          ("a: [1", "expected"), (": 3", "expected a key")):  # fmt: skip
        with pytest.raises(easypbr.FormatError, match=message):
            old_config.parse(text, "x.cfg")
    with pytest.raises(easypbr.FileError, match="missing.cfg"):
        Viewer.create(tmp_path / "missing.cfg")


def test_every_name_of_the_page_is_there():
    """First column of the tables of docs/from_easypbr1.md: Class.name, or name of a class named in the heading."""
    page = (Path(__file__).parents[2] / "docs/from_easypbr1.md").read_text()
    rows = re.findall(r"^\| (`.*?) \|", page, re.MULTILINE)
    names = [name for row in rows for name in re.findall(r"`([\w.]+)", row)]
    instances = {"Viewer": Viewer.create(), "Mesh": Mesh(), "Camera": Camera(), "Frame": Frame(), "Mat": Mat(),
                 "VisOptions": Mesh().m_vis}  # fmt: skip
    assert len(names) > 60
    for name in names:
        holder, _, member = name.partition(".")
        assert hasattr(instances.get(holder, getattr(old, holder, None)), member) if member else hasattr(old, holder), name

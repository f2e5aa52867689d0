"""easypbr.compat.pyrender: Viewer, without its window: its flags, its lights, and what it does before each frame.
The window itself: tests/window/test_pyrender_window.py."""

import threading

import numpy as np
import pytest

import easypbr.compat.pyrender as pyrender
from easypbr.compat.pyrender.changes import Latest

CORNERS = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
FACES = [[0, 1, 2], [0, 2, 3]]


def at(x, y, z):
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


def square(**values):
    material = pyrender.MetallicRoughnessMaterial(metallicFactor=0.0, roughnessFactor=1.0, **values)
    return pyrender.Mesh([pyrender.Primitive(CORNERS, normals=np.tile([0.0, 0, 1], (4, 1)), indices=FACES, material=material)])


def scene_of(mesh, **values):
    """A mesh three metres before the camera, and its node."""
    scene = pyrender.Scene(bg_color=[0.0, 0, 0], **values)
    node = scene.add(mesh, pose=at(0, 0, -3))
    scene.add(pyrender.PerspectiveCamera(yfov=0.9))
    return scene, node


def viewer_of(scene, **values):
    return pyrender.Viewer(scene, viewport_size=(96, 72), auto_start=False, **values)


def frame(viewer):
    """What the window draws next."""
    view = viewer._drawing.view
    view._run(view._before_draw)
    return view.render((96, 72))[:, :, :3].astype(int)


@pytest.fixture
def updates(monkeypatch):
    """How often the scene was taken over."""
    found = []
    update = pyrender.Viewer.update
    monkeypatch.setattr(pyrender.Viewer, "update", lambda viewer: (found.append(1), update(viewer))[1])
    return found


# Flags.


def test_keyword_arguments_are_flags():
    scene, _ = scene_of(square())
    words = {"shadows": True, "cull_faces": False, "all_wireframe": True, "point_size": 7, "rotate": True}
    made = viewer_of(scene, render_flags={"point_size": 3}, **words)
    assert {name: made.render_flags[name] for name in ("shadows", "cull_faces", "all_wireframe", "point_size")} == {
        "shadows": True, "cull_faces": False, "all_wireframe": True, "point_size": 7}  # fmt: skip
    assert made.viewer_flags["rotate"] is True and "shadows" not in made.viewer_flags
    assert made.render_flags["flip_wireframe"] is False, "defaults are there, too"


def test_keyword_arguments_are_drawn():
    scene, node = scene_of(square())
    assert (frame(viewer_of(scene)).max(axis=2) > 0).mean() > 0.3
    assert (frame(viewer_of(scene, all_wireframe=True)).max(axis=2) > 0).mean() < 0.2
    turned = at(0, 0, -3)
    turned[:3, :3] = np.diag([-1, 1, -1])
    scene.set_pose(node, turned)
    assert frame(viewer_of(scene)).max() == 0
    assert frame(viewer_of(scene, cull_faces=False)).max() > 0
    scene.add(pyrender.Mesh.from_points([[0, 0, -2.0]]))
    assert (frame(viewer_of(scene, point_size=9)).max(axis=2) > 0).sum() > 40


@pytest.mark.parametrize("values", [{"shadow": True}, {"render_flags": {"shadow": True}}, {"viewer_flags": {"shadow": 1}}])
def test_words_that_no_flag_has_are_named(values):
    with pytest.raises(TypeError, match="expected .*; got shadow$"):
        viewer_of(scene_of(square())[0], **values)


# Lights of the camera.


@pytest.mark.parametrize("flags, lux", [
    ({"use_direct_lighting": True}, 3.0), ({"use_direct_lighting": True, "lighting_intensity": 1.5}, 1.5),
    ({"use_raymond_lighting": True}, 3 * np.cos(np.pi / 6)),
])  # fmt: skip
def test_lights_of_the_camera_light_a_scene_that_has_none(flags, lux):
    """A rough square that faces them reflects lux * base colour / pi, and as a dielectric some percent of it more."""
    scene, _ = scene_of(square(baseColorFactor=(0.5, 0.5, 0.5)))
    linear = 0.5 * lux / np.pi
    expected = 255 * (1.055 * linear ** (1 / 2.4) - 0.055)
    middle = frame(viewer_of(scene, **flags))[36, 48]
    assert np.ptp(middle) <= 1 and expected - 8 <= middle[0] <= expected + 8


def test_lights_of_the_camera_move_with_it():
    scene, _ = scene_of(square())
    viewer = viewer_of(scene, use_direct_lighting=True, lighting_intensity=2.0)
    view = viewer._drawing.view
    front = frame(viewer)[36, 48, 0]
    beside = np.array([[0.5, 0, np.sqrt(0.75), 0], [0, 1, 0, 0], [-np.sqrt(0.75), 0, 0.5, 0], [0, 0, 0, 1]])
    beside[:3, 3] = (0, 0, -3) + 3 * beside[:3, 2]
    view.camera = beside  # As by the mouse.
    turned = frame(viewer)[36, 48, 0]
    # Of a light at 60 degrees one half arrives: 1 / 2.2 of a doubling in sRGB.
    assert turned / front == pytest.approx(0.5 ** (1 / 2.2), abs=0.05)
    assert np.array_equal(view.camera.T_world_cam, beside)
    viewer.viewer_flags["use_direct_lighting"] = False
    viewer.scene.add(pyrender.DirectionalLight(intensity=2.0))
    frame(viewer)
    assert viewer._drawing.view.scene.light_names() == ["light 0"]


def test_lights_of_the_camera_wait_for_something_to_place_a_camera_for():
    scene = pyrender.Scene(bg_color=[0.0, 0, 0])
    viewer = viewer_of(scene, use_direct_lighting=True)
    viewer._follow()
    scene.add(square())
    assert frame(viewer).max() > 100
    assert viewer._drawing.view.scene.light_names() == ["camera light 0"]


# Sizes.


def extent(picture):
    """Columns and rows that something is drawn in."""
    rows, columns = np.nonzero(picture[:, :, :3].max(axis=2))
    return np.ptp(columns) + 1, np.ptp(rows) + 1


@pytest.mark.parametrize("pixels", [(96, 72), (144, 72), (72, 144), (288, 216)])
def test_a_perspective_camera_follows_a_window_that_is_resized(pixels):
    """As pyrender's, whose aspectRatio is the window's: a square of two metres, three before the camera, is square, and
    1 / (3 * tan(0.45)) of the height."""
    view = viewer_of(scene_of(square())[0])._drawing.view
    expected = pixels[1] / (3 * np.tan(0.45))
    # One pixel: edges are covered in parts on both sides.
    assert extent(view.render(pixels)) == pytest.approx((min(expected, pixels[0]), expected), abs=1.1)


def test_parallel_lines_of_sight_have_square_pixels_in_the_window():
    class Stretched(pyrender.OrthographicCamera):
        def get_projection_matrix(self, width=None, height=None):
            P = super().get_projection_matrix(width, height)
            P[0, 0] /= 2
            return P

    scene = pyrender.Scene(bg_color=[0.0, 0, 0])
    scene.add(square(), pose=at(0, 0, -3))
    scene.add(Stretched(2.0, 2.0))
    # 72 rows are 2 * ymag = 4 metres: 36 are the square's two.
    assert extent(frame(viewer_of(scene))) == pytest.approx((36, 36), abs=1.1)


@pytest.mark.parametrize("pixels", [np.array([96, 72]), [96, 72], (np.int64(96), 72)])
def test_sizes_may_be_arrays(pixels):
    viewer = pyrender.Viewer(scene_of(square())[0], viewport_size=pixels, auto_start=False)
    assert viewer.viewport_size == (96, 72) and viewer._drawing.view.render().shape[:2] == (72, 96)


# Changes.


def changed(scene, node):
    """A change of each kind, with a word for it."""
    primitive = node.mesh.primitives[0]
    camera = scene.main_camera_node
    yield "added", lambda: scene.add(square(), name="second", pose=at(2.5, 0, -3))
    yield "moved", lambda: scene.set_pose(node, at(0.5, 0, -3))
    yield "translation", lambda: setattr(node, "translation", [-0.5, 0, -3])
    yield "color", lambda: setattr(primitive.material, "baseColorFactor", (1.0, 0, 0, 1))
    yield "positions", lambda: setattr(primitive, "positions", primitive.positions * 0.7)
    yield "background", lambda: setattr(scene, "bg_color", [0.1, 0.2, 0.3])
    yield "ambient", lambda: setattr(scene, "ambient_light", [0.5, 0.5, 0.1])
    yield "light", lambda: scene.add(pyrender.DirectionalLight(intensity=2.0), name="lamp")
    yield "intensity", lambda: setattr(next(iter(scene.lights)), "intensity", 0.5)
    yield "visible", lambda: setattr(node.mesh, "is_visible", False)
    yield "visible again", lambda: setattr(node.mesh, "is_visible", True)
    yield "children", lambda: camera.children.append(pyrender.Node(mesh=square(), matrix=at(0, 0, -9)))
    yield "camera", lambda: setattr(camera.camera, "yfov", 1.2)
    yield "camera moved", lambda: scene.set_pose(camera, at(0.3, 0, 0))
    yield "removed", lambda: scene.remove_node(node)


def test_the_window_follows_the_scene(updates):
    scene, node = scene_of(square(baseColorFactor=(0.8, 0.8, 0.8)))
    viewer = viewer_of(scene)
    before = frame(viewer)
    for what, change in changed(scene, node):
        with viewer.render_lock:
            change()
        updates.clear()
        after = frame(viewer)
        assert (after != before).any(), what
        assert len(updates) == 1, what
        before = after
    viewer.render_flags["all_wireframe"] = True
    assert (frame(viewer) != before).any()


def test_a_window_at_rest_does_not_look_at_the_scene(updates, monkeypatch):
    scene, _ = scene_of(square())
    viewer = viewer_of(scene, use_raymond_lighting=True)
    frame(viewer)
    updates.clear()
    seen, before = Latest.change, frame(viewer)
    monkeypatch.setattr(pyrender.Scene, "walk", lambda scene: pytest.fail("walked"))
    for _ in range(3):
        assert np.array_equal(frame(viewer), before)
    assert not updates and Latest.change == seen, "and taking it over changes nothing"


def test_who_moved_the_camera_in_the_window_keeps_it_while_the_scene_changes():
    scene, node = scene_of(square())
    viewer = viewer_of(scene)
    view = viewer._drawing.view
    frame(viewer)
    view.camera = at(0, 0, 2)
    scene.set_pose(node, at(0.5, 0, -3))
    frame(viewer)
    assert view.camera.T_world_cam[2, 3] == 2


def test_the_window_does_not_wait_for_ever_for_the_lock():
    """Who holds the lock may close the window, which waits for its thread."""
    scene, node = scene_of(square())
    viewer = viewer_of(scene)
    with viewer.render_lock:
        scene.remove_node(node)
        thread = threading.Thread(target=viewer._follow)
        thread.start()
        thread.join(30)
        assert not thread.is_alive()
        assert viewer._drawing.shown, "what is changed under the lock is not taken over"
    viewer._follow()
    assert not viewer._drawing.shown


def test_lights_of_the_camera_are_moved_under_the_lock(monkeypatch):
    scene, _ = scene_of(square())
    viewer = viewer_of(scene, use_direct_lighting=True)
    viewer._drawing.view.camera = at(0, 0, 2)
    poses, is_free = [], []

    def carry(pose):
        poses.append(pose[2, 3])
        # A lock that its own thread holds is none to it.
        other = threading.Thread(target=lambda: is_free.append(viewer.render_lock.acquire(blocking=False)))
        other.start()
        other.join()

    monkeypatch.setattr(viewer._drawing, "carry", carry)
    with viewer.render_lock:
        thread = threading.Thread(target=viewer._follow)
        thread.start()
        thread.join(30)
        assert not thread.is_alive() and not poses
    viewer._follow()
    viewer._follow()
    assert (poses, is_free) == ([2], [False])


# Keys.


class Event:
    def __init__(self, key, repeat=False):
        self.key, self.repeat, self.kind = key, repeat, "key_down"


def test_registered_keys_call_their_functions():
    calls = []
    scene, _ = scene_of(square())
    spaced = [lambda viewer, *a, **b: calls.append((a, b)), [1, 2], {"c": 3}]
    viewer = viewer_of(scene, registered_keys={"s": lambda viewer: calls.append(("s", viewer)), " ": spaced})
    taken = [viewer._press(event) for event in (Event("S"), Event("S", True), Event("space"), Event("Q"))]
    assert (taken, calls) == ([True, True, True, False], []), "events are handled under the view's lock"
    frame(viewer)
    assert calls == [("s", viewer), ((1, 2), {"c": 3})]
    frame(viewer)
    assert len(calls) == 2


def test_functions_of_keys_may_take_the_lock_and_change_the_next_frame():
    """Who is in update() holds the lock and waits for the view: the thread of events must not wait for it."""
    scene, node = scene_of(square())

    def hide(viewer):
        with viewer.render_lock:
            scene.remove_node(node)

    viewer = viewer_of(scene, registered_keys={"h": hide})
    assert frame(viewer).max() > 0
    with viewer.render_lock:
        thread = threading.Thread(target=lambda: viewer._press(Event("H")), daemon=True)
        thread.start()
        thread.join(30)
        assert not thread.is_alive()
    assert frame(viewer).max() == 0


def test_an_exception_of_a_key_leaves_the_others(capsys):
    calls = []
    scene, _ = scene_of(square())
    viewer = viewer_of(scene, registered_keys={"a": lambda viewer: 1 / 0, "b": lambda viewer: calls.append("b")})
    for key in "AB":
        viewer._press(Event(key))
    frame(viewer)
    frame(viewer)
    assert calls == ["b"] and "ZeroDivisionError" in capsys.readouterr().err

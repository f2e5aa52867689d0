"""Images, cameras and animations in a viewer, without a display."""
import threading

import numpy as np
import pytest

import easypbr
from easypbr import Scene, Viewer, shapes

SIZE = (900, 500)


@pytest.fixture
def view():
    scene = Scene()
    scene.show(shapes.box(), "box")
    return Viewer(SIZE, {"image": {"samples": 1}}, scene)


@pytest.mark.parametrize("image", [
    np.zeros((4, 6), np.uint8), np.zeros((4, 6, 1), np.float32), np.zeros((4, 6, 3), np.float64),
    np.zeros((4, 6, 4), np.float16), np.zeros((4, 6), bool), np.arange(24).reshape(4, 6),
    np.zeros((4, 6, 3), np.uint16), np.full((4, 6), np.nan), np.zeros((8, 6, 3), np.uint8)[::2],
])
def test_images_of_every_kind(view, image):
    before = view.screenshot()
    view.show_image("image", image)
    assert view.image_names() == ["image"]
    assert np.any(view.screenshot() != before)
    view.remove_image("image")
    assert np.array_equal(view.screenshot(), before)


def test_tensors(view):
    torch = pytest.importorskip("torch")
    image = torch.full((4, 6, 3), 0.5, requires_grad=True)
    view.show_image("tensor", image)
    view.show_image("numpy", np.full((4, 6, 3), 0.5, np.float32))
    places, picture = view_places(view), view.screenshot()
    for name in ("tensor", "numpy"):
        x0, y0, x1, y1 = map(round, places[name])
        # 0.5 is shown as it is: no curve.
        assert tuple(picture[(y0 + y1) // 2, (x0 + x1) // 2, :3]) == (128, 128, 128)
    with pytest.raises(easypbr.ArgumentError, match=r"permute\(1, 2, 0\)"):
        view.show_image("tensor", image.permute(2, 0, 1))


def view_places(view):
    view.screenshot()
    return view._handle.gui_state()["places"]


def test_an_image_is_replaced_in_every_iteration(view):
    for step in range(50):
        view.show_image("loss", np.full((8, 8, 3), 5 * step, np.uint8))
    x0, y0, x1, y1 = view_places(view)["loss"]
    assert tuple(view.screenshot()[round((y0 + y1) / 2), round((x0 + x1) / 2), :3]) == (245, 245, 245)


def test_a_frame_that_is_drawn_is_not_waited_for(view):
    """While another thread draws, here in a panel of a frame, the newest image of a name waits for the next frame."""
    entered, leave, in_time = threading.Event(), threading.Event(), []

    @view.add_panel("Slow")
    def slow(ui):
        entered.set()
        in_time.append(leave.wait(20))

    drawing = threading.Thread(target=view.screenshot)
    drawing.start()
    assert entered.wait(60)
    for step in range(3):
        view.show_image("loss", np.full((8, 8, 3), 100 * step, np.uint8))
    with pytest.raises(easypbr.ArgumentError, match="expected 1, 3 or 4 channels, got 2"):
        view.show_image("pair", np.zeros((2, 2, 2)))
    leave.set()
    drawing.join()
    assert all(in_time)
    assert view.image_names() == ["loss"]
    x0, y0, x1, y1 = view_places(view)["loss"]
    assert tuple(view.screenshot()[round((y0 + y1) / 2), round((x0 + x1) / 2), :3]) == (200, 200, 200)


def test_range_and_colormap(view):
    view.show_image("depth", np.array([[0.0, 5.0]]), range=(0, 10), colormap="grey")
    x0, y0, x1, y1 = view_places(view)["depth"]
    picture, y = view.screenshot(), round((y0 + y1) / 2)
    assert tuple(picture[y, round(x0 + 0.25 * (x1 - x0)), :3]) == (0, 0, 0)
    assert tuple(picture[y, round(x0 + 0.75 * (x1 - x0)), :3]) == (128, 128, 128)


@pytest.mark.parametrize("name, image, options", [
    ("", np.zeros((2, 2)), {}), ("a", np.zeros((2, 2, 2)), {}), ("a", np.zeros(4), {}), ("a", np.zeros((0, 3)), {}),
    ("a", np.zeros((2, 2)), {"range": (1, 1)}), ("a", np.zeros((2, 2)), {"range": (0, np.nan)}), ("a", "text", {}),
    ("a", np.zeros((2, 2), complex), {}), ("a", None, {}), ("a", np.zeros((16385, 2)), {}), ("a", np.zeros((2, 16385, 3)), {}),
])
def test_what_is_no_image_is_refused(view, name, image, options):
    with pytest.raises(easypbr.ArgumentError):
        view.show_image(name, image, **options)
    with pytest.raises(easypbr.UnknownNameError):
        view.show_image("b", np.zeros((2, 2)), colormap="rainbows")
    with pytest.raises(easypbr.UnknownNameError):
        view.remove_image("nothing")
    assert view.image_names() == []


def test_what_is_no_number_is_told_by_its_name(view):
    for set_it, name in ((lambda: setattr(view, "time", "a"), "time"), (lambda: setattr(view, "animation_time", None), "animation_time"),
                         (lambda: view.play(speed="x"), "speed")):
        with pytest.raises(easypbr.ArgumentError, match=f"^{name}: expected "):
            set_it()


def test_numbers_beyond_float64_are_told_by_their_name(view):
    # The largest float64 is 1.8e308.
    too_large = 10**400
    for set_it, name in ((lambda: setattr(view, "time", too_large), "time"),
                         (lambda: setattr(view, "animation_time", -too_large), "animation_time"),
                         (lambda: view.play(speed=too_large), "speed"),
                         (lambda: setattr(view.lights["key"], "color", (too_large, 0, 0)), "lights.key.color"),
                         (lambda: setattr(view, "camera", [[too_large] * 4] * 4), "camera")):
        with pytest.raises(easypbr.ArgumentError, match=f"^{name}: expected "):
            set_it()


@pytest.mark.parametrize("options", [
    {"scale": 0}, {"scale": -1}, {"scale": float("nan")}, {"scale": 1e-3}, {"scale": 5}, {"size": (0, 5)}, {"size": (-3, 5)},
])
def test_no_screenshot_has_such_a_size_or_scale(view, options):
    with pytest.raises(easypbr.ArgumentError):
        view.screenshot(**options)
    assert view.screenshot((64, 48)).shape == (48, 64, 4)


def test_a_camera_is_shown_with_its_image(view):
    K = [[100, 0, 79.5], [0, 100, 59.5], [0, 0, 1]]
    T_world_cam = np.eye(4)
    T_world_cam[:3, 3] = (3, 0, 0)
    mesh = view.add_camera_frustum("left", K, T_world_cam, np.full((120, 160, 3), 200, np.uint8), depth=2)
    assert view.scene.names() == ["box", "left"]
    # OpenCV's cameras look along +z; a picture 160 wide at a focal length of 100 is 1.6 wide at depth 1.
    low, high = mesh.bounding_box()
    assert np.allclose((high - low)[[0, 2]], (3.2, 2), atol=1e-5) and abs(low[2]) < 1e-6
    view.add_camera_frustum("left", K, np.eye(4), size=(160, 120))
    assert view.scene.names() == ["box", "left"]
    with pytest.raises(easypbr.ArgumentError):
        view.add_camera_frustum("right", K, np.eye(4))


def test_the_panels_path_and_the_panels_that_are_shown(view):
    assert view.camera_path is None
    path = easypbr.CameraPath([easypbr.Camera.look_at((x, 0.2, 0.8), (0, 0, 0)) for x in (-0.3, 0, 0.3)])
    before = view.screenshot()
    view.camera_path = path
    assert np.array_equal(view.camera_path.pose(1.3), path.pose(1.3))
    assert np.any(view.screenshot() != before)
    view.show_panels("Camera path", "Recorder")
    view.screenshot()
    state = view._handle.gui_state()
    assert state["panels"] == ["Camera path", "Recorder"] and "Camera path/key 3" in state["places"]
    assert "Recorder/Picture" in state["places"]
    for wrong in (lambda: view.show_panels("Camera paths"), lambda: setattr(view, "camera_path", [1])):
        with pytest.raises(easypbr.ArgumentError):
            wrong()


def animated(tmp_path):
    """A triangle that goes 2 units along x in a second, as glTF."""
    import base64
    import json
    import struct

    data = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0) + struct.pack("<2f", 0, 1) + struct.pack("<6f", 0, 0, 0, 2, 0, 0)
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    file = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [
                {"mesh": 0, "name": "tri", "children": [1]},
                {"name": "eye", "translation": [0, 0, 9], "camera": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "buffers": [{"byteLength": len(data), "uri": uri}],
            "bufferViews": [{"buffer": 0, "byteOffset": o, "byteLength": n} for o, n in ((0, 36), (36, 8), (44, 24))],
            "accessors": [
                {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
                {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
                {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}],
            "extensions": {"KHR_lights_punctual": {"lights": [{"name": "lamp", "type": "point", "intensity": 5}]}},
            "animations": [{"name": "slide", "samplers": [{"input": 1, "output": 2}],
                            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}]}
    path = tmp_path / "slide.gltf"
    path.write_text(json.dumps(file))
    return easypbr.load_scene(path)


def test_lights_and_cameras_of_a_file_go_with_it(tmp_path):
    file = animated(tmp_path)
    assert file.animations.lights(0.5)["lamp"].position == pytest.approx((1, 0, 9))
    assert file.animations.cameras(0.5, "slide")["eye"].position == pytest.approx((1, 0, 9))
    assert file.animations.lights(1.5, loop=False)["lamp"].position == pytest.approx((2, 0, 9))
    with pytest.raises(easypbr.UnknownNameError):
        file.animations.lights(0, "slid")
    with pytest.raises(easypbr.ArgumentError):
        file.animations.cameras(float("nan"))
    scene = Scene()
    scene.show(file.mesh, "file")
    view = Viewer((32, 24), {"image": {"samples": 1}}, scene)
    view.add_light("lamp", file.lights["lamp"])
    with pytest.raises(easypbr.ArgumentError, match="no further values, got intensity"):
        view.add_light("lamp", file.lights["lamp"], intensity=3)
    view.play(file.animations)
    view.animation_time = 0.5
    assert scene.light("lamp").position == pytest.approx((1, 0, 9))


def test_a_turntable_is_around_what_an_animation_moves(tmp_path):
    """The triangle's middle goes from x = 0.5 to 2.5: a turn is around x = 0.5 at rest, and 1.5 while it plays."""
    file = animated(tmp_path)
    scene = Scene()
    scene.show(file.mesh, "file")
    view = Viewer((32, 24), {"image": {"samples": 1}}, scene)

    def middle_and_radius(path):
        begin, opposite = (path.pose(seconds)[:3, 3] for seconds in (0, 1))
        return (begin[0] + opposite[0]) / 2, np.linalg.norm(begin - opposite) / 2

    middle, near = middle_and_radius(view.turntable(2))
    assert middle == pytest.approx(0.5)
    view.play(file.animations)
    triangle = file.mesh.children[0]
    before = triangle.T_world_mesh
    middle, far = middle_and_radius(view.turntable(2))
    # Half a diagonal of 1 x 1 has become one of 3 x 1.
    assert middle == pytest.approx(1.5) and far > 1.5 * near
    np.testing.assert_array_equal(triangle.T_world_mesh, before)
    view.pause()
    assert middle_and_radius(view.turntable(2)) == pytest.approx((0.5, near))


def test_an_animation_plays_in_a_recording(tmp_path):
    file = animated(tmp_path)
    scene = Scene()
    scene.show(file.mesh, "file")
    view = Viewer((32, 24), {"image": {"samples": 1}}, scene)

    view.camera = easypbr.Camera.look_at((0, 0, 9), (0, 0, 0))
    centre = (16.5, 11.5)  # right of and above the origin, on the triangle's corner
    assert view.pick(*centre) is not None
    view.play(file.animations, "slide", speed=2)
    assert view.is_playing and view.pick(*centre) is not None
    with view.recorder.start(tmp_path / "frame_%02d.png", fps=8):
        view.recorder.add_frame()
        view.recorder.add_frame()
    # Two frames of 1/8 s at double speed: half a second, one unit.
    assert abs(view.animation_time - 0.5) < 1e-12 and view.pick(*centre) is None
    view.pause()
    assert not view.is_playing
    view.animation_time = 0.25
    assert view.animation_time == 0.25
    view.play()
    assert view.is_playing

    def after_a_frame():
        with view.recorder.start(tmp_path / "next_%02d.png", fps=8):
            view.recorder.add_frame()
        return view.animation_time

    assert after_a_frame() == pytest.approx(0.5)  # still at double speed
    view.play(speed=1, loop=False)
    view.pause()
    view.play()
    assert after_a_frame() == pytest.approx(0.625)
    # What is wrong changes nothing.
    with pytest.raises(easypbr.UnknownNameError):
        view.play(file.animations, "slid", speed=4, loop=True)
    with pytest.raises(easypbr.ArgumentError):
        view.play(speed=float("nan"), loop=True)
    assert after_a_frame() == pytest.approx(0.75)
    view.animation_time = 100
    assert view.animation_time < 100 and not view.is_playing  # it rests at its end
    view.time = 0
    view.play(file.animations, "slide", speed=-1, loop=False)
    assert view.is_playing and view.animation_time > 0
    for wrong in (lambda: view.play(file.animations, "slid"), lambda: view.play(file.animations, 3)):
        with pytest.raises(easypbr.UnknownNameError):
            wrong()
    with pytest.raises(easypbr.ArgumentError):
        view.play(file.animations, speed=float("nan"))
    with pytest.raises(easypbr.ArgumentError):
        Viewer((8, 8), scene=Scene()).play()

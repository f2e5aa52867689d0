"""What clients see: at rest the picture that is rendered, bit for bit; while something moves quick ones."""

import time

import numpy as np
import pytest

import easypbr
from client import MOVING, SHOT, STILL, Frame, camera_of


def rendered(view, client, size=None):
    """The same picture from the program's view."""
    for name, value in camera_of(client.texts["camera"]["text"]).items():
        view.settings[name] = value
    return view.render(size)


def test_at_rest_the_picture_is_the_rendered_one_bit_for_bit(view, connect, tmp_path):
    client = connect()
    exact = client.until_exact()
    assert (exact.width, exact.height, exact.refined, exact.total) == (160, 120, 4, 4)
    image = exact.image(tmp_path)
    assert np.array_equal(image, view.render())
    assert image[..., :3].std() > 5


def test_after_a_drag_too(view, connect, tmp_path):
    # The camera comes as text, in other numbers: its last bits differ, for which a path may take another course,
    # and a sector of the occlusion in one of the samples: a step of 1 in single pixels.
    view.settings.path.enabled = False
    view.render((200, 120))  # Lights are placed by the first camera.
    client = connect(size=(200, 120))
    before = client.until_exact()
    client.drag((100, 60), (150, 40))
    after = client.until_exact(before.number, shows=client.inputs)
    client.collect(0.3)
    image = after.image(tmp_path)
    assert not np.array_equal(image, before.image(tmp_path))
    difference = np.abs(image.astype(int) - rendered(view, client, (200, 120))).max(axis=-1)
    assert difference.max() <= 1 and np.count_nonzero(difference) <= difference.size // 1000
    assert any(frame.kind == MOVING for frame in client.frames)


def test_moving_pictures_name_the_input_that_they_show(connect):
    client = connect()
    client.until_exact()
    client.pointer("press", 80, 60)
    client.pointer("move", 120, 60)
    moving = client.until(lambda message: isinstance(message, Frame) and message.kind == MOVING)
    assert moving.input == client.inputs
    assert moving.codec == 1
    assert 0 < moving.wait_us < 30e6


def test_a_setting_changes_the_picture_and_is_told(view, connect, tmp_path):
    client = connect()
    first = client.until_exact()
    client.send("set", name="background.color", value="#ff0000")
    second = client.until_exact(first.number)
    assert tuple(second.image(tmp_path)[0, 0]) == (255, 0, 0, 255)
    client.until_setting("background.color", "#ff0000")
    view.settings["background.color"] = (1, 0, 0)
    assert np.array_equal(second.image(tmp_path), rendered(view, client))


def test_what_the_program_changes_is_seen_without_reloading(view, connect, tmp_path):
    client = connect()
    first = client.until_exact()
    view.scene.show(easypbr.shapes.sphere(1.3, 8), "larger")
    second = client.until_exact(first.number)
    assert not np.array_equal(first.image(tmp_path), second.image(tmp_path))
    client.until_known("scene", lambda scene: [node["path"] for node in scene["nodes"]] == ["ball", "larger"])
    view.settings["background.color"] = (0, 0, 1)
    third = client.until_exact(second.number)
    assert tuple(third.image(tmp_path)[0, 0]) == (0, 0, 255, 255)


def test_the_program_leaves_alone_what_it_has_not_changed(view, connect):
    client = connect()
    client.until_exact()
    client.send("set", name="background.color", value="#00ff00")
    client.until_setting("background.color", "#00ff00")
    view.settings["tonemap.exposure"] = 0.5
    client.until_setting("tonemap.exposure", "0.5")
    assert client.settings["background.color"]["value"] == "#00ff00"


def test_a_training_loop_is_followed(view, connect):
    client = connect()
    client.until_exact()
    ball = view.scene.get("ball")
    vertices = np.array(ball.V)
    for step in range(10):
        seen = client.frames[-1].number
        ball.V = vertices * (1 + 0.05 * step)
        client.collect(0.05)
    assert sum(frame.kind != STILL or not frame.is_exact for frame in client.frames) >= 2
    client.until_exact(seen)


def test_objects_are_hidden_and_shown(view, connect, tmp_path):
    client = connect()
    first = client.until_exact()
    client.send("show", object="ball", visible=False)
    client.until_known("scene", lambda scene: not scene["nodes"][0]["visible"])
    hidden = client.until_exact(first.number)
    assert not np.array_equal(first.image(tmp_path), hidden.image(tmp_path))
    client.send("show", object="ball", visible=True)
    client.until_known("scene", lambda scene: scene["nodes"][0]["visible"])
    again = client.until_exact(hidden.number)
    assert np.array_equal(first.image(tmp_path), again.image(tmp_path))
    client.send("show", object="nothing", visible=False)
    client.until_told("notice", lambda notice: "nothing" in notice["text"])


def test_picking_says_what_is_there(view, connect):
    scalars = np.arange(len(view.scene.get("ball").F), dtype=np.float32)
    view.scene.get("ball").scalars["error"] = scalars
    client = connect()
    client.until_exact()
    client.send("pick", id=5, x=80.5, y=60.5)
    pick = client.until_told("pick")
    assert pick["id"] == 5 and pick["hit"] and pick["object"] == "ball" and pick["face"]
    expected = view.pick(80.5, 60.5)
    assert pick["element"] == expected.element
    assert pick["position"] == pytest.approx(list(expected.position))
    assert pick["values"]["scalars"]["error"] == expected.element
    # Of vertices: x over a face is x of the place, whichever face; its label is that of most corners.
    ball = view.scene.get("ball")
    ball.scalars["x"] = np.ascontiguousarray(np.asarray(ball.V)[:, 0])
    place = np.asarray(view.pick(60.5, 40.5).position)
    corners = np.asarray(ball.F)[view.pick(60.5, 40.5).element]
    nearest = np.argmin(np.linalg.norm(np.asarray(ball.V)[corners] - place, axis=1))
    labels = np.full(len(ball.V), 3, np.int32)
    labels[corners[nearest]] = 8
    ball.L = labels
    client.send("pick", id=7, x=60.5, y=40.5)
    pick = client.until_told("pick", lambda message: message["id"] == 7)
    x = pick["position"][0]
    assert pick["values"]["scalars"]["x"] == pytest.approx(x, abs=1e-5)  # Single precision of a unit ball.
    assert pick["values"]["label"] == 3 and abs(x) > 0.1
    client.send("pick", id=6, x=1, y=1)
    assert not client.until_told("pick", lambda message: message["id"] == 6)["hit"]


def test_a_still_of_any_size(view, connect, tmp_path):
    client = connect()
    client.until_exact()
    client.send("shot", id=9, width=333, height=77)
    shot = client.until(lambda message: isinstance(message, Frame) and message.kind == SHOT)
    assert shot.input == 9 and (shot.width, shot.height) == (333, 77)
    assert np.array_equal(shot.image(tmp_path), rendered(view, client, (333, 77)))


def test_stills_of_a_client_that_has_left_hold_nobody_up(connect):
    client = connect()
    client.until_exact()
    for i in range(20):  # of seconds each
        client.send("shot", id=i, width=4096, height=4096)
    time.sleep(0.5)
    client.close()
    start = time.monotonic()
    connect().until_exact()
    assert time.monotonic() - start < 10


def test_only_a_few_stills_wait_at_a_time(connect):
    client = connect()
    client.until_exact()
    client.send("shot", id=1, width=2048, height=2048)
    for i in range(2, 12):
        client.send("shot", id=i, width=32, height=32)
    client.until_told("notice", lambda notice: notice["error"] and "stills" in notice["text"])
    client.collect(0.5)
    assert 1 <= sum(frame.kind == SHOT for frame in client.frames) <= 5


def test_undo_and_reset(connect):
    client = connect()
    first = client.until_exact()
    client.send("set", name="background.color", value="#123456")
    client.until_setting("background.color", "#123456")
    client.until_exact(first.number)
    client.send("act", what="undo")
    client.until_told("settings", lambda message: "background.color" in message["values"])
    assert client.settings["background.color"]["value"] != "#123456"
    client.send("set", name="background.color", value="#123456")
    client.until_setting("background.color", "#123456")
    client.send("act", what="reset")
    client.until_told("settings", lambda message: "background.color" in message["values"])
    assert client.settings["background.color"]["value"] != "#123456"


def test_undo_leaves_what_the_program_has_set(view, connect):
    client = connect()
    client.until_exact()
    client.send("set", name="background.color", value="#123456")
    client.until_setting("background.color", "#123456")
    client.collect(0.5)
    view.settings["tonemap.exposure"] = 4.0
    client.until_setting("tonemap.exposure", "4")
    client.send("act", what="undo")
    client.until_told("settings", lambda message: "background.color" in message["values"])
    assert client.settings["background.color"]["value"] != "#123456"
    assert client.settings["tonemap.exposure"]["value"] == "4"


@pytest.mark.parametrize("name, value", [
    ("background.mode", "image"), ("camera.pose", ",".join("0" * 16)), ("camera.intrinsics", "0,0,0,0,0,0"),
    ("camera.distortion", "0.1,0,0,0")])
def test_what_cannot_be_drawn_is_refused_and_the_view_goes_on(connect, name, value):
    client = connect()
    client.until_exact()
    client.send("set", name="tonemap.exposure", value="3")
    client.until_setting("tonemap.exposure", "3")
    before = {setting: told["value"] for setting, told in client.settings.items()}
    client.send("set", name=name, value=value)
    client.until_told("notice", lambda notice: notice["error"])
    client.collect(0.5)
    assert {setting: told["value"] for setting, told in client.settings.items()} == before
    last = client.frames[-1].number
    client.drag((50, 50), (90, 60))
    client.until_exact(last, client.inputs)


def test_what_cannot_be_drawn_by_the_program_s_settings_is_mended_by_them(view, connect):
    client = connect()
    first = client.until_exact()
    view.settings["background.mode"] = "image"
    client.until_told("notice", lambda notice: notice["error"] and "background.image" in notice["text"])
    # What else changes is told meanwhile.
    client.send("set", name="background.color", value="#123456")
    client.until_setting("background.color", "#123456")
    view.settings["background.mode"] = "color"
    client.until_exact(first.number)


def test_channels_and_resizing(connect, tmp_path):
    client = connect()
    first = client.until_exact()
    client.send("channel", name="normal_world")
    normals = client.until_exact(first.number)
    assert not np.array_equal(first.image(tmp_path), normals.image(tmp_path))
    client.send("resize", width=90, height=50)
    small = client.until(lambda message: isinstance(message, Frame) and message.is_exact and message.width == 90)
    assert small.height == 50
    client.send("channel", name="nonsense")
    client.until_told("notice", lambda notice: notice["error"])


def test_camera_text_is_taken_and_told(connect):
    client = connect()
    client.until_exact()
    client.send("camera", text="camera.pose=1,0,0,0,0,1,0,0,0,0,1,9,0,0,0,1 camera.fov_y_deg=20")
    client.until_known("camera", lambda message: "0,0,1,9" in message["text"])
    client.send("camera", text="tonemap.exposure=3")
    client.until_told("notice", lambda notice: notice["error"])


def test_the_camera_is_told_while_nothing_can_be_drawn(view, connect):
    client = connect()
    client.until_exact()
    view.settings["background.mode"] = "image"  # without one
    client.until_told("notice", lambda notice: notice["error"] and "background.image" in notice["text"])
    client.send("camera", text="camera.pose=1,0,0,0,0,1,0,0,0,0,1,9,0,0,0,1")
    client.until_known("camera", lambda message: "0,0,1,9" in message["text"])


def test_nothing_is_sent_while_nothing_changes(connect):
    client = connect()
    client.until_exact()
    client.collect(0.5)
    seen = len(client.frames)
    client.collect(1.5)
    assert len(client.frames) == seen


def test_a_client_that_is_hidden_gets_no_pictures(connect):
    client = connect()
    first = client.until_exact()
    client.send("pause", paused=True)
    client.send("set", name="background.color", value="#ff0000")
    client.collect(1)
    assert client.frames[-1].number == first.number
    client.send("pause", paused=False)
    client.until_exact(first.number)


def test_a_client_that_answers_nothing_is_sent_a_few_pictures_and_no_more(connect):
    client = connect(answers=False)
    client.collect(2)
    client.pointer("press", 80, 60)
    for step in range(40):
        client.pointer("move", 80 + step, 60)
        client.collect(0.03)
    # Which kinds they are is a matter of time: the exact picture may have come first.
    assert client.frames
    assert sum(frame.kind == MOVING for frame in client.frames) <= 8
    # It answers again: the newest camera is shown.
    client.answers = True
    for frame in list(client.frames):
        client.ack(frame)
    client.until(lambda message: isinstance(message, Frame) and message.input == client.inputs)


def test_the_gil_does_not_matter(connect):
    """A program that computes without end delays no picture by seconds."""
    client = connect()
    client.until_exact()
    end = time.monotonic() + 1
    while time.monotonic() < end:
        sum(range(10000))
    client.drag((80, 60), (120, 60))
    client.until_exact(shows=client.inputs)

"""The server's own panels: an object's look, lights, the camera's path, recordings."""

import json
import shutil
import subprocess
import tempfile
import time

import numpy as np
import pytest

import easypbr

from client import Client, Frame, camera_of

FILE, MP4 = 4, 4


def tool_is(client, panel, wanted):
    """Waits until a panel's widgets, by name, are as `wanted` says; returns them."""
    def named(message):
        return {widget["name"]: widget for widget in message["widgets"]}

    def fits(message):
        return message["name"] == panel and wanted(named(message))

    known = client.tools.get(panel)
    return named(known if known and fits(known) else client.until_told("tool", fits))


def use(client, panel, name, value="", nth=0):
    client.send("tool", panel=panel, name=name, use=nth, value=value)


def test_lights_are_added_changed_and_removed(view, connect):
    client = connect()
    before = client.until_exact()
    use(client, "Lights", "Add a light")
    rows = tool_is(client, "Lights", lambda rows: "light" in rows)
    lit = client.until_exact(before.number)
    light = view.scene.light("light")
    # As bright at the target as 3 lux: intensity over the squared distance, to the middle of what is seen.
    assert light.intensity == pytest.approx(3 * float(np.sum(np.square(light.position))), rel=1e-3)
    assert rows["intensity"]["field"]["doc"] and rows["range"]["field"]["min"] == 0
    use(client, "Lights", "color", "#ff0000")
    tool_is(client, "Lights", lambda rows: rows["color"]["value"] == "#ff0000")
    assert view.scene.light("light").color == pytest.approx([1, 0, 0])
    red = client.until_exact(lit.number)
    use(client, "Lights", "intensity", "-3")
    client.until_told("notice", lambda notice: notice["error"] and "intensity" in notice["text"])
    assert view.scene.light("light").intensity == light.intensity
    use(client, "Lights", "Remove light")
    tool_is(client, "Lights", lambda rows: "light" not in rows)
    assert view.scene.light_names() == []
    client.until_exact(red.number)


def test_a_light_that_was_added_is_undone(view, connect):
    client = connect()
    client.until_exact()
    use(client, "Lights", "Add a light")
    tool_is(client, "Lights", lambda rows: "light" in rows)
    client.collect(0.5)
    client.send("act", what="undo")
    tool_is(client, "Lights", lambda rows: "light" not in rows)


def test_the_studio_s_lights_are_the_settings(view, connect):
    client = connect()
    use(client, "Lights", "Key", "true")
    tool_is(client, "Lights", lambda rows: "intensity" in rows)
    use(client, "Lights", "intensity", "0.25")
    client.until_setting("lights.key.intensity", "0.25")


def test_the_look_of_an_object_is_changed(view, connect, tmp_path):
    client = connect()
    client.until_exact()
    assert "Click an object" in tool_is(client, "Object", bool).popitem()[0]
    client.send("select", object="ball")
    rows = tool_is(client, "Object", lambda rows: "roughness" in rows)
    assert (rows["roughness"]["field"]["min"], rows["roughness"]["field"]["max"]) == (0, 1)
    use(client, "Object", "base color", "#0000ff")
    use(client, "Object", "roughness", "0.125")
    tool_is(client, "Object", lambda rows: rows["roughness"]["value"] == "0.125" and rows["base color"]["value"] == "#0000ff")
    # It stays as it was chosen when it is read back.
    use(client, "Object", "metallic", "0.5")
    tool_is(client, "Object", lambda rows: rows["metallic"]["value"] == "0.5" and rows["base color"]["value"] == "#0000ff")
    material = view.scene.get("ball").material
    assert material.base_color == pytest.approx([0, 0, 1])
    assert material.roughness == 0.125
    # It may have come before what the panel says.
    wanted = view.render((160, 120))

    def shows_it(message):
        return isinstance(message, Frame) and message.is_exact and np.array_equal(message.image(tmp_path), wanted)

    assert any(map(shows_it, client.frames)) or client.until(shows_it)
    use(client, "Object", "Style", "true")
    tool_is(client, "Object", lambda rows: "visible" in rows)
    use(client, "Object", "visible", "false")
    tool_is(client, "Object", lambda rows: rows["visible"]["value"] == "false")
    assert view.scene.get("ball").style.visible is False


def pose(client):
    return np.array(camera_of(client.texts["camera"]["text"])["camera.pose"])


def with_path(client):
    """A path of two keys; returns their poses."""
    client.until_exact()
    client.until_known("camera", lambda message: message["text"])
    poses = [pose(client)]
    use(client, "Camera path", "Add key")
    tool_is(client, "Camera path", lambda rows: any(name.startswith("Key 1") for name in rows))
    client.send("turn", id=1, right=40, up=0)
    client.until_told("camera", lambda message: not np.allclose(pose(client), poses[0]))
    poses.append(pose(client))
    use(client, "Camera path", "Add key")
    tool_is(client, "Camera path", lambda rows: "Key 2, at 1.00 s" in rows and "Play" in rows)
    return poses


def test_faint_splats_are_removed_and_given_back(view, connect):
    means = [[float(x), 3, 0] for x in range(5)]
    view.scene.show(easypbr.splats(means, 0.3, opacities=[0.9, 0.2, 0.8, 0.3, 0.7], colors=np.ones((5, 3))), "splats")
    client = connect()
    before = client.until_exact()
    client.send("select", object="splats")
    tool_is(client, "Object", lambda rows: "Remove" in rows)
    use(client, "Object", "Remove", "true")
    assert "Click a splat or a point." in tool_is(client, "Object", lambda rows: "least opacity" in rows)
    use(client, "Object", "least opacity", "0.5")
    use(client, "Object", "Remove the fainter")
    client.until_exact(before.number)
    assert view.scene.get("splats").V[:, 0].tolist() == [0, 2, 4]
    use(client, "Object", "least opacity", "1")
    use(client, "Object", "Remove the fainter")
    client.until_told("notice", lambda notice: notice["error"] and "would stay" in notice["text"])
    client.send("act", what="undo")
    deadline = time.monotonic() + 10
    while len(view.scene.get("splats").V) != 5 and time.monotonic() < deadline:
        client.collect(0.05)
    assert view.scene.get("splats").V[:, 0].tolist() == [0, 1, 2, 3, 4]


def test_a_path_is_scrubbed_and_played(view, connect):
    client = connect()
    first, second = with_path(client)
    use(client, "Camera path", "time", "0")
    client.until_told("camera", lambda message: np.allclose(pose(client), first, atol=1e-4))
    use(client, "Camera path", "time", "1")
    client.until_told("camera", lambda message: np.allclose(pose(client), second, atol=1e-4))
    use(client, "Camera path", "Play")
    client.until_told("camera", lambda message: not np.allclose(pose(client), second, atol=1e-2))
    # It ends at its end, by itself.
    client.until_told("camera", lambda message: np.allclose(pose(client), second, atol=1e-4))
    tool_is(client, "Camera path", lambda rows: "Play" in rows)
    use(client, "Camera path", "Key 1, at 0.00 s")
    tool_is(client, "Camera path", lambda rows: "seconds to the next key" in rows)
    use(client, "Camera path", "seconds to the next key", "2.5")
    tool_is(client, "Camera path", lambda rows: "Key 2, at 2.50 s" in rows)
    use(client, "Camera path", "Remove")
    tool_is(client, "Camera path", lambda rows: not any(name.startswith("Key 2") for name in rows))


def recorded(client):
    """The video that comes."""
    return client.until(lambda message: not isinstance(message, dict) and message.kind == FILE)


def frames_of(path):
    """Width, height and number of a video's frames."""
    shown = subprocess.run([shutil.which("ffprobe"), "-v", "error", "-count_frames", "-select_streams", "v:0", "-of", "json",
                            "-show_entries", "stream=width,height,nb_read_frames", str(path)], check=True, capture_output=True)
    stream = json.loads(shown.stdout)["streams"][0]
    return stream["width"], stream["height"], int(stream["nb_read_frames"])


def set_form(client, **values):
    for name, value in values.items():
        use(client, "Recording", name.replace("_", " "), str(value))
        tool_is(client, "Recording", lambda rows: str(rows[name.replace("_", " ")]["value"]) == str(value))


def test_a_path_is_recorded_and_downloaded(view, connect, tmp_path):
    client = connect()
    use(client, "Camera path", "Turntable")
    tool_is(client, "Camera path", lambda rows: "Play" in rows)
    set_form(client, width=64, height=48, frames_per_second=3)
    use(client, "Recording", "Record the camera path")
    video = recorded(client)
    assert video.codec == MP4 and video.bytes == len(video.data)
    (tmp_path / "video.mp4").write_bytes(video.data)
    # Around in 8 seconds, closed: the last frame is not the first again.
    assert frames_of(tmp_path / "video.mp4") == (64, 48, 24)
    rows = tool_is(client, "Recording", lambda rows: "Download again" in rows)
    assert "Wrote recording.mp4: 24 frames" in rows
    use(client, "Recording", "Download again")
    assert recorded(client).data == video.data
    # No name of a file of the server's.
    assert tempfile.gettempdir() not in json.dumps([client.texts, client.tools, client.notices])


def test_what_happens_is_recorded(view, connect, tmp_path):
    client = connect()
    client.until_exact()
    set_form(client, width=64, height=48, frames_per_second=10)
    use(client, "Recording", "Record what happens")
    tool_is(client, "Recording", lambda rows: "Stop" in rows)
    client.drag((80, 60), (120, 60))
    client.collect(1)
    use(client, "Recording", "Stop")
    (tmp_path / "video.mp4").write_bytes(recorded(client).data)
    width, height, count = frames_of(tmp_path / "video.mp4")
    # Ten a second for more than the second; slower machines wait for longer, not for less.
    assert (width, height) == (64, 48) and count >= 10


def test_a_folder_is_left_behind_by_nobody(view, tmp_path, monkeypatch):
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    with view.serve() as server:
        client = Client(server.url)
        client.until_exact()
        set_form(client, width=64, height=48)
        use(client, "Recording", "Record what happens")
        tool_is(client, "Recording", lambda rows: "Stop" in rows)
        (folder,) = tmp_path.iterdir()
        assert folder.stat().st_mode & 0o777 == 0o700
        client.close()
    assert list(tmp_path.iterdir()) == []


def test_a_panel_that_is_not_there_is_told(connect):
    client = connect()
    use(client, "No such panel", "x")
    client.until_told("notice", lambda notice: "no panel 'No such panel'" in notice["text"])


def test_who_watches_changes_nothing(view, server, connect):
    watcher = connect(url=server.watch_url)
    watcher.until_known("tool", lambda message: True)
    use(watcher, "Lights", "Add a light")
    watcher.until_told("notice", lambda notice: notice["error"])
    assert view.scene.light_names() == []


@pytest.mark.parametrize("members", [{"value": 3}, {"use": -1}, {"panel": "x" * 8200}, {"more": 1}])
def test_wrong_messages_end_the_connection(connect, members):
    client = connect()
    client.until_told("welcome")
    client.send("tool", **({"panel": "Lights", "name": "b", "use": 0, "value": ""} | members))
    assert client.until_closed()[0] == 1008

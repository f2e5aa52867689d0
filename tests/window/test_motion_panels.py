"""Camera path, recorder and images in the real window, used with mouse and keys."""
import subprocess

import numpy as np
import pytest

import easypbr
from display import wait_until


def click(window, name):
    x0, y0, x1, y1 = window.state["places"][name]
    window.mouse("mousemove", round((x0 + x1) / 2), round((y0 + y1) / 2))
    window.mouse("mousedown", 1)
    window.mouse("mouseup", 1)
    window.update(4)


@pytest.fixture
def with_path(window):
    """A window with a camera path of two keys, placed with the K key, and its panel unfolded."""
    view = window.view
    for position in ((0, 1, 5), (4, 1, 3)):
        view.camera = easypbr.Camera.look_at(position, (0, 0, 0))
        window.key("k")
    for name in ("Scene", "Object"):
        view._handle.set_gui(name, False)
    window.update(4)
    return window


def test_key_poses_are_placed_played_and_scrubbed(with_path):
    window = with_path
    assert window.state["path_keys"] == 2
    click(window, "Camera path")
    click(window, "Camera path/Play")
    wait_until(lambda: window.update() and not window.state["path_plays"])
    assert np.allclose(window.view.camera.position, (4, 1, 3), atol=1e-9)
    click(window, "Camera path/key 1")
    assert np.allclose(window.view.camera.position, (0, 1, 5), atol=1e-9)
    window.view.camera = easypbr.Camera.look_at((2, 8, 14), (0, 0, 0))
    window.settle()
    orange = np.all(np.abs(window.shown().astype(int) - (255, 140, 40)) < 60, axis=2)
    assert orange.sum() > 10
    click(window, "Camera path/remove 2")
    assert window.state["path_keys"] == 1


def test_a_camera_path_is_recorded(with_path, tmp_path):
    window = with_path
    window.view.settings.image.size = (64, 48)
    window.view._handle.set_gui("video_file", str(tmp_path / "film.mp4"))
    click(window, "Recorder")
    click(window, "Recorder/Camera path")
    assert window.state["records"]
    wait_until(lambda: window.update() and not window.state["records"], 60)
    assert "31 frames" in window.state["recorder_says"]
    found = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries",
                            "stream=nb_read_frames,width,height,r_frame_rate", "-of", "csv=p=0", tmp_path / "film.mp4"],
                           capture_output=True, text=True, check=True)
    assert found.stdout.split() == ["64,48,30/1,31"]


def test_closing_finishes_what_is_recorded(window, tmp_path):
    for name in ("Scene", "Object"):
        window.view._handle.set_gui(name, False)
    window.view.settings.image.size = (64, 48)
    window.view._handle.set_gui("video_file", str(tmp_path / "film.mp4"))
    window.update(4)
    click(window, "Recorder")
    click(window, "Recorder/Video")
    window.update(10)
    window.display.run("wmctrl", "-c", window.title)
    wait_until(lambda: not window.view.update())
    found = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames", "-of",
                            "csv=p=0", tmp_path / "film.mp4"], capture_output=True, text=True, check=True)
    assert int(found.stdout) >= 3


def test_errors_of_a_recording_are_shown(window, tmp_path):
    for name in ("Scene", "Object"):
        window.view._handle.set_gui(name, False)
    window.view._handle.set_gui("picture_file", "/nowhere/at/all.png")
    window.update(4)
    click(window, "Recorder")
    click(window, "Recorder/Picture")
    assert "/nowhere/at/all.png" in window.state["recorder_says"] and window.view.is_open


def test_an_image_follows_a_loop_and_shows_values(window):
    before = None
    for step in range(5):
        window.view.show_image("loss", np.full((4, 4, 3), 50 * step, np.uint8))
        window.update(3)
        shown = window.shown()
        assert before is None or np.any(shown != before)
        before = shown
    x0, y0, x1, y1 = window.state["places"]["loss"]
    window.mouse("mousemove", round((x0 + x1) / 2 + 4), round((y0 + y1) / 2 + 4))
    window.update(3)
    assert window.state["image_value"] == "loss: (2, 2)  200  200  200"

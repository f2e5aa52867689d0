"""What goes wrong around a window: interrupts, displays that go away, closing in the middle, files and text from outside."""
import os
import pathlib
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import easypbr
from binary import BINARY
from display import Display, wait_until

HERE = pathlib.Path(__file__).parent

#: A program with a window that records what it shows, told line by line.
RECORDING = """
import sys, easypbr
scene = easypbr.Scene()
ball = easypbr.shapes.sphere(1, 16)
scene.show(ball, "ball")
view = easypbr.Viewer((160, 120), {"image": {"samples": 1}}, scene=scene)
view.recorder.start(sys.argv[1], fps=25)
frames = 0
try:
    while view.update():
        frames += 1
        print(frames, flush=True)
        ball.rotate_axis_angle((0, 1, 0), 5)
except BaseException as error:
    print("ended by", type(error).__name__ + ":", error, flush=True)
else:
    print("closed", flush=True)
"""


class Program:
    """A program of its own process; its lines are read as they come."""

    def __init__(self, display, code, *arguments):
        # Whoever starts the tests in the background switches interrupts off, for their children too.
        self.process = subprocess.Popen([sys.executable, "-c", code, *map(str, arguments)], env=display.environment,
                                        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def until_frame(self, number):
        for line in self.process.stdout:
            if line.strip() == str(number):
                return
        raise AssertionError(self.process.stderr.read())

    def rest(self, told=None):
        """What it prints until its end, which must be an orderly one. `told`: what it reads."""
        out, error = self.process.communicate(told, timeout=60)
        assert self.process.returncode == 0, f"{self.process.returncode}: {error}"
        return out, error


def frames_of(path):
    """How many frames a player finds; each is decoded."""
    command = ["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames", "-of", "csv=p=0", path]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and not done.stderr, done.stderr
    return int(done.stdout)


def told_frames(out, before):
    numbers = [int(line) for line in out.splitlines() if line.isdigit()]
    return max(numbers, default=before)


def test_ctrl_c_ends_a_loop_and_the_recording_is_whole(display, tmp_path):
    program = Program(display, RECORDING, tmp_path / "out.mp4")
    program.until_frame(5)
    program.process.send_signal(signal.SIGINT)
    out, _ = program.rest()
    assert "ended by KeyboardInterrupt" in out
    # The interrupt may come within the update whose frame was added already.
    assert 0 <= frames_of(tmp_path / "out.mp4") - told_frames(out, 5) <= 1


def test_ctrl_c_ends_show(display):
    code = "import easypbr\nprint(1, flush=True)\neasypbr.show(easypbr.shapes.box(), size=(160, 120))"
    program = Program(display, code)
    program.until_frame(1)
    wait_until(lambda: any("EasyPBR" in title for title in display.windows()))
    program.process.send_signal(signal.SIGINT)
    _, error = program.process.communicate(timeout=30)
    assert program.process.returncode == -signal.SIGINT and "KeyboardInterrupt" in error


def test_closing_the_window_keeps_the_recording(display, tmp_path):
    program = Program(display, RECORDING, tmp_path / "out.mp4")
    program.until_frame(4)
    wait_until(lambda: any("ball" in title for title in display.windows()))
    display.run("wmctrl", "-c", "ball - EasyPBR")
    out, _ = program.rest()
    assert "closed" in out
    assert 0 <= frames_of(tmp_path / "out.mp4") - told_frames(out, 4) <= 1


AFTERWARDS = """
print("open", view.is_open, "recording", view.recorder.is_recording, flush=True)
print("update", view.update(), flush=True)
print("still", view.render((16, 12)).shape, flush=True)
try:
    easypbr.show(easypbr.shapes.box())
except easypbr.ContextError as error:
    print("again:", error, flush=True)
"""


@pytest.mark.parametrize("how", ["kill", "terminate"])
def test_a_display_that_goes_away_is_an_error_and_loses_nothing(tmp_path, how):
    (tmp_path / "display").mkdir()
    with Display(tmp_path / "display") as display:
        program = Program(display, RECORDING + AFTERWARDS, tmp_path / "out.mp4")
        program.until_frame(5)
        getattr(display._processes[0], how)()
        out, error = program.rest()
    assert "ended by ContextError: the display that the window was on has gone away" in out
    # Drawing goes on without a window, and nobody waits for one.
    assert "open False recording False" in out and "update False" in out and "still (12, 16, 4)" in out
    assert "again: the display" in out
    assert "XIO" not in error
    assert 0 <= frames_of(tmp_path / "out.mp4") - told_frames(out, 5) <= 1


WITHOUT_WINDOW = """
import sys, easypbr
view = easypbr.Viewer((160, 120))
view.update()
view.close()
print(1, flush=True)
sys.stdin.readline()
try:
    easypbr.Viewer((160, 120)).update()
except easypbr.ContextError as error:
    print("ended by", error, flush=True)
"""


def test_a_display_that_went_away_while_no_window_was_open_is_an_error(tmp_path):
    with Display(tmp_path) as display:
        program = Program(display, WITHOUT_WINDOW)
        program.until_frame(1)
        display._processes[0].terminate()
        display._processes[0].wait()
        out, error = program.rest("\n")
    assert "ended by the display that the window was on has gone away" in out
    assert "XIO" not in error


def test_an_exception_in_a_callback_does_not_harm_a_recording(window, tmp_path, capsys):
    window.view.before_draw(lambda: 1 / 0)
    window.view.recorder.start(tmp_path / "out.mp4", fps=25)
    window.update(4)
    assert window.view.recorder.stop() == 4 == frames_of(tmp_path / "out.mp4")
    assert "ZeroDivisionError" in capsys.readouterr().err


def test_an_exception_that_ends_the_loop_flushes_the_recording(window, tmp_path):
    with pytest.raises(RuntimeError, match="diverged"), window.view.recorder.start(tmp_path / "out.mp4", fps=25):
        for step in range(10):
            window.update()
            if step == 2:
                raise RuntimeError("the training diverged")
    assert frames_of(tmp_path / "out.mp4") == 3


def test_a_watched_file_is_shown_again(display, tmp_path):
    def write(path, color, ahead_ns=0):
        box = easypbr.shapes.box()
        box.C = np.tile(color, (len(box.V), 1))
        box.save(path)
        times = (time.time_ns() + ahead_ns,) * 2
        os.utime(path, ns=times)

    path = tmp_path / "thing.ply"
    write(path, (1.0, 0.0, 0.0))
    view = subprocess.Popen([BINARY, "view", path, "--watch", "--size", "800x600"], env=display.environment)
    wait_until(lambda: any("thing" in title for title in display.windows()))
    left, top = display.place("thing")
    middle = lambda: display.screen()[top + 300, left + 400].astype(int)  # noqa: E731
    wait_until(lambda: middle()[0] > 2 * middle()[2])
    # A second later, for file systems that keep no parts of one.
    write(tmp_path / "other.ply", (0.0, 0.0, 1.0), 10**9)
    os.replace(tmp_path / "other.ply", path)
    wait_until(lambda: middle()[2] > 2 * middle()[0])
    display.run("wmctrl", "-c", "thing")
    assert view.wait(30) == 0


def test_an_edited_shader_is_shown_at_once(window, tmp_path):
    path = tmp_path / "own.glsl"
    text = "void surface(inout Surface s) { s.base_color = vec3(1.0, 0.0, 0.0); s.unlit = true; }"

    def write(words):
        path.write_text(words)
        write.time += 10**9
        os.utime(path, ns=(write.time, write.time))

    write.time = time.time_ns()
    write(text)
    window.view._handle.set_gui("show_panels", False)
    window.view.scene.get("ball").material.shader = path
    window.settle()
    middle = lambda: window.shown()[300, 400].astype(int)  # noqa: E731
    assert middle()[0] > 150 > middle()[2]
    write(text.replace("1.0, 0.0, 0.0", "0.0, 0.0, 1.0"))
    window.settle()
    wait_until(lambda: window.update() and middle()[2] > 150 > middle()[0])
    good = middle()
    write(text.replace("vec3", "colour"))
    wait_until(lambda: window.update() and any("own.glsl:1" in m for m in window.state["messages"]))
    window.update(5)
    assert np.array_equal(middle(), good)


def drop(window, position, *files):
    x, y = window.left + position[0], window.top + position[1]
    source = subprocess.Popen([sys.executable, HERE / "drop.py", str(x), str(y), *map(str, files)],
                              env=window.display.environment, stdout=subprocess.PIPE, text=True)
    wait_until(lambda: window.update() and source.poll() is not None)
    assert source.returncode == 0 and source.stdout.read().strip() == "dropped"
    window.settle()


def test_files_dropped_on_the_window_are_added(window, tmp_path):
    # A name with a blank and one beyond ASCII: uri-lists escape them.
    names = ["my box.ply", "schüssel.obj"]
    for name in names:
        easypbr.shapes.box().save(tmp_path / name)
    drop(window, (400, 300), *(tmp_path / name for name in names))
    assert sorted(window.view.scene.names()) == ["ball", "my box", "schüssel"]
    drop(window, (400, 300), tmp_path / "my box.ply")
    assert "my box-2" in window.view.scene.names()
    (tmp_path / "broken.ply").write_text("ply\nthis is none\n")
    drop(window, (400, 300), tmp_path / "broken.ply")
    assert any("broken.ply" in message for message in window.state["messages"])


def test_an_environment_dropped_on_the_window_lights(window, tmp_path):
    easypbr.save_image(np.full((8, 16, 3), 2, np.float32), tmp_path / "sky.hdr")
    drop(window, (400, 300), tmp_path / "sky.hdr")
    assert window.view.settings.environment.file == str(tmp_path / "sky.hdr")


def test_the_camera_goes_by_the_clipboard(window):
    window.key("h")
    before = window.view.camera.position.copy()
    window.key("ctrl+c")
    reader = subprocess.Popen(["xclip", "-selection", "clipboard", "-o"], env=window.display.environment,
                              stdout=subprocess.PIPE, text=True)
    wait_until(lambda: window.update() and reader.poll() is not None)
    text = reader.stdout.read()
    assert "camera." in text
    window.mouse("mousemove", 400, 300, "click", 4)
    assert np.any(window.view.camera.position != before)
    subprocess.run(["xclip", "-selection", "clipboard", "-i"], env=window.display.environment, input=text, text=True,
                   timeout=30, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    window.key("ctrl+v")
    wait_until(lambda: window.update() and np.allclose(window.view.camera.position, before, atol=1e-6))


def test_an_owner_of_the_clipboard_that_does_not_answer_is_told(window):
    before = window.view.camera.position.copy()
    owner = subprocess.Popen(["xclip", "-selection", "clipboard", "-i", "-quiet"], env=window.display.environment, text=True,
                             stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    owner.stdin.write("camera.fov_y_deg=20")
    owner.stdin.close()
    # It holds the clipboard as soon as what it holds can be read.
    wait_until(lambda: window.display.run("xclip", "-selection", "clipboard", "-o", check=False).stdout.startswith("camera.fov"))
    owner.send_signal(signal.SIGSTOP)
    try:
        start = time.monotonic()
        window.key("ctrl+v")
        wait_until(lambda: window.update() and any("did not answer" in text for text in window.state["messages"]))
        assert time.monotonic() - start < 20  # a second, and what a busy machine adds
        assert window.view.settings.camera.fov_y_deg != 20
        # It reads what comes next.
        subprocess.run(["xclip", "-selection", "clipboard", "-i"], env=window.display.environment, input="camera.fov_y_deg=20",
                       text=True, timeout=30, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        window.key("ctrl+v")
        wait_until(lambda: window.update() and window.view.settings.camera.fov_y_deg == 20)
    finally:
        owner.kill()
        owner.wait()
    assert np.allclose(window.view.camera.position, before)


def test_the_windows_own_text_comes_back_from_the_clipboard(window):
    before = window.view.camera.position.copy()
    window.key("ctrl+c")
    window.mouse("mousemove", 400, 300, "click", 4)
    assert np.any(window.view.camera.position != before)
    window.key("ctrl+v")
    wait_until(lambda: window.update() and np.allclose(window.view.camera.position, before, atol=1e-6))


def test_a_quick_click_counts_on_panels(window):
    """Press and release come with one update, as those of a touch pad after a slow frame."""
    left, top, right, bottom = window.state["places"]["Scene/visible ball"]
    for expected in (False, True):
        window.mouse("mousemove", round((left + right) / 2), round((top + bottom) / 2), "click", 1)
        window.settle()
        assert window.view.scene.get("ball").style.visible is expected


@pytest.mark.parametrize("layout", ["de", "fr"])
def test_undo_goes_by_the_letters_of_the_layout(window, layout):
    """German keyboards have Z where others have Y, French ones where others have W."""
    def at(camera):
        return np.allclose(window.view.camera.position, camera, atol=1e-9)

    before = window.view.camera.position.copy()
    window.mouse("mousemove", 400, 300, "mousedown", 1)
    window.mouse("mousemove", 460, 310)
    window.mouse("mouseup", 1)
    window.settle()
    after = window.view.camera.position.copy()
    assert not at(before)
    try:
        window.display.run("setxkbmap", layout)
        window.settle()
        for redo in ("ctrl+y", "ctrl+shift+z"):
            window.key("ctrl+z")
            wait_until(lambda: window.update() and at(before))
            window.key(redo)
            wait_until(lambda: window.update() and at(after))
    finally:
        window.display.run("setxkbmap", "us")


def test_text_that_is_no_camera_is_told(window):
    subprocess.run(["xclip", "-selection", "clipboard", "-i"], env=window.display.environment, input="a recipe", text=True,
                   timeout=30, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    before = window.view.camera.position.copy()
    told = len(window.state["messages"])
    window.key("ctrl+v")
    wait_until(lambda: window.update() and len(window.state["messages"]) > told)
    assert np.array_equal(window.view.camera.position, before)


def test_two_viewers_at_once(display):
    """Each shows its own scene and hears its own keys."""
    views = []
    for name in ("left", "right"):
        scene = easypbr.Scene()
        scene.show(easypbr.shapes.box(), name)
        views.append(easypbr.Viewer((320, 240), {"image": {"samples": 1}}, scene=scene))
    for _ in range(30):
        assert all([view.update() for view in views])
    wait_until(lambda: all(view.update() for view in views)
               and {"left - EasyPBR", "right - EasyPBR"} <= set(display.windows()))
    display.run("wmctrl", "-c", "left - EasyPBR")
    wait_until(lambda: not views[0].update() and views[1].update())
    for _ in range(5):
        assert views[1].update()
    views[1].close()

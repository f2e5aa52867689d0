"""The real window: mouse, keys, panels, closing, several at once."""
import os
import pathlib
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import easypbr
from display import Display, wait_until

MIDDLE = (400, 300)


def distance(camera):
    return np.linalg.norm(camera.position)


def test_the_screen_shows_what_the_viewer_draws(window):
    window.view._handle.set_gui("show_panels", False)
    window.settle()
    shown = window.shown()
    drawn = window.view.screenshot((800, 600))[:, :, :3]
    # Where the pointer is the window system draws over it.
    assert np.mean(np.any(shown != drawn, axis=2)) < 0.005
    assert np.mean(np.abs(shown.astype(int) - window.view.render((800, 600))[:, :, :3])) < 0.5


def test_a_left_drag_orbits_and_a_right_drag_pans(window):
    window.view.settings["ground.mode"] = "none"
    window.key("h")
    before = window.view.camera.position.copy()
    window.mouse("mousemove", *MIDDLE, "mousedown", 1)
    window.mouse("mousemove", 460, 310)
    window.mouse("mousemove", 520, 320)
    window.mouse("mouseup", 1)
    turned = window.view.camera.position.copy()
    assert np.linalg.norm(turned - before) > 0.3
    target = np.array(window.view.settings.resolve("camera.target"))
    assert abs(np.linalg.norm(turned - target) - np.linalg.norm(before - target)) < 1e-6
    pixel = window.view.pick(*MIDDLE, (800, 600)).position
    window.mouse("mousemove", *MIDDLE, "mousedown", 3)
    window.mouse("mousemove", 430, 300)
    window.mouse("mousemove", 450, 300)
    window.mouse("mouseup", 3)
    moved = window.view.pick(450, 300, (800, 600)).position
    assert np.linalg.norm(moved - pixel) < 0.05
    window.settle()
    columns = np.flatnonzero(np.any(np.abs(window.shown().astype(int) - 217).max(axis=2) > 8, axis=0))
    assert abs((columns[0] + columns[-1]) / 2 - 450) < 6


def turned_by_a_drag(window, update):
    """From where the camera is; `update` is called after each of the drag's steps."""
    before = window.view.camera
    steps = [("mousemove", *MIDDLE), ("mousedown", 1), ("mousemove", 440, 310), ("mousemove", 520, 320), ("mouseup", 1)]
    for step in steps:
        window.send(*step)
        update()
    window.update(3)
    after = window.view.camera.position.copy()
    window.view.camera = before
    return after


def test_a_drag_counts_though_it_is_over_before_its_events_are_taken(window):
    window.key("h")
    before = window.view.camera.position.copy()
    slow = turned_by_a_drag(window, window.update)
    assert np.linalg.norm(slow - before) > 0.5
    # As while the program is busy, or a frame is drawn: the pointer is elsewhere when the press is taken.
    # The same two movements either way: only rounding differs.
    assert np.linalg.norm(turned_by_a_drag(window, lambda: None) - slow) < 1e-9


def test_a_button_interrupts_a_frame_that_refines(window):
    """Who presses a button while a sample of some seconds is drawn waits for a part of it only."""
    window.mouse("mousemove", *MIDDLE)
    window.view.settings.update({"image.samples": 1000, "path.enabled": True, "path.bounces": 64})
    for shell in range(40):
        ball = easypbr.shapes.sphere(1 + 0.02 * shell, 64)
        ball.material = easypbr.Material(transmission=1.0, roughness=0.3)
        window.view.scene.show(ball, f"shell {shell}")
    window.update(2)
    took = []
    for presses in (False, True):
        worker = threading.Timer(0.2 * took[0] if took else 0, window.display.run, ("xdotool", "mousedown", "1"))
        if presses:
            worker.start()
        start = time.monotonic()
        window.update()
        took.append(time.monotonic() - start)
        if presses:
            worker.join()
    window.display.run("xdotool", "mouseup", "1")
    assert took[0] > 0.4, "the frame is too quick for this test"
    assert took[1] < 0.7 * took[0]


def test_the_wheel_zooms_and_a_click_picks(window):
    window.key("h")
    before = distance(window.view.camera)
    window.mouse("mousemove", *MIDDLE, "click", 4, "click", 4)
    assert distance(window.view.camera) < 0.9 * before
    window.mouse("mousemove", *MIDDLE, "click", 1)
    assert window.state["object"] == "ball"
    window.mouse("mousemove", 5, 5, "click", 1)
    assert window.state["object"] == ""
    window.key("f")
    assert abs(distance(window.view.camera) - before) < 0.05 * before


def test_shift_flies_four_times_as_fast(window):
    window.key("h")
    window.mouse("mousemove", *MIDDLE)

    def metres_per_second(*keys):
        window.view.camera = easypbr.Camera.look_at((0, 0, 5), (0, 0, 0))
        window.settle()
        for key in keys:
            window.display.run("xdotool", "keydown", key)
            window.update(2)
        before, start, step = window.view.camera.position.copy(), time.monotonic(), 0
        while time.monotonic() < start + 0.7:
            # Moves of the pointer come meanwhile.
            window.display.run("xdotool", "mousemove_relative", "--", str(1 - 2 * (step % 2)), "0")
            window.update()
            step += 1
        speed = np.linalg.norm(window.view.camera.position - before) / (time.monotonic() - start)
        for key in keys:
            window.display.run("xdotool", "keyup", key)
        window.update(5)
        return speed

    slow = metres_per_second("a")
    for keys in (("shift", "a"), ("a", "shift")):
        assert 3 < metres_per_second(*keys) / slow < 5, keys


def test_keys_toggle_each_panel(window):
    names = ["Scene", "Object", "Effects", "Lights", "Environment", "Camera", "Channels", "Statistics", "Animations",
             "Camera path", "Recorder"]
    assert window.state["panels"] == names
    pictures = [window.shown()]
    for number, name in enumerate(names, 1):
        window.key(f"F{number}")
        assert name not in window.state["panels"]
        pictures.append(window.shown())
        assert np.any(pictures[-1] != pictures[-2]), name
    window.key("question")
    assert window.state["show_keys"]
    window.key("Escape")
    assert not window.state["show_keys"] and window.view.is_open


def test_a_key_that_is_held_acts_once(window):
    repeats = []
    window.view.on_event(lambda event: repeats.append(event.repeat), kind="key_down")
    window.mouse("mousemove", *MIDDLE)
    window.send("keydown", "k")
    wait_until(lambda: window.update() and len(repeats) > 3)
    window.send("keyup", "k")
    window.update(4)
    assert not repeats[0] and all(repeats[1:])
    assert window.state["path_keys"] == 1


def test_typing_into_a_panel_is_not_for_the_camera(window):
    before = window.view.camera.position.copy()
    window.mouse("mousemove", 60, 120, "mousedown", 1)
    window.mouse("mousemove", 90, 130)
    window.mouse("mouseup", 1)
    assert np.array_equal(window.view.camera.position, before)


def test_undo_takes_back_what_the_user_did_and_leaves_what_the_program_has_set(window):
    view, ball = window.view, window.view.scene.get("ball")
    view.scene.show(easypbr.shapes.box((1, 1, 1)), "box")
    window.settle()
    x0, y0, x1, y1 = window.state["places"]["Scene/visible ball"]
    window.mouse("mousemove", int(x0 + x1) // 2, int(y0 + y1) // 2, "mousedown", 1, "mouseup", 1)
    window.update(5)
    assert ball.style.visible is False
    steps = iter(range(10**6))

    @view.before_draw
    def program():
        view.settings["tonemap.exposure_compensation"] = 0.001 * next(steps)

    window.update(10)
    view.camera = easypbr.Camera.look_at((0, 0, 7), (0, 0, 0))
    window.update(5)
    ball.style.colormap = "turbo"
    window.key("ctrl+z")
    assert ball.style.visible is not False
    assert view.settings["tonemap.exposure_compensation"] > 0.01
    assert np.allclose(view.camera.position, (0, 0, 7))
    window.key("ctrl+y")
    assert ball.style.visible is False
    assert ball.style.colormap == "turbo"


def test_nothing_is_hovered_when_the_pointer_has_left(window):
    left = []
    window.view.on_event(left.append, kind="leave")

    def go_outside():
        before = len(left)
        window.send("mousemove", 850, 300)
        wait_until(lambda: window.update() and len(left) > before)
        window.settle()
        return window.shown()

    window.mouse("mousemove", *MIDDLE)
    beside = go_outside()
    window.mouse("mousemove", *MIDDLE)
    window.settle()
    assert np.any(window.shown()[500:] != beside[500:])  # the status line
    assert np.array_equal(go_outside(), beside)
    # A drag goes on outside.
    before = len(left)
    window.mouse("mousemove", *MIDDLE, "mousedown", 3)
    window.mouse("mousemove", 850, 300)
    assert len(left) == before
    window.send("mouseup", 3)
    wait_until(lambda: window.update() and len(left) > before)


def test_the_picture_follows_a_resized_window(window):
    window.display.run("wmctrl", "-r", window.title, "-e", "0,-1,-1,1000,500")
    wait_until(lambda: window.update() and window.state["size"] == [1000, 500])
    window.settle()
    assert window.state["drawn_size"] == [1000, 500]


@pytest.mark.parametrize("how", ["button", "key"])
def test_closing_ends_the_loop(window, how):
    if how == "button":
        window.display.run("wmctrl", "-c", window.title)
        wait_until(lambda: not window.update())
    else:
        window.display.run("xdotool", "key", "Escape")
        wait_until(lambda: not window.update())
    assert not window.view.is_open and not window.view.update()
    wait_until(lambda: window.title not in window.display.windows())


def test_an_idle_window_costs_next_to_nothing(window):
    window.mouse("mousemove", 790, 590)
    window.settle()
    start, cpu = time.monotonic(), time.process_time()
    while time.monotonic() < start + 2:
        window.update()
    assert (time.process_time() - cpu) / 2 < 0.05


def test_shows_what_another_thread_shows_meanwhile(window):
    scene = window.view.scene
    thread = threading.Thread(target=lambda: [scene.show(easypbr.shapes.box(s / 20), "box") for s in range(1, 21)])
    thread.start()
    while thread.is_alive():
        assert window.update()
    window.settle()
    window.view.camera = easypbr.Camera.look_at((0, 0, 9), (0, 0, 0))
    window.settle()
    assert window.view.pick(*MIDDLE, (800, 600)).object == "ball"
    assert sorted(window.view.object_names()) == ["ball", "box"]


def test_an_exception_in_a_callback_is_shown_and_the_loop_goes_on(window, capsys):
    calls = []

    @window.view.before_draw
    def broken():
        calls.append(1)
        raise RuntimeError("the weights are NaN")

    assert window.update(3)
    assert len(calls) == 3
    told = capsys.readouterr().err
    assert told.count("Traceback") == 1 and "the weights are NaN" in told and "in broken" in told
    message = window.state["messages"][-1]
    assert message.startswith("Traceback") and message.endswith("RuntimeError: the weights are NaN")


def test_a_window_that_lives_beside_the_program(display):
    view = easypbr.show(easypbr.shapes.box(), block=False, size=(320, 240))
    wait_until(lambda: view._handle.gui_state()["frames"] == view.settings.image.samples)
    before = view.camera.position
    view.settings.camera.azimuth_deg = 80
    view.refit()
    wait_until(lambda: np.any(view.camera.position != before))
    assert view.is_open
    view.close()
    assert not view.is_open


def test_viewers_made_and_dropped_on_several_threads(display):
    errors = []

    def work(number):
        try:
            for _ in range(3):
                scene = easypbr.Scene()
                scene.show(easypbr.shapes.box(), f"box{number}")
                view = easypbr.Viewer((160, 120), {"image": {"samples": 1}}, scene=scene)
                for _ in range(5):
                    assert view.update()
        except Exception as error:
            errors.append(error)

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    [thread.start() for thread in threads]
    [thread.join(120) for thread in threads]
    assert not errors and not any(thread.is_alive() for thread in threads)


def test_without_a_display_it_says_so():
    environment = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    code = "import easypbr; easypbr.show(easypbr.shapes.box())"
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, timeout=120)
    assert done.returncode == 1
    assert "ContextError: no window: X11: " in done.stderr and "render()" in done.stderr


def test_a_window_that_its_manager_forgets_is_asked_for_again(tmp_path):
    program = """
import easypbr
view = easypbr.Viewer((320, 240))
for _ in range(200):
    view.update()
"""
    here = pathlib.Path(__file__).parent
    with Display(tmp_path, manager=False) as display:
        manager = subprocess.Popen([sys.executable, here / "forgetful_manager.py"], env=display.environment, text=True,
                                   stdout=subprocess.PIPE)
        try:
            assert manager.stdout.readline() == "ready\n"
            done = subprocess.run([sys.executable, "-c", program], env=display.environment, timeout=60)
            assert done.returncode == 0
            assert [manager.stdout.readline() for _ in range(2)] == ["map 1\n", "map 2\n"]
        finally:
            manager.terminate()
            manager.wait(10)

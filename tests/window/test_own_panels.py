"""Panels and callbacks in the real window."""
import numpy as np

import easypbr
from display import wait_until


def middle(window, name):
    x0, y0, x1, y1 = window.state["places"][name]
    return round((x0 + x1) / 2), round((y0 + y1) / 2)


def click(window, name):
    window.mouse("mousemove", *middle(window, name))
    window.mouse("mousedown", 1)
    window.mouse("mouseup", 1)
    window.update(4)


def test_a_panel_of_ones_own_is_used_with_the_mouse(window):
    state = {"clicks": 0}

    @window.view.add_panel("Training")
    def draw(ui):
        state["rate"] = ui.slider("learning rate", 0.1, 0, 1)
        state["on"] = ui.checkbox("augment", False)
        state["clicks"] += ui.button("Reset")
        ui.plot("loss", np.exp(-np.arange(100) / 20))

    window.settle()
    click(window, "Training/augment")
    click(window, "Training/Reset")
    click(window, "Training/learning rate")
    assert state["on"] is True and state["clicks"] == 1 and abs(state["rate"] - 0.5) < 0.02
    window.update(3)
    assert abs(state["rate"] - 0.5) < 0.02  # kept by the widget


def test_a_panel_shows_what_changes_in_a_loop_though_nothing_else_happens(window):
    losses = [1.0]
    window.view.add_panel("Loss", lambda ui: ui.plot("loss", losses))
    window.settle()
    before = window.shown()
    losses += [0.5, 0.25, 0.1]
    wait_until(lambda: window.update() and np.any(window.shown() != before))
    assert window.state["own_panels"] == {"Loss": ""}


def test_events_reach_functions_and_may_be_kept_from_the_viewer(window):
    seen = []

    @window.view.on_event(kind="key_down")
    def keys(event):
        seen.append((event.key, event.control))
        return event.key == "H"

    presses = []
    window.view.on_event(lambda event: presses.append((event.button, event.position)), kind="press")
    window.key("h", "k", "ctrl+F2")
    assert ("H", False) in seen and ("K", False) in seen and ("F2", True) in seen
    assert window.state["show_panels"]
    window.mouse("mousemove", 400, 300, "click", 3)
    assert presses == [("right", (400.0, 300.0))]
    sizes = []
    window.view.on_event(lambda event: sizes.append(event.size), kind="resize")
    window.display.run("wmctrl", "-r", window.title, "-e", "0,-1,-1,900,500")
    wait_until(lambda: window.update() and (900, 500) in sizes)
    window.view.remove_callback(keys)
    window.key("h")
    assert not window.state["show_panels"]


def test_a_flight_ends_when_its_key_comes_up_in_a_field(window):
    window.view.add_panel("Training", lambda ui: ui.text_field("name", ""))
    window.settle()
    before = window.view.camera.position.copy()
    window.mouse("keydown", "w")
    assert np.any(window.view.camera.position != before)
    click(window, "Training/name")
    window.mouse("keyup", "w")
    after = window.view.camera.position.copy()
    window.update(10)
    assert np.array_equal(window.view.camera.position, after)


def test_the_keypads_enter_takes_a_number(window):
    values = []
    window.view.add_panel("Training", lambda ui: values.append(ui.number("rate", 1.0)))
    window.settle()
    window.mouse("mousemove", *middle(window, "Training/rate"), "keydown", "ctrl", "click", 1, "keyup", "ctrl")
    # What comes after it is no longer the field's.
    window.key("7", "KP_Enter", "h")
    assert values[-1] == 7 and not window.state["show_panels"]


def test_a_callback_may_close_the_window(window):
    window.view.on_event(lambda event: window.view.close(), kind="key_down")
    window.display.run("xdotool", "key", "k")
    wait_until(lambda: not window.view.update())
    assert not window.view.is_open


def test_a_window_beside_the_program_calls_its_panels(display):
    calls = []
    scene = easypbr.Scene()
    scene.show(easypbr.shapes.box(), "box")
    view = easypbr.Viewer((480, 320), {"image": {"samples": 1}}, scene=scene)
    view.add_panel("Beside", lambda ui: calls.append(view.settings.ssao.radius))
    view.show(block=False)
    wait_until(lambda: len(calls) > 3)
    view.close()
    assert not view.is_open


def test_a_splat_that_was_clicked_is_removed_and_given_back(display):
    from conftest import Window

    scene = easypbr.Scene()
    means = np.array([[x, 0.0, 0.0] for x in range(-2, 3)])
    scene.show(easypbr.splats(means, 0.25, colors=np.full((5, 3), 0.6)), "row")
    camera = {"position": (0, 0, 8), "target": (0, 0, 0), "fov_y_deg": 40}
    view = easypbr.Viewer((800, 600), {"image": {"samples": 1}, "camera": camera}, scene=scene)
    try:
        window = Window(display, view)
        view.show_panels("Object")
        window.settle()
        window.mouse("mousemove", 400, 300, "mousedown", 1, "mouseup", 1)
        window.settle()
        assert window.state["object"] == "row"
        click(window, "object/Remove")
        window.settle()
        click(window, "object/Remove it")
        window.settle()
        assert scene.get("row").V[:, 0].tolist() == [-2, -1, 1, 2]
        window.key("ctrl+z")
        window.settle()
        assert scene.get("row").V[:, 0].tolist() == [-2, -1, 0, 1, 2]
    finally:
        view.close()

"""Panels and callbacks written in Python, without a display."""
import gc
import threading
import weakref

import numpy as np
import pytest

import easypbr
from easypbr import Scene, Viewer, shapes

SIZE = (640, 400)


@pytest.fixture
def view():
    scene = Scene()
    scene.show(shapes.box(), "box")
    return Viewer(SIZE, {"image": {"samples": 1}}, scene)


def panel_errors(view):
    return view._handle.gui_state()["own_panels"]


def test_every_widget_returns_its_value(view):
    values = {}

    @view.add_panel("All")
    def draw(ui):
        ui.text("hello")
        ui.separator()
        values["button"] = ui.button("press")
        ui.same_line()
        ui.text(3)
        values["checkbox"] = ui.checkbox("on", True)
        values["slider"] = ui.slider("rate", 0.25, 0, 1)
        values["whole"] = ui.slider("count", 3, 0, 10)
        values["number"] = ui.number("any", 12.5)
        values["combo"] = ui.combo("kind", "b", ["a", "b"])
        values["text"] = ui.text_field("name", "run")
        values["color"] = ui.color("colour", (1, 0.5, 0))
        if ui.section("More"):
            ui.plot("loss", np.exp(-np.arange(50) / 10))
            ui.plot("fixed", [1, float("nan"), 3], range=(0, 4))
        ui.progress(0.5, "half")

    before = view.screenshot(SIZE)
    assert values == {"button": False, "checkbox": True, "slider": 0.25, "whole": 3, "number": 12.5, "combo": "b",
                      "text": "run", "color": (1.0, 0.5, 0.0)}
    assert isinstance(values["whole"], int) and panel_errors(view) == {"All": ""}
    view.remove_panel("All")
    assert np.any(view.screenshot(SIZE) != before) and panel_errors(view) == {}


def test_a_widget_follows_a_value_that_is_given_anew(view):
    shown, given = [], [0.2]
    view.add_panel("Follows", lambda ui: shown.append(ui.slider("rate", given[0], 0, 1)))
    view.screenshot(SIZE)
    given[0] = 0.7
    view.screenshot(SIZE)
    assert shown[0] == 0.2 and shown[-1] == 0.7


def test_an_exception_is_shown_with_its_traceback_and_told_once(view, capsys):
    def broken(ui):
        ui.text("before")
        raise ValueError("the weights are NaN")

    view.add_panel("Broken", broken)
    view.screenshot(SIZE)
    view.screenshot(SIZE)
    error = panel_errors(view)["Broken"]
    assert error.startswith("Traceback") and "in broken" in error and error.endswith("ValueError: the weights are NaN")
    assert capsys.readouterr().err.count("Traceback") == 1
    view.add_panel("Broken", lambda ui: ui.text("mended"))
    view.screenshot(SIZE)
    assert panel_errors(view) == {"Broken": ""}


@pytest.mark.parametrize("draw, message", [
    (lambda ui: ui.slider("x", 0.5, 1, 0), "slider 'x': expected a range"),
    (lambda ui: ui.combo("x", "a", []), "combo 'x': expected at least one choice"),
    (lambda ui: ui.number("x", float("inf")), "number 'x': expected a finite number"),
    (lambda ui: ui.slider("x", "fast", 0, 1), "could not convert string to float"),
    (lambda ui: ui.plot("x", [1, 2], range=(2, 1)), "plot 'x': expected a range"),
    (lambda: None, "positional argument"),
])
def test_wrong_values_are_told_in_the_panel(view, draw, message, capsys):
    view.add_panel("Wrong", draw)
    view.screenshot(SIZE)
    assert message in panel_errors(view)["Wrong"]


def test_wrong_use_is_refused(view):
    kept = []
    view.add_panel("Kept", kept.append)
    view.screenshot(SIZE)
    for wrong in (lambda: view.add_panel("x", 3), lambda: view.add_panel("", print), lambda: view.on_event(3),
                  lambda: view.on_event(print, kind="click"), lambda: kept[0].text("too late")):
        with pytest.raises(easypbr.ArgumentError):
            wrong()
    with pytest.raises(easypbr.UnknownNameError, match="did you mean 'Kept'"):
        view.remove_panel("Kepd")


def test_a_panel_may_use_its_viewer_but_not_draw_it(view, capsys):
    done = {}

    def uses(ui):
        view.settings.ssao.radius = 0.5
        view.camera = easypbr.Camera.look_at((0, 0, 5), (0, 0, 0))
        done["render"] = view.render((32, 24)).shape
        done["pick"] = view.pick(16, 12, (32, 24)).object
        view.scene.show(shapes.sphere(0.1), "ball")
        view.notify("hello")

    view.add_panel("Uses", uses)
    view.screenshot(SIZE)
    assert done == {"render": (24, 32, 4), "pick": "box"} and panel_errors(view) == {"Uses": ""}
    assert view.settings.ssao.radius == 0.5 and "ball" in view.scene.names()
    view.add_panel("Draws", lambda ui: view.screenshot(SIZE))
    view.screenshot(SIZE)
    assert "the window that it belongs to" in panel_errors(view)["Draws"]


def test_an_interrupt_in_a_panel_reaches_the_program(view):
    def interrupt(ui):
        raise KeyboardInterrupt

    view.add_panel("Stops", interrupt)
    with pytest.raises(KeyboardInterrupt):
        view.screenshot(SIZE)
    view.remove_panel("Stops")
    view.screenshot(SIZE)


def test_other_threads_use_the_viewer_while_a_panel_runs(view):
    stop = threading.Event()
    entered = []
    view.add_panel("Busy", lambda ui: (entered.append(1), ui.text("busy")))

    def other():
        while not stop.is_set():
            view.settings.ssao.radius = 0.4
            view.camera.position

    threads = [threading.Thread(target=other) for _ in range(3)]
    [thread.start() for thread in threads]
    for _ in range(5):
        view.screenshot((200, 150))
    stop.set()
    [thread.join(60) for thread in threads]
    assert not any(thread.is_alive() for thread in threads) and entered


def test_panels_of_two_viewers_that_use_each_other_do_not_hang(capsys):
    views = []
    for name in ("a", "b"):
        scene = Scene()
        scene.show(shapes.box(), name)
        views.append(Viewer((160, 120), {"image": {"samples": 1}}, scene))
    meet = threading.Barrier(2, timeout=60)
    failures = []

    def panel_of(own, other):
        first = []

        def draw(ui):
            if not first:
                first.append(1)
                meet.wait()  # Both are inside of their own now.
                try:
                    other.settings.ssao.radius = 0.5
                except easypbr.ContextError as error:
                    failures.append(str(error))
        own.add_panel("Uses the other", draw)

    panel_of(*views)
    panel_of(*reversed(views))
    threads = [threading.Thread(target=view.screenshot, args=((160, 120),)) for view in views]
    [thread.start() for thread in threads]
    [thread.join(60) for thread in threads]
    assert not any(thread.is_alive() for thread in threads)
    assert len(failures) == 1 and "two viewers wait for each other" in failures[0]


def test_a_viewer_is_not_kept_alive_by_functions_that_refer_to_it():
    def viewer_with_functions():
        view = Viewer((32, 24), scene=Scene())
        view.add_panel("Refers", lambda ui: view.settings)
        view.on_event(lambda event: view.settings)
        view.screenshot((32, 24))
        return weakref.ref(view)

    reference = viewer_with_functions()
    gc.collect()
    assert reference() is None

"""Panels of the program in clients: what they show, what clients do to them."""

import contextlib
import os
import pathlib
import threading
import weakref

import numpy as np
import pytest

from client import Client


def widget_of(message, panel, name):
    widgets = next(each["widgets"] for each in message["panels"] if each["name"] == panel)
    return next((widget for widget in widgets if widget["name"] == name), None)


def test_a_panel_is_shown_and_used(view, connect, tmp_path):
    clicked = threading.Event()

    @view.add_panel("Ball")
    def panel(ui):
        size = ui.slider("size", 1.0, 0.5, 2.0)
        ui.text(f"twice: {2 * size:g}")
        if ui.button("Stop"):
            clicked.set()

    client = connect()
    told = client.until_known("panels", lambda message: message["panels"])
    assert widget_of(told, "Ball", "size") == {"type": "slider", "name": "size", "value": 1.0, "min": 0.5, "max": 2.0}
    client.send("widget", panel="Ball", name="size", use=0, value="1.5")
    told = client.until_known("panels", lambda message: widget_of(message, "Ball", "size")["value"] == 1.5)
    assert widget_of(told, "Ball", "twice: 3")
    client.send("widget", panel="Ball", name="Stop", use=0, value="")
    for _ in range(200):  # It answers pictures meanwhile, as a page does.
        client.collect(0.1)
        if clicked.is_set():
            break
    assert clicked.is_set()


def test_a_panel_changes_the_scene(view, connect, tmp_path):
    vertices = np.array(view.scene.get("ball").V)
    view.add_panel("Ball", lambda ui: setattr(view.scene.get("ball"), "V", vertices * 1.4) if ui.button("Grow") else None)
    client = connect()
    first = client.until_exact()
    client.send("widget", panel="Ball", name="Grow", use=0, value="")
    second = client.until_exact(first.number)
    assert not np.array_equal(first.image(tmp_path), second.image(tmp_path))


def test_panels_come_and_go_while_it_is_served(view, connect):
    client = connect()
    client.until_known("panels", lambda message: not message["panels"])
    view.add_panel("One", lambda ui: ui.text("a"))
    view.add_panel("Two", lambda ui: ui.text("b"))
    client.until_known("panels", lambda message: [panel["name"] for panel in message["panels"]] == ["One", "Two"])
    view.add_panel("One", lambda ui: ui.text("c"))
    client.until_known("panels", lambda message: widget_of(message, "One", "c"))
    view.remove_panel("Two")
    client.until_known("panels", lambda message: [panel["name"] for panel in message["panels"]] == ["One"])
    client.send("widget", panel="Two", name="b", use=0, value="")
    client.until_told("notice", lambda notice: "no panel 'Two'" in notice["text"])


def test_what_a_panel_raises_is_told_and_nothing_ends(view, connect):
    def broken(ui):
        ui.text("before")
        raise KeyError("lost")

    view.add_panel("Broken", broken)
    client = connect()
    told = client.until_known("panels", lambda message: message["panels"])
    assert "KeyError: 'lost'" in told["panels"][0]["error"]
    client.until_exact()


def test_who_watches_changes_nothing(view, server, connect):
    view.add_panel("Ball", lambda ui: ui.slider("size", 1, 0, 9))
    watcher = connect(url=server.watch_url)
    watcher.until_known("panels", lambda message: message["panels"])
    watcher.send("widget", panel="Ball", name="size", use=0, value="5")
    watcher.until_told("notice", lambda notice: notice["error"])
    client = connect()
    told = client.until_known("panels", lambda message: message["panels"])
    assert widget_of(told, "Ball", "size")["value"] == 1


def test_the_window_has_the_same_values(view, connect):
    seen = []
    view.add_panel("Ball", lambda ui: seen.append(ui.slider("size", 1.0, 0, 9)))
    client = connect()
    client.until_known("panels", lambda message: message["panels"])
    client.send("widget", panel="Ball", name="size", use=0, value="5")
    client.until_known("panels", lambda message: widget_of(message, "Ball", "size")["value"] == 5)
    seen.clear()
    view.screenshot((400, 300))
    assert seen and set(seen) == {5.0}


def threads_named(name):
    count = 0
    for task in pathlib.Path("/proc/self/task").iterdir():
        with contextlib.suppress(OSError):  # It may end meanwhile.
            count += (task / "comm").read_text().strip() == name
    return count


def test_a_panel_may_close_its_server(view):
    """Its function runs on the thread that draws, which cannot wait for its own end."""
    before = threads_named("easypbr view"), threads_named("easypbr network")
    server, done, failures = view.serve(), threading.Event(), []

    def panel(ui):
        if done.is_set():
            return
        try:
            server.close()
        except Exception as error:  # It would be shown in the panel only.
            failures.append(error)
        done.set()

    client = Client(server.url)
    server._handle.add_panel("Ends", panel)
    assert done.wait(30)
    assert not failures
    server.close()  # waits for the thread
    assert (threads_named("easypbr view"), threads_named("easypbr network")) == before
    client.close()
    with view.serve() as again:  # Nothing is left behind.
        Client(again.url).close()


def test_settings_do_not_pile_up_while_a_panel_takes_its_time(view, server, connect):
    def resident_bytes():
        return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    is_in, goes_on = threading.Event(), threading.Event()

    def panel(ui):
        is_in.set()
        goes_on.wait(60)

    server._handle.add_panel("Slow", panel)
    client = connect()
    assert is_in.wait(60)
    before = resident_bytes()
    for i in range(50_000):  # about 2 kB each
        view.settings["tonemap.exposure"] = 1 + i % 7 / 1000
    grown = resident_bytes() - before
    view.settings["tonemap.exposure"] = 2.5
    goes_on.set()
    client.until_setting("tonemap.exposure", "2.5")
    assert grown < 30e6


def test_a_closed_server_keeps_no_function(view):
    class Owner:
        def draw(self, ui):
            ui.text("x")

    owner = Owner()
    alive = weakref.ref(owner)
    server = view.serve()
    server._handle.add_panel("Ball", owner.draw)
    del owner
    assert alive() is not None
    server.close()
    assert alive() is None


def test_dropping_everything_while_a_panel_runs_hangs_nowhere(view):
    for _ in range(3):
        server = view.serve()
        view.add_panel("Ball", lambda ui: ui.text("x"))
        server.close()
        del server


@pytest.mark.parametrize("members", [{"value": 3}, {"use": -1}, {"panel": "x" * 8200}, {"more": 1}])
def test_wrong_messages_end_the_connection(connect, members):
    client = connect()
    client.until_told("welcome")
    client.send("widget", **({"panel": "a", "name": "b", "use": 0, "value": ""} | members))
    assert client.until_closed()[0] == 1008

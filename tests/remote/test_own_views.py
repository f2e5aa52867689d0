"""Views of clients' own: a camera and settings for one, of the scene that all see."""

import time

import numpy as np
import pytest
from client import SHOT, Client, Frame, camera_of
from test_load import Process

import easypbr

FROM_ABOVE = "camera.pose=1,0,0,0,0,1,0,0,0,0,1,9,0,0,0,1 camera.fov_y_deg=20"


def look_alone(client, size=(160, 120)):
    """Asks for a view of its own. Its number."""
    client.send("view", own=True, width=size[0], height=size[1])
    return client.until_told("control", lambda message: message["view"] != 0)["view"]


def exact_of(client, view, after=0):
    return client.until(lambda message: isinstance(message, Frame) and message.is_exact and message.view == view
                        and message.number > after)


@pytest.fixture
def plain(view):
    """A view whose pictures do not depend on a camera's last bits."""
    view.settings.path.enabled = False
    view.render()
    return view


def test_it_is_the_rendered_picture_and_the_shared_view_stays(plain, connect, tmp_path):
    shared, client = connect(), connect()
    before = shared.until_exact()
    number = look_alone(client, (200, 140))
    first = exact_of(client, number)
    assert (first.width, first.height) == (200, 140)
    client.send("camera", text=FROM_ABOVE)
    moved = exact_of(client, number, first.number)
    client.until_known("camera", lambda message: "0,0,1,9" in message["text"])
    shared.collect(1)
    assert shared.frames[-1].number == before.number
    assert "0,0,1,9" not in shared.texts["camera"]["text"]
    for name, value in camera_of(client.texts["camera"]["text"]).items():
        plain.settings[name] = value
    shown = moved.image(tmp_path)
    assert np.array_equal(shown, plain.render((200, 140)))
    assert not np.array_equal(shown, first.image(tmp_path))


def test_settings_and_drags_are_its_own_and_changes_of_the_scene_are_everybody_s(plain, connect, tmp_path):
    shared, client = connect(), connect()
    shared.until_exact()
    number = look_alone(client)
    own = exact_of(client, number)
    client.send("set", name="background.color", value="#ff0000")
    client.drag((80, 60), (120, 60))
    red = exact_of(client, number, own.number)
    client.until_exact(shows=client.inputs)
    assert tuple(red.image(tmp_path)[0, 0]) == (255, 0, 0, 255)
    shared.collect(0.5)
    before = shared.frames[-1]
    assert tuple(before.image(tmp_path)[0, 0]) != (255, 0, 0, 255)
    # What the program shows, and what it sets, comes to both.
    last = client.frames[-1]
    plain.scene.show(easypbr.shapes.box((3, 0.2, 0.5)), "bar")
    after, in_own = shared.until_exact(before.number), exact_of(client, number, last.number)
    assert not np.array_equal(after.image(tmp_path), before.image(tmp_path))
    assert not np.array_equal(in_own.image(tmp_path), last.image(tmp_path))
    client.until_known("scene", lambda message: len(message["nodes"]) == 2)
    plain.settings.tonemap.exposure = 2
    shared.until_setting("tonemap.exposure", "2")
    client.until_setting("tonemap.exposure", "2")


def test_two_at_rest_are_both_drawn_to_their_end(plain, connect):
    shared, one, two = connect(), connect(), connect()
    shared.until_exact()
    numbers = [look_alone(client) for client in (one, two)]
    for client in (one, two):
        client.send("camera", text=FROM_ABOVE)
    for client, number in zip((one, two), numbers):
        assert exact_of(client, number).refined == 4


def test_what_all_see_is_not_changed_from_it(connect):
    client = connect()
    client.until_exact()
    look_alone(client)
    for kind, members in (("show", {"object": "ball", "visible": False}),
                          ("widget", {"panel": "Training", "name": "rate", "use": 0, "value": "1"}),
                          ("animate", {"number": 0, "plays": True, "time": 0, "speed": 1})):
        client.notices.clear()
        client.send(kind, **members)
        client.until_told("notice", lambda notice: notice["text"] == "What all see is changed in the shared view")
    client.send("tool", panel="Lights", name="Add a light", use=0, value="")
    client.until_told("notice", lambda notice: "there is no panel 'Lights'" in notice["text"])


def test_who_comes_back_sees_the_shared_view_and_frees_a_place(view, connect):
    with view.serve(own_views=1) as server:
        one, two = Client(server.url), Client(server.url)
        shared = one.until_exact()
        number = look_alone(one)
        exact_of(one, number)
        # Control of the shared view went to the other one.
        two.until_known("control", lambda message: message["controls"])
        assert [client.has_own for client in server.clients] == [True, False]
        two.send("view", own=True, width=160, height=120)
        two.until_told("notice", lambda notice: notice["text"] == "1 of 1 views of clients' own are taken")
        one.send("view", own=False, width=160, height=120)
        one.until_told("control", lambda message: message["view"] == 0 and not message["controls"])
        back = one.until(lambda message: isinstance(message, Frame) and message.view == 0 and message.is_exact)
        assert back.number >= shared.number
        look_alone(two)
        two.close()
        # The place is free again once it has gone.
        deadline = time.monotonic() + 30
        while len(server.clients) > 1 and time.monotonic() < deadline:
            time.sleep(0.05)
        look_alone(one)
        one.close()


def test_there_are_none_where_none_are_allowed(view):
    with view.serve(own_views=0) as server:
        client = Client(server.url)
        assert not client.until_told("control")["own"]
        client.send("view", own=True, width=160, height=120)
        client.until_told("notice", lambda notice: notice["text"] == "Own views are off here")
        client.close()
    with pytest.raises(easypbr.ArgumentError, match="own_views: expected 0 to 64, got 65"):
        view.serve(own_views=65)


def test_a_watcher_has_none_unless_that_is_allowed(view, server, connect):
    watcher = connect(server.watch_url)
    assert not watcher.until_told("control")["own"]
    watcher.send("view", own=True, width=160, height=120)
    watcher.until_told("notice", lambda notice: notice["text"] == "This link is for watching only")
    with view.serve(own_views_for_watchers=True) as open_server:
        watcher = Client(open_server.watch_url)
        number = look_alone(watcher)
        first = exact_of(watcher, number)
        watcher.send("camera", text=FROM_ABOVE)
        exact_of(watcher, number, first.number)
        # It still changes nothing for others, and has nothing computed for a file.
        watcher.send("show", object="ball", visible=False)
        watcher.until_told("notice", lambda notice: "in the shared view" in notice["text"])
        watcher.send("shot", id=1, width=32, height=32)
        watcher.until_told("notice", lambda notice: notice["text"] == "This link is for watching only")
        assert not any(frame.kind == SHOT for frame in watcher.frames)
        watcher.close()


def test_one_takes_at_most_48_mb():
    """At 1280x720, with a video's encoder, turned and at rest, clicked: the mean of three beside the shared one."""
    server = Process()
    clients = [Client(server.url, size=(1280, 720), video=True) for _ in range(4)]

    def use(client, view):
        for _ in range(20):
            client.inputs += 1
            client.send("turn", id=client.inputs, right=3, up=0)
            client.collect(0.05)
        client.send("pick", id=1, x=640.0, y=360.0)
        client.until_told("pick")
        client.until(lambda message: isinstance(message, Frame) and message.is_exact and message.view == view
                     and message.input == client.inputs)
        client.frames.clear()

    use(clients[0], 0)
    use(clients[0], 0)
    before = server.memory()
    for client in clients[1:]:
        use(client, look_alone(client, (1280, 720)))
        use(client, client.texts["control"]["view"])
    each = (server.memory() - before) / 3
    print(f"{each / 1e6:.1f} MB each")
    assert each <= 48e6
    for client in clients:
        client.close()
    server.process.communicate()

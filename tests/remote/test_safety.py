"""Who is let in, and what hostile clients can do: nothing."""

import contextlib
import http.client
import os
import socket
import stat
import time
from urllib.parse import urlsplit

import pytest
import websockets
import websockets.sync.client

import easypbr
from client import Client


def fetch(server, path, method="GET", **headers):
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=20)
    connection.request(method, path, headers=headers)
    response = connection.getresponse()
    body = response.read()
    connection.close()
    return response, body


def handshake_status(server, **options):
    """What the server says to a WebSocket that it does not accept."""
    with pytest.raises(websockets.exceptions.InvalidStatus) as refused:
        Client(server.url, **options)
    return refused.value.response.status_code


def is_alive(connect):
    return connect().until_exact()


def test_the_secret_is_long_and_in_the_fragment(server):
    parts = urlsplit(server.url)
    assert parts.hostname == "127.0.0.1" and parts.port == server.port
    assert parts.query == "" and parts.path == "/"
    token = parts.fragment.removeprefix("token=")
    assert len(bytes.fromhex(token)) == 32
    assert token not in server.watch_url and token not in repr(server)


@pytest.mark.parametrize("token", ["", "0" * 64, "secret", "\u00fc" * 64, "x" * 128])
def test_no_byte_of_the_scene_without_the_secret(server, token):
    client = Client(server.url, token=token)
    assert client.until_closed() == (4001, "the token is wrong")
    assert not client.texts and not client.frames


def test_the_secret_comes_first(server):
    client = Client(server.url, hello=False)
    client.send("resize", width=10, height=10)
    assert client.until_closed()[0] == 1008
    assert not client.texts


def test_who_says_nothing_is_sent_away(server):
    client = Client(server.url, hello=False)
    begun = time.monotonic()
    assert client.until_closed() == (1008, "no token came")
    assert 4 < time.monotonic() - begun < 15


def test_who_says_nothing_keeps_nobody_out(server, connect):
    """The oldest of those who have shown no secret makes room."""
    with contextlib.ExitStack() as ends:
        silent = [ends.enter_context(socket.create_connection(("127.0.0.1", server.port), timeout=20)) for _ in range(40)]
        assert fetch(server, "/")[0].status == 200
        assert is_alive(connect)
        assert silent[0].recv(1) == b""
        silent[-1].settimeout(0.2)
        with pytest.raises(TimeoutError):
            silent[-1].recv(1)


def test_guessing_is_slow(server):
    for _ in range(5):
        Client(server.url, token="0" * 64).until_closed()
    begun = time.monotonic()
    Client(server.url, token="0" * 64).until_closed()
    assert time.monotonic() - begun > 0.9


def test_pages_of_other_sites_cannot_connect(server):
    assert handshake_status(server, origin="http://evil.example") == 403
    assert handshake_status(server, origin="null") == 403
    assert handshake_status(server, origin=f"http://127.0.0.1:{server.port + 1}") == 403
    Client(server.url, origin=f"http://127.0.0.1:{server.port}").until_told("welcome")


def test_other_names_are_not_answered_to(server):
    """A name of somebody else's that resolves to this machine: DNS rebinding."""
    response, body = fetch(server, "/", Host="evil.example")
    assert response.status == 403 and b"<html" not in body
    response, _ = fetch(server, "/", Host=f"localhost:{server.port}")
    assert response.status == 200


def test_names_and_origins_can_be_added(view):
    with view.serve(host_names=["gpu.example.org"], origins=["https://hub.example.org"]) as server:
        assert fetch(server, "/", Host="gpu.example.org")[0].status == 200
        Client(server.url, origin="https://hub.example.org").until_told("welcome")


def test_the_page_and_nothing_else_is_served(server):
    response, body = fetch(server, "/any/prefix/")
    assert response.status == 200 and b"<!doctype html>" in body
    policy = response.headers["Content-Security-Policy"]
    assert "default-src 'none'" in policy and "unsafe" not in policy
    assert response.headers["X-Content-Type-Options"] == "nosniff"
    assert response.headers["Referrer-Policy"] == "no-referrer"
    assert response.headers["Cache-Control"] == "no-store"
    assert response.headers["Set-Cookie"] is None
    for path in ("/etc/passwd", "/../../../etc/passwd", "/..%2f..%2fetc%2fpasswd", "/app.js/..", "//etc/passwd"):
        assert fetch(server, path)[0].status == 404
    assert fetch(server, "/", method="POST")[0].status == 405
    response, body = fetch(server, "/app.js", method="HEAD")
    assert response.status == 200 and body == b"" and int(response.headers["Content-Length"]) > 1000


WATCHED = [
    ("set", {"name": "background.color", "value": "#ff0000"}),
    ("show", {"object": "ball", "visible": False}),
    ("camera", {"text": "camera.fov_y_deg=90"}),
    ("channel", {"name": "depth"}),
    ("resize", {"width": 50, "height": 50}),
    ("turn", {"id": 1, "right": 90, "up": 0}),
    ("act", {"what": "take"}),
    ("act", {"what": "reset"}),
    ("shot", {"id": 1, "width": 20, "height": 20}),
    ("pick", {"id": 1, "x": 80, "y": 60}),
]


def test_who_watches_changes_nothing(server, connect, tmp_path):
    controls = connect()
    first = controls.until_exact()
    watches = connect(server.watch_url)
    assert watches.until_told("welcome")["watches"]
    seen = watches.until_exact()
    assert (seen.image(tmp_path) == first.image(tmp_path)).all()
    before = dict(controls.settings)
    for kind, members in WATCHED:
        watches.send(kind, **members)
        watches.until_told("notice", lambda notice: notice["error"])
        watches.texts.clear()
    watches.pointer("press", 80, 60)
    watches.pointer("move", 120, 60)
    controls.collect(0.5)
    assert controls.settings == before and controls.frames[-1].number == first.number
    assert [client.watches_only for client in server.clients] == [False, True]


def test_one_controls_and_the_next_follows(server, connect):
    first, second = connect(), connect()
    assert first.until_told("control", lambda control: control["clients"] == 2)["controls"]
    assert not second.until_told("control")["controls"]
    second.send("set", name="background.color", value="#ff0000")
    second.until_told("notice", lambda notice: "controls" in notice["text"])
    first.close()
    assert second.until_told("control", lambda control: control["clients"] == 1)["controls"]


def test_who_stays_is_told_how_many_are_there(server, connect):
    first, watcher, alone = connect(), connect(server.watch_url), connect()
    first.until_known("control", lambda control: control["clients"] == 3)
    alone.send("view", own=True, width=160, height=120)
    alone.until_told("control", lambda control: control["view"] != 0)
    alone.close()
    assert first.until_told("control", lambda control: control["clients"] == 2)["controls"]
    watcher.close()
    assert first.until_told("control", lambda control: control["clients"] == 1)["controls"]


def test_control_is_asked_for_and_given(connect):
    first, second = connect(), connect()
    first.until_exact()
    first.send("turn", id=1, right=5, up=0)
    first.until_exact(first.frames[-1].number)
    second.send("act", what="take")
    second.until_told("notice", lambda notice: "using" in notice["text"])
    first.until_told("notice", lambda notice: "asks" in notice["text"])
    first.send("act", what="leave")
    second.until_told("control", lambda control: control["controls"])
    first.until_told("control", lambda control: not control["controls"])


FORBIDDEN = ["environment.file", "background.image", "material.shader", "material.base_color_texture", "limits.memory",
             "load.crease_deg", "load.variant", "image.size"]


@pytest.mark.parametrize("name", FORBIDDEN)
def test_files_shaders_and_limits_are_the_programs(connect, name):
    client = connect()
    client.until_exact()
    client.send("set", name=name, value="/etc/passwd")
    assert "only the program" in client.until_told("notice")["text"]
    assert name not in client.settings
    assert name not in [field["name"] for field in client.texts["welcome"]["fields"]]


def test_new_settings_that_are_texts_are_not_open(connect):
    """Whoever adds a text to the table of settings has to think of clients."""
    fields = connect().until_told("welcome")["fields"]
    texts = {field["name"] for field in fields if field["type"] == "text" and "choices" not in field}
    assert texts == {"style.scalar", "annotation.title"}


@pytest.mark.parametrize("name, value", [("image.samples", "60000"), ("image.samples", "-1"), ("camera.fov_y_deg", "nan"),
                                         ("nonsense", "1"), ("tonemap.exposure", "1e400"), ("background.color", "red<b>")])
def test_wrong_values_are_told_and_change_nothing(connect, name, value):
    client = connect()
    client.until_exact()
    before = client.settings.get(name)
    client.send("set", name=name, value=value)
    assert client.until_told("notice")["error"]
    client.collect(0.3)
    assert client.settings.get(name) == before


HOSTILE = ["", "{", "[]", "null", '{"kind":"explode"}', '{"kind":"resize","width":1e99,"height":1}', "[" * 3000,
           '{"kind":"ack","frame":-1,"chunk":0,"busy":0}', '{"kind":"set","name":"a"}']


@pytest.mark.parametrize("text", HOSTILE)
def test_what_is_no_message_ends_the_connection_with_a_reason(connect, text):
    client = connect()
    client.until_told("welcome")
    client.socket.send(text)
    code, reason = client.until_closed()
    assert code == 1008 and reason
    is_alive(connect)


def test_bytes_and_long_messages_end_it_too(connect):
    for message, code in ((b"\x00" * 10, 1008), ("x" * 70000, 1009)):
        client = connect()
        client.until_told("welcome")
        client.socket.send(message)
        assert client.until_closed()[0] == code
    client = connect(hello=False)
    client.socket.send("x" * 5000)
    assert client.until_closed()[0] == 1009


def test_a_flood_ends_it(connect):
    client = connect()
    client.until_told("welcome")
    with pytest.raises(websockets.exceptions.ConnectionClosed):
        for step in range(100000):
            client.pointer("move", step % 100, 5)
    is_alive(connect)


def raw(server, data=b""):
    connection = socket.create_connection(("127.0.0.1", server.port), timeout=30)
    connection.sendall(data)
    return connection


REQUESTS = [b"\x00\xff" * 100, b"GET / HTTP/1.1\r\n\r\n", b"GET / HTTP/9.9\r\nHost: localhost\r\n\r\n",
            b"GET / HTTP/1.1\r\nHost: localhost\r\nHost: evil\r\n\r\n",
            b"GET / HTTP/1.1\r\nHost: localhost\r\nX: " + b"a" * 20000 + b"\r\n\r\n",
            b"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999999999999999\r\n\r\n"]


@pytest.mark.parametrize("request_bytes", REQUESTS)
def test_requests_that_are_none_are_refused(server, connect, request_bytes):
    answer = b""
    with raw(server, request_bytes) as connection, contextlib.suppress(ConnectionResetError):
        answer = connection.recv(1000)
    assert b"200" not in answer.split(b"\r\n")[0]
    assert fetch(server, "/")[0].status == 200


def test_slow_requests_do_not_keep_others_out(server):
    """Half a header, 40 times: more than may wait."""
    slow = [raw(server, b"GET / HTTP/1.1\r\nHost: loc") for _ in range(31)]
    assert fetch(server, "/")[0].status == 200
    for connection in slow:
        connection.close()


def upgraded(server):
    connection = raw(server, (f"GET /socket HTTP/1.1\r\nHost: localhost:{server.port}\r\nUpgrade: websocket\r\n"
                              "Connection: Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
                              "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: easypbr.1\r\n\r\n").encode())
    answer = connection.recv(4000)
    assert answer.startswith(b"HTTP/1.1 101")
    return connection


FRAMES = [b"\x81\x05hello",  # Not masked.
          b"\x89\xff" + b"\xff" * 8,  # A ping of 2^63 bytes.
          b"\x81\xff" + b"\xff" * 8 + b"abcd",  # A text of 2^64 bytes.
          b"\x89\xfe\x00\x7e" + b"\x00" * 130,  # A control frame of 126 bytes.
          b"\x83\x80abcd",  # An unknown kind.
          b"\xf1\x80abcd",  # Reserved bits.
          b"\x80\x80abcd"]  # A continuation of nothing.


@pytest.mark.parametrize("data", FRAMES)
def test_frames_that_are_none_end_the_connection(server, connect, data):
    with upgraded(server) as connection:
        connection.sendall(data)
        connection.settimeout(20)
        rest = b"x"
        try:
            while rest:
                rest = connection.recv(1000)
        except ConnectionResetError:
            pass
    is_alive(connect)


def test_asking_for_key_frames_without_end_makes_few(connect):
    """They cost everybody bits: who has lost its place again and again waits longer each time."""
    client = connect(video=True)
    client.until_exact()
    client.pointer("press", 80, 60)
    end, step = time.monotonic() + 4, 0
    while time.monotonic() < end:
        client.send("decodes", h264=True)
        client.pointer("move", 80 + (step := step + 1) % 40, 60)
        client.collect(0.03)
    keys = [frame for frame in client.frames if frame.codec == 3 and frame.is_key]
    assert 1 <= len(keys) <= 4  # At the first movement, then 1 s and 2 s later; one more where the picture's size changes.


def test_there_is_room_for_so_many_clients(view):
    with view.serve(max_clients=2) as server:
        clients = [Client(server.url), Client(server.url)]
        for client in clients:
            client.until_told("welcome")
        assert Client(server.url).until_closed() == (1013, "there are too many clients")
        clients[0].close()
        deadline = time.monotonic() + 20
        while len(server.clients) == 2 and time.monotonic() < deadline:
            time.sleep(0.02)
        Client(server.url).until_told("welcome")


def test_html_in_names_stays_text(view, connect):
    name = "<img src=x onerror=alert(1)>"
    view.scene.show(easypbr.shapes.sphere(2, 8), name)
    client = connect()
    client.until_known("scene", lambda scene: name in [node["path"] for node in scene["nodes"]])


def test_connections_leave_nothing_behind(server, connect):
    connect().until_exact()

    def descriptors():
        return len(os.listdir("/proc/self/fd")), len(os.listdir("/proc/self/task"))

    before = descriptors()  # Possibly with what an earlier test's server has yet to close.
    for _ in range(200):
        client = Client(server.url)
        client.until_told("welcome")
        client.close()
    deadline = time.monotonic() + 20
    while any(map(int.__gt__, descriptors(), before)) and time.monotonic() < deadline:
        time.sleep(0.05)
    files, threads = descriptors()
    assert files <= before[0] and threads <= before[1]


def test_closing_says_goodbye_and_frees_the_port(view):
    server = view.serve()
    port = server.port
    client = Client(server.url)
    client.until_told("welcome")
    server.close()
    assert client.until_closed()[0] == 1001
    assert not server.is_open and server.clients == []
    server.close()
    with view.serve(port=port) as again:
        assert again.port == port


def test_a_unix_socket_is_the_users_alone(view, tmp_path):
    path = tmp_path / "socket"
    with view.serve(socket=path) as server:
        assert stat.S_IMODE(path.stat().st_mode) == 0o600
        assert server.port == 0 and str(path) in server.forward_command("gpu")
        connection = socket.socket(socket.AF_UNIX)
        connection.connect(str(path))
        connection.sendall(b"GET / HTTP/1.1\r\nHost: localhost:8123\r\n\r\n")
        assert connection.recv(100).startswith(b"HTTP/1.1 200")
        connection.close()
        with pytest.raises(easypbr.FileError, match="another server"):
            view.serve(socket=path)
    assert not path.exists()


def test_secrets_from_a_file(view, tmp_path):
    path = tmp_path / "token"
    path.write_text("a" * 40 + "\n" + "b" * 40 + "\n")
    path.chmod(0o600)
    with view.serve(token_file=path) as server:
        assert server.url.endswith("#token=" + "a" * 40) and server.watch_url.endswith("#token=" + "b" * 40)
    path.chmod(0o644)
    with pytest.raises(easypbr.FormatError, match="others"):
        view.serve(token_file=path)


@pytest.mark.parametrize("options", [{"port": -1}, {"port": 65536}, {"max_clients": 0}, {"bind": "nonsense"},
                                     {"host_names": ["a b"]}, {"origins": ["hub"]}])
def test_wrong_options_are_refused(view, options):
    with pytest.raises(easypbr.ArgumentError):
        view.serve(**options)


def test_a_port_that_is_taken_is_told(view, server):
    with pytest.raises(easypbr.Error, match="cannot listen"):
        view.serve(port=server.port)


def test_all_addresses_of_the_machine_are_answered_to(view):
    """A literal address cannot be a name of somebody else's."""
    with view.serve(bind="0.0.0.0") as server:
        first, *others = server.urls
        assert first == server.url
        for url in others:
            host = urlsplit(url).netloc
            assert not host.startswith("127.")
            assert fetch(server, "/", Host=host)[0].status == 200
        assert fetch(server, "/", Host="203.0.113.9")[0].status == 403  # of no interface: RFC 5737


def test_other_addresses_are_warned_of(view, caplog):
    view.serve(bind="0.0.0.0").close()
    assert "seen by the network" in caplog.text

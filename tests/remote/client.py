"""A client of a served view: says hello, answers pictures, keeps what it is told."""

import contextlib
import json
import struct
import time
from urllib.parse import parse_qs, urlsplit

import numpy as np
import websockets.sync.client

import easypbr

HEADER = struct.Struct("<BBHIIHHHHHHIIII")
MOVING, STILL, SHOT = 1, 2, 3
LAST, EXACT, KEY = 1, 2, 8
JPEG, PNG, H264 = 1, 2, 3
PATIENCE_S = 60


class Frame:
    def __init__(self, data: bytes):
        (self.kind, self.codec, self.flags, self.number, self.input, self.view, self.width, self.height, self.refined,
         self.total, self.chunk, self.bytes, self.draw_us, self.encode_us, self.wait_us) = HEADER.unpack(data[:40])
        self.data = data[40:]

    @property
    def is_last(self):
        return bool(self.flags & LAST)

    @property
    def is_exact(self):
        return bool(self.flags & EXACT)

    @property
    def is_key(self):
        return bool(self.flags & KEY)

    def image(self, folder):
        """As an array, height x width x channels."""
        path = folder / ("frame.png" if self.codec == 2 else "frame.jpg")
        path.write_bytes(self.data)
        return np.asarray(easypbr.load_image(path))


def address(url):
    parts = urlsplit(url)
    return f"ws://{parts.netloc}{parts.path}socket", parse_qs(parts.fragment)["token"][0]


class Client:
    """`answers`: whether pictures are acknowledged by themselves; `video`: whether it says that it decodes H.264."""

    def __init__(self, url, size=(160, 120), token=None, hello=True, answers=True, video=False, **options):
        where, secret = address(url)
        self._ends = contextlib.ExitStack()
        self.socket = self._ends.enter_context(websockets.sync.client.connect(
            where, subprotocols=["easypbr.1"], max_size=None, compression=None, **options))
        self.answers = answers
        self.texts: dict[str, dict] = {}
        self.tools: dict[str, dict] = {}
        self.settings: dict[str, dict] = {}
        self.notices: list[str] = []
        self.frames: list[Frame] = []
        self.inputs = 0
        self._chunks: dict[int, list[bytes]] = {}
        if hello:
            self.send("hello", token=secret if token is None else token, width=size[0], height=size[1])
        if video:
            self.send("decodes", h264=True)

    def send(self, kind, **members):
        self.socket.send(json.dumps({"kind": kind, **members}))

    def pointer(self, action, x, y, button="left", wheel=0.0, time=0.0):
        self.inputs += 1
        self.send("pointer", id=self.inputs, action=action, button=button, x=x, y=y, wheel=wheel, shift=False, time=time)

    def drag(self, start, end, steps=5):
        self.pointer("press", *start)
        for i in range(1, steps + 1):
            self.pointer("move", *(start[k] + (end[k] - start[k]) * i / steps for k in (0, 1)))
            self.collect(0.03)
        self.pointer("release", *end)

    def ack(self, frame):
        self.send("ack", frame=frame.number, chunk=frame.chunk, busy=0)

    def receive(self, timeout=PATIENCE_S):
        """The next message: a dict, or a whole Frame; None for a chunk. Raises TimeoutError, ConnectionClosed."""
        message = self.socket.recv(timeout)
        if isinstance(message, str):
            return self._told(json.loads(message))
        frame = Frame(message)
        if self.answers:
            self.ack(frame)
        parts = self._chunks.setdefault(frame.number, [])
        parts.append(frame.data)
        if not frame.is_last:
            return None
        frame.data = b"".join(self._chunks.pop(frame.number))
        self._chunks.clear()
        self.frames.append(frame)
        return frame

    def _told(self, message):
        self.texts[message["kind"]] = message
        if message["kind"] == "settings":
            self.settings |= message["values"]
        if message["kind"] == "tool":
            self.tools[message["name"]] = message
        if message["kind"] == "notice":
            self.notices.append(message["text"])
        return message

    def collect(self, seconds):
        """Whatever comes in this time."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            try:
                self.receive(left)
            except TimeoutError:
                return

    def until(self, wanted):
        """Messages until one that `wanted` takes; returns it."""
        end = time.monotonic() + PATIENCE_S
        while (left := end - time.monotonic()) > 0:
            message = self.receive(left)
            if message is not None and wanted(message):
                return message
        raise AssertionError("it never came")

    def until_known(self, kind, wanted):
        """What it is told of this kind, now or later."""
        known = self.texts.get(kind)
        return known if known and wanted(known) else self.until_told(kind, wanted)

    def until_told(self, kind, wanted=lambda message: True):
        return self.until(lambda message: isinstance(message, dict) and message["kind"] == kind and wanted(message))

    def until_exact(self, after=0, shows=0):
        """The first exact picture newer than frame `after` that shows input `shows`, received now or later."""
        def is_wanted(message):
            return (isinstance(message, Frame) and message.kind == STILL and message.is_exact
                    and message.number > after and message.input >= shows)

        return next(filter(is_wanted, self.frames), None) or self.until(is_wanted)

    def until_setting(self, name, value):
        if self.settings.get(name, {}).get("value") != value:
            self.until_told("settings", lambda message: message["values"].get(name, {}).get("value") == value)

    def until_closed(self):
        """The code and the reason."""
        try:
            while True:
                self.receive()
        except websockets.exceptions.ConnectionClosed as closed:
            return (closed.rcvd.code, closed.rcvd.reason) if closed.rcvd else (1006, "")

    def close(self):
        self._ends.close()


def camera_of(text):
    """Settings of a camera as the server writes it."""
    settings = dict(line.split("=", 1) for line in text.split())
    return {name: value_of(value) for name, value in settings.items()}


def value_of(text):
    try:
        numbers = [float(number) for number in text.split(",")]
    except ValueError:
        return text
    return numbers if len(numbers) > 1 else numbers[0]

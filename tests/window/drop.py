"""Drags files from outside onto the window under a point and drops them there (XDND version 5, Xlib by ctypes).
usage: drop.py X Y FILE...  Coordinates of the screen. Prints "dropped" when the window has said that it is done."""
import ctypes
import pathlib
import sys
from ctypes import POINTER, byref, c_char_p, c_int, c_long, c_uint, c_ulong, c_void_p

CLIENT_MESSAGE, SELECTION_REQUEST, SELECTION_NOTIFY = 33, 30, 31


class ClientMessage(ctypes.Structure):
    _fields_ = [("type", c_int), ("serial", c_ulong), ("send_event", c_int), ("display", c_void_p), ("window", c_ulong),
                ("message_type", c_ulong), ("format", c_int), ("data", c_long * 5)]


class SelectionRequest(ctypes.Structure):
    _fields_ = [("type", c_int), ("serial", c_ulong), ("send_event", c_int), ("display", c_void_p), ("owner", c_ulong),
                ("requestor", c_ulong), ("selection", c_ulong), ("target", c_ulong), ("property", c_ulong), ("time", c_ulong)]


class SelectionNotify(ctypes.Structure):
    _fields_ = [("type", c_int), ("serial", c_ulong), ("send_event", c_int), ("display", c_void_p),
                ("requestor", c_ulong), ("selection", c_ulong), ("target", c_ulong), ("property", c_ulong), ("time", c_ulong)]


class Event(ctypes.Union):
    _fields_ = [("type", c_int), ("client", ClientMessage), ("request", SelectionRequest), ("notify", SelectionNotify),
                ("room", c_long * 24)]


x11 = ctypes.CDLL("libX11.so.6")
for name, result, arguments in (
    ("XOpenDisplay", c_void_p, [c_char_p]), ("XDefaultRootWindow", c_ulong, [c_void_p]),
    ("XInternAtom", c_ulong, [c_void_p, c_char_p, c_int]),
    ("XCreateSimpleWindow", c_ulong, [c_void_p, c_ulong, c_int, c_int, c_uint, c_uint, c_uint, c_ulong, c_ulong]),
    ("XSetSelectionOwner", c_int, [c_void_p, c_ulong, c_ulong, c_ulong]),
    ("XTranslateCoordinates", c_int, [c_void_p, c_ulong, c_ulong, c_int, c_int, POINTER(c_int), POINTER(c_int), POINTER(c_ulong)]),
    ("XGetWindowProperty", c_int, [c_void_p, c_ulong, c_ulong, c_long, c_long, c_int, c_ulong, POINTER(c_ulong), POINTER(c_int),
                                   POINTER(c_ulong), POINTER(c_ulong), POINTER(c_void_p)]),
    ("XChangeProperty", c_int, [c_void_p, c_ulong, c_ulong, c_ulong, c_int, c_int, c_char_p, c_int]),
    ("XSendEvent", c_int, [c_void_p, c_ulong, c_int, c_long, POINTER(Event)]),
    ("XNextEvent", c_int, [c_void_p, POINTER(Event)]), ("XFlush", c_int, [c_void_p]),
):
    getattr(x11, name).restype = result
    getattr(x11, name).argtypes = arguments

display = x11.XOpenDisplay(None)
root = x11.XDefaultRootWindow(display)
source = x11.XCreateSimpleWindow(display, root, 0, 0, 1, 1, 0, 0, 0)
atom = {name: x11.XInternAtom(display, name.encode(), 0) for name in (
    "XdndAware", "XdndEnter", "XdndPosition", "XdndStatus", "XdndDrop", "XdndFinished", "XdndSelection", "XdndActionCopy",
    "text/uri-list")}


def understands_drops(window: int) -> bool:
    kind, format_, count, rest, data = c_ulong(), c_int(), c_ulong(), c_ulong(), c_void_p()
    x11.XGetWindowProperty(display, window, atom["XdndAware"], 0, 1, 0, 0, byref(kind), byref(format_), byref(count),
                           byref(rest), byref(data))
    return count.value > 0


def window_at(x: int, y: int) -> int:
    """The deepest window under the point that understands drops: window managers put frames around."""
    window, found = root, 0
    while window:
        child, to_x, to_y = c_ulong(), c_int(), c_int()
        x11.XTranslateCoordinates(display, root, window, x, y, byref(to_x), byref(to_y), byref(child))
        window = child.value
        if window and understands_drops(window):
            found = window
    assert found, "nothing under the point takes drops"
    return found


def send(window: int, message: str, *data: int) -> None:
    event = Event()
    event.client.type, event.client.window, event.client.message_type, event.client.format = (
        CLIENT_MESSAGE, window, atom[message], 32)
    event.client.data = (c_long * 5)(source, *data)
    x11.XSendEvent(display, window, 0, 0, byref(event))
    x11.XFlush(display)


def hand_over(request: SelectionRequest, text: bytes) -> None:
    x11.XChangeProperty(display, request.requestor, request.property, request.target, 8, 0, text, len(text))
    event = Event()
    event.notify.type, event.notify.requestor, event.notify.selection = SELECTION_NOTIFY, request.requestor, request.selection
    event.notify.target, event.notify.property, event.notify.time = request.target, request.property, request.time
    x11.XSendEvent(display, request.requestor, 0, 0, byref(event))
    x11.XFlush(display)


x, y = int(sys.argv[1]), int(sys.argv[2])
text = "".join(pathlib.Path(path).absolute().as_uri() + "\r\n" for path in sys.argv[3:]).encode()
target = window_at(x, y)
x11.XSetSelectionOwner(display, atom["XdndSelection"], source, 0)
send(target, "XdndEnter", 5 << 24, atom["text/uri-list"], 0, 0)
send(target, "XdndPosition", 0, x << 16 | y, 0, atom["XdndActionCopy"])
event = Event()
while True:
    x11.XNextEvent(display, byref(event))
    if event.type == SELECTION_REQUEST:
        hand_over(event.request, text)
    elif event.type == CLIENT_MESSAGE and event.client.message_type == atom["XdndStatus"]:
        assert event.client.data[1] & 1, "the window does not take it"
        send(target, "XdndDrop", 0, 0, 0, 0)
    elif event.type == CLIENT_MESSAGE and event.client.message_type == atom["XdndFinished"]:
        print("dropped", flush=True)
        break

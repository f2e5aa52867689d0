"""Notebook widgets: a view in a cell, over the kernel's own channel."""

import base64
import functools
import importlib
import importlib.util
import operator
import sys
import threading
import weakref
from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from . import _easypbr
from .errors import ArgumentError
from .scene import Scene
from .settings import Settings

#: Above it an image is saved with the notebook as JPEG.
MOST_PNG_BYTES = 300_000
#: Width of a widget without a size, in CSS pixels.
USUAL_WIDTH = 800
#: Sides of a widget, in CSS pixels.
SMALLEST, LARGEST = 16, 4096
MIME_TYPE = "application/vnd.jupyter.widget-view+json"


class View(Protocol):
    """What a widget needs of a Viewer."""

    scene: Scene
    _handle: "_easypbr.ViewerHandle"

    @property
    def settings(self) -> Settings: ...

    def render(self, size: Any = None) -> NDArray[Any]: ...

    def _serve_panels(self, front_end: Any) -> None: ...


def can_show() -> bool:
    """Whether this is a notebook's kernel and anywidget is installed."""
    ipython = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    return getattr(shell, "kernel", None) is not None and importlib.util.find_spec("anywidget") is not None


def picture_of(view: View, size: tuple[int, int]) -> tuple[str, bytes]:
    """What is saved with a notebook, and its MIME type: PNG, or JPEG where that is large."""
    image = view.render(size)
    data = _easypbr.encode_png(image)
    if len(data) <= MOST_PNG_BYTES or image[..., 3].min() < 255:
        return "image/png", data
    return "image/jpeg", _easypbr.encode_jpeg(image, 90)


@functools.cache
def widget_class() -> type:
    """The class of widgets; made when the first one is, so that easypbr imports nothing of notebooks."""
    try:
        anywidget: Any = importlib.import_module("anywidget")
        traitlets: Any = importlib.import_module("traitlets")
    except ImportError:
        raise ImportError("widgets need anywidget: pip install easypbr[jupyter]") from None

    class ViewWidget(anywidget.AnyWidget):
        """A view in the cells of a notebook; Viewer.widget() makes it."""

        _esm = _easypbr.widget_script()
        _width = traitlets.Int().tag(sync=True)
        _height = traitlets.Int().tag(sync=True)
        _label = traitlets.Unicode().tag(sync=True)
        _picture = traitlets.Bytes().tag(sync=True)

        def __init__(self, view: View, size: tuple[int, int], holds: bool = True) -> None:
            """`holds`: the widget keeps the view alive; else it ends with it."""
            # ipywidgets keeps every widget that is not closed.
            self._view: Callable[[], View | None] = (lambda: view) if holds else weakref.ref(view)
            if not holds:
                weakref.finalize(view, _close, weakref.ref(self)).atexit = False
            kind, picture = picture_of(view, size)
            self._still = kind, picture
            label = ", ".join(view.scene.names()) or "Empty scene"
            super().__init__(_width=size[0], _height=size[1], _label=label, _picture=picture)
            self._lines = _Lines()
            self._channel = view._handle.open_channel()
            # Threads within the library must not outlive the interpreter.
            weakref.finalize(self, self._channel.close)
            view._serve_panels(self)
            self.on_msg(_receive)
            threading.Thread(target=_carry, args=(weakref.ref(self), self._channel), name="easypbr widget", daemon=True).start()

        @property
        def _panel_handle(self) -> "_easypbr.ChannelHandle":
            return self._channel

        def keep(self) -> None:
            """Takes the present picture of the view as the one that is saved with the notebook. Cells show it when they run
            again; where the widget's state is saved too, at once."""
            view = self._view()
            if view is None:
                return
            self._still = picture_of(view, (self._width, self._height))
            self._picture = self._still[1]

        def add_animations(self, name: str, animations: "_easypbr.Animations") -> None:
            """Lets the widget play the animations of a file: load_scene(path).animations."""
            self._channel.add_animations(name, animations)

        def close(self) -> None:
            """Ends the drawing and removes the widget from all cells."""
            if hasattr(self, "_channel"):
                self._channel.close()
            super().close()

        def _repr_mimebundle_(self, **_: Any) -> dict[str, Any]:
            kind, picture = self._still
            return {
                "text/plain": f"<view of {self._label}>",
                kind: base64.b64encode(picture).decode(),
                MIME_TYPE: {"version_major": 2, "version_minor": 0, "model_id": self.model_id},
            }

    return ViewWidget


def _close(reference: "weakref.ref[Any]") -> None:
    widget = reference()
    if widget is not None:
        widget.close()


class _Cells:
    """What cells show, where the front end names them. A widget of a view whose cells all show something else is closed:
    IPython keeps the view itself, as the cell's result."""

    def __init__(self) -> None:
        #: By cell: its last run that showed a view, and the widgets that this one shows.
        self._shown: dict[str, tuple[str, weakref.WeakSet[Any]]] = {}

    def shows(self, widget: Any) -> None:
        """The cell that runs shows a widget."""
        cell, run = _running_cell()
        if not cell:
            return
        last_run, widgets = self._shown.get(cell, ("", weakref.WeakSet()))
        if run == last_run:
            widgets.add(widget)
            return
        self._shown[cell] = run, weakref.WeakSet([widget])
        for old in list(widgets):
            if not any(old in present for _, present in self._shown.values()):
                old.close()


#: Called with the widget that the cell which runs shows.
note_shown: Callable[[Any], None] = _Cells().shows


def _running_cell() -> tuple[str, str]:
    """The identifiers of a notebook's cell and of its run; empty where the front end does not tell them."""
    ipython: Any = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    parent: dict[str, Any] = getattr(shell, "get_parent", dict)()
    return str(parent.get("metadata", {}).get("cellId") or ""), str(parent.get("header", {}).get("msg_id") or "")


class _Lines:
    """What the pages of a widget get. Some front ends lose the bytes beside a message: each page is asked first whether they
    arrive; where they do not, they are sent as text. Thread-safe."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        #: By client: whether bytes arrive, None until it has said so; and what waits for that.
        self._lines: dict[int, tuple[bool | None, list[bytes]]] = {}

    def send(self, widget: Any, client: int, data: bytes) -> None:
        with self._lock:
            arrives, waiting = self._lines.get(client, (None, []))
            if arrives is not None:
                _send(widget, client, data, arrives)
                return
            if not waiting:
                widget.send({"client": client, "probe": True}, [b"bytes"])
            self._lines[client] = None, [*waiting, data]

    def answered(self, widget: Any, client: int, arrives: bool) -> None:
        with self._lock:
            _, waiting = self._lines.get(client, (None, []))
            self._lines[client] = arrives, []
            for data in waiting:
                _send(widget, client, data, arrives)

    def forget(self, client: int) -> None:
        with self._lock:
            self._lines.pop(client, None)


def _send(widget: Any, client: int, data: bytes, arrives: bool) -> None:
    if arrives:
        widget.send({"client": client}, [data])
    else:
        widget.send({"client": client, "data": base64.b64encode(data).decode()})


def _receive(widget: Any, content: Any, _: Any) -> None:
    """What a page has sent. It is only put aside here: the kernel's thread draws nothing."""
    client = content.get("client") if isinstance(content, dict) else None
    if not isinstance(client, int) or not 0 <= client < 2**53:
        return
    if content.get("gone"):
        widget._lines.forget(client)
        widget._channel.leave(client)
    elif "arrives" in content:
        widget._lines.answered(widget, client, bool(content["arrives"]))
    else:
        widget._channel.receive(client, str(content.get("text", "")))


def _carry(reference: "weakref.ref[Any]", channel: "_easypbr.ChannelHandle") -> None:
    """Hands on what the view has for the pages, also while a cell runs."""
    while channel.is_open:
        messages = channel.take(1.0)
        widget = reference()
        if widget is None:
            return
        for client, text, data, code in messages:
            if code:
                widget._lines.forget(client)
                widget.send({"client": client, "code": code, "reason": text})
            elif data:
                widget._lines.send(widget, client, data)
            else:
                widget.send({"client": client, "text": text})
        del widget


def size_for(view: View, size: Any) -> tuple[int, int]:
    """In CSS pixels: as it is given, else that of the view's images, as wide as a notebook."""
    if size is not None:
        try:
            width, height = (operator.index(side) for side in size)
        except (TypeError, ValueError):
            raise ArgumentError(f"size: expected (width, height) as whole numbers, got {size!r}") from None
        if not SMALLEST <= min(width, height) <= max(width, height) <= LARGEST:
            raise ArgumentError(f"size: expected sides from {SMALLEST} to {LARGEST} CSS pixels, got {size!r}")
        return width, height
    width, height = (int(side) for side in np.asarray(view.settings["image.size"]))
    return min(width, USUAL_WIDTH), max(SMALLEST, round(height * min(1.0, USUAL_WIDTH / width)))

"""Custom panels in the window and in the browser views of a viewer, and callbacks."""

import sys
import traceback
import weakref
from collections.abc import Callable, Iterable, Sequence
from typing import Any, TypeVar, overload

import numpy as np

from . import _easypbr
from .errors import ArgumentError

Value = TypeVar("Value")

# Decorators return the function as it is, with its own type.
_Draws = TypeVar("_Draws", bound=Callable[["Panel"], object])
_Called = TypeVar("_Called", bound=Callable[[], object])
_Handles = TypeVar("_Handles", bound=Callable[["_easypbr.Event"], object])

_KINDS = ("move", "press", "release", "scroll", "key_down", "key_up", "text", "drop", "resize", "focus_lost", "leave")


class Panel:
    """Widgets of a panel, from top to bottom: every method shows a widget and returns its value.

    The argument is the initial value. A widget keeps the user's value, by its name, as in
    `rate = ui.slider("rate", 0.1, 0, 1)`; another initial value replaces it."""

    def __init__(self) -> None:
        self._handle: _easypbr._Widgets | None = None
        self._memory: dict[str, tuple[Any, Any]] = {}

    def _widgets(self) -> "_easypbr._Widgets":
        if self._handle is None:
            raise ArgumentError("a panel's widgets can be drawn only while its function runs")
        return self._handle

    def _remembered(self, name: str, given: Value, draw: Callable[[Value], Any]) -> Value:
        """Draws a widget that keeps its value while the initial value stays the same."""
        last_given, value = self._memory.get(name, (given, given))
        if given != last_given:
            value = given
        value = draw(value)
        self._memory[name] = (given, value)
        return value

    def text(self, text: object) -> None:
        """A paragraph."""
        self._widgets().text(str(text))

    def separator(self) -> None:
        """A horizontal line."""
        self._widgets().separator()

    def same_line(self) -> None:
        """Places the next button or text beside the last one."""
        self._widgets().same_line()

    def section(self, title: str, open: bool = True) -> bool:
        """A collapsible section: `if ui.section("More"): ...`"""
        return self._widgets().section(title, open)

    def button(self, name: str) -> bool:
        """True when it was clicked: `if ui.button("Reset"): ...`"""
        return self._widgets().button(name)

    def checkbox(self, name: str, value: bool = False) -> bool:
        widgets = self._widgets()
        return self._remembered(name, bool(value), lambda v: widgets.checkbox(name, v))

    def slider(self, name: str, value: float, low: float, high: float) -> float:
        """A number between low and high; an integer if all three are integers."""
        widgets = self._widgets()
        if all(isinstance(v, (int, np.integer)) and not isinstance(v, bool) for v in (value, low, high)):
            return self._remembered(name, int(value), lambda v: widgets.slider_int(name, v, int(low), int(high)))
        return self._remembered(name, float(value), lambda v: widgets.slider(name, v, low, high))

    def number(self, name: str, value: float = 0.0) -> float:
        """A number without a range: dragged, or typed after a double click."""
        widgets = self._widgets()
        return self._remembered(name, float(value), lambda v: widgets.number(name, v))

    def combo(self, name: str, value: str, choices: Sequence[str]) -> str:
        """One of several texts."""
        widgets = self._widgets()
        return self._remembered(name, value, lambda v: widgets.combo(name, v, list(choices)))

    def text_field(self, name: str, value: str = "") -> str:
        """A line of text input."""
        widgets = self._widgets()
        return self._remembered(name, value, lambda v: widgets.text_field(name, v))

    def color(self, name: str, value: Iterable[float] = (1.0, 1.0, 1.0)) -> tuple[float, float, float]:
        """sRGB, 0 to 1."""
        widgets = self._widgets()
        red, green, blue = value
        return self._remembered(name, (float(red), float(green), float(blue)), lambda v: widgets.color(name, v))

    def plot(self, name: str, values: Iterable[float], range: tuple[float, float] | None = None) -> None:
        """A curve, with its last value beside the name. `range`: of the vertical axis, by default that of the
        values."""
        self._widgets().plot(name, np.asarray(values, np.float32).ravel().tolist(), range)

    def progress(self, fraction: float, text: str = "") -> None:
        """A bar, `fraction` of it filled (0 to 1)."""
        self._widgets().progress(fraction, text)


class WindowCallbacks:
    """The callbacks of a Viewer. They may use the viewer, except update(), show() and screenshot(), which draw the
    window."""

    _handle: "_easypbr.ViewerHandle"

    def _init_callbacks(self) -> None:
        self._before_draw: list[Callable[[], object]] = []
        self._after_draw: list[Callable[[], object]] = []
        self._told: dict[int, str] = {}  # tracebacks, by who raised them
        self._panels: dict[str, tuple[Callable[[Panel], object], Panel]] = {}
        self._handlers: list[tuple[Callable[[_easypbr.Event], object], str | None]] = []
        self._handler_number: int | None = None
        self._front_ends: weakref.WeakSet[Any] = weakref.WeakSet()  # Servers and widgets.

    @overload
    def add_panel(self, name: str, function: _Draws) -> _Draws: ...

    @overload
    def add_panel(self, name: str, function: None = None) -> Callable[[_Draws], _Draws]: ...

    def add_panel(self, name: str, function: Callable[[Panel], object] | None = None) -> Any:
        """Adds a panel to the window, drawn by function(ui) in each frame; see Panel. Exceptions are shown in the panel
        with their traceback, and the loop continues. Also as a decorator: @view.add_panel("Training"). Browser views and
        widgets show it too; they call the function on threads of their own, and share its values with the window."""
        if function is None:
            return lambda decorated: self.add_panel(name, decorated)
        if not callable(function):
            raise ArgumentError(f"add_panel: expected a function, got a {type(function).__name__}")
        self._panels[name] = (function, Panel())
        viewer = weakref.ref(self)  # The library must not keep alive who owns it.

        def draw(widgets: "_easypbr._Widgets") -> str | None:
            owner = viewer()
            return None if owner is None else owner._draw_panel(name, widgets)

        self._handle.add_panel(name, draw)
        for front_end in list(self._front_ends):
            self._serve_panel(front_end._panel_handle, name)
        return function

    def _serve_panels(self, front_end: Any) -> None:
        """Shows the panels in a server or a widget, now and from now on."""
        self._front_ends.add(front_end)
        for name in self._panels:
            self._serve_panel(front_end._panel_handle, name)

    def _serve_panel(self, handle: "_easypbr.ServerHandle | _easypbr.ChannelHandle", name: str) -> None:
        function, shown = self._panels[name]
        # Its own widgets, for it may be drawn while the window is; the same values.
        panel = Panel()
        panel._memory = shown._memory
        viewer = weakref.ref(self)

        def draw(widgets: "_easypbr._Widgets") -> str | None:
            owner = viewer()
            if owner is None:
                return None
            panel._handle = widgets
            try:
                return owner._call(function, panel, in_panel=True)[1]
            finally:
                panel._handle = None

        handle.add_panel(name, draw)

    def remove_panel(self, name: str) -> None:
        """Removes a panel that was added."""
        self._handle.remove_panel(name)
        del self._panels[name]
        for front_end in list(self._front_ends):
            front_end._panel_handle.remove_panel(name)

    def _draw_panel(self, name: str, widgets: "_easypbr._Widgets") -> str | None:
        function, panel = self._panels[name]
        panel._handle = widgets
        try:
            return self._call(function, panel, in_panel=True)[1]
        finally:
            panel._handle = None

    def before_draw(self, function: _Called) -> _Called:
        """Calls `function` in every update() before it draws. Exceptions are shown in the window with their traceback,
        and the loop continues. Also as a decorator."""
        self._before_draw.append(function)
        return function

    def after_draw(self, function: _Called) -> _Called:
        """Calls `function` in every update() after it has drawn. Also as a decorator."""
        self._after_draw.append(function)
        return function

    @overload
    def on_event(self, function: _Handles, kind: str | None = None) -> _Handles: ...

    @overload
    def on_event(self, function: None = None, kind: str | None = None) -> Callable[[_Handles], _Handles]: ...

    def on_event(self, function: "Callable[[_easypbr.Event], object] | None" = None, kind: str | None = None) -> Any:
        """Calls function(event) for events of mouse and keyboard, dropped files and resizing, except those consumed
        by panels; see Event. If it returns True the viewer ignores the event. `kind`: only events of this kind. Also
        as a decorator: @view.on_event(kind="key_down")."""
        if kind is not None and kind not in _KINDS:
            raise ArgumentError(f"on_event: expected a kind out of {', '.join(_KINDS)}, got {kind!r}")
        if function is None:
            return lambda decorated: self.on_event(decorated, kind)
        if not callable(function):
            raise ArgumentError(f"on_event: expected a function, got a {type(function).__name__}")
        self._handlers.append((function, kind))
        if self._handler_number is None:
            viewer = weakref.ref(self)

            def dispatch(event: "_easypbr.Event") -> bool:
                owner = viewer()
                return owner is not None and owner._dispatch(event)

            self._handler_number = self._handle.on_event(dispatch)
        return function

    def remove_callback(self, function: Callable[..., Any]) -> None:
        """Removes a callback of before_draw(), after_draw() and on_event()."""
        self._before_draw = [known for known in self._before_draw if known is not function]
        self._after_draw = [known for known in self._after_draw if known is not function]
        self._handlers = [(known, kind) for known, kind in self._handlers if known is not function]

    def notify(self, text: str, error: bool = False) -> None:
        """Shows a message in the window for a few seconds."""
        self._handle.notify(text, error)

    def _dispatch(self, event: "_easypbr.Event") -> bool:
        handled = False
        for function, kind in list(self._handlers):
            if kind is None or kind == event.kind:
                handled |= bool(self._call(function, event)[0])
        return handled

    def _run(self, functions: list[Any]) -> None:
        for function in list(functions):
            self._call(function)

    def _call(self, function: Callable[..., Any], *arguments: object, in_panel: bool = False) -> tuple[Any, str | None]:
        """Calls a user's function: its result, and the traceback of an exception, which is written to stderr and
        shown in the window, once, unless its panel shows it."""
        try:
            return function(*arguments), None
        except Exception as error:
            # From the user's own function on; how it was called says nothing.
            at = error.__traceback__ and error.__traceback__.tb_next
            failure = traceback.format_exception(type(error), error, at)
            text = "".join(failure).rstrip()
            if self._told.get(id(function)) != text:
                self._told[id(function)] = text
                print(text, file=sys.stderr)
                if not in_panel:
                    self._handle.notify(text, True)
            return None, text

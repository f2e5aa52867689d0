"""A viewer outside of its window: in browsers, as a file that is turned offline, in notebooks."""

import os
import weakref
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal, cast

from numpy.typing import ArrayLike

from . import _easypbr
from .arguments import samples_of
from .panels import WindowCallbacks
from .remote import Server
from .scene import Scene


class Sharing(WindowCallbacks):
    """The part of a Viewer that others look at."""

    scene: Scene

    def _init_sharing(self) -> None:
        # Of all cells. ipywidgets keeps it until it is closed; then it lets go of what it drew with.
        self._widget: weakref.ref[Any] | None = None

    def serve(
        self,
        port: int = 0,
        *,
        bind: str = "127.0.0.1",
        socket: str | os.PathLike[str] = "",
        token_file: str | os.PathLike[str] = "",
        host_names: Sequence[str] = (),
        origins: Sequence[str] = (),
        max_clients: int = 16,
        codec: str = "auto",
        own_views: int = 4,
        own_views_for_watchers: bool = False,
        files: str | os.PathLike[str] = "",
        block: bool = False,
    ) -> Server:
        """Shows the scene in browsers: print(view.serve().url). Returns at once, unless `block`: then when it is closed, by
        Ctrl-C too. `port`: 0 takes any that is free; `socket`: path of a Unix socket to use in its place; `bind`: others
        than loopback are seen by the network; `token_file`: secrets to use, a line to control, a line to watch;
        `host_names`: other names that the server is reached by; `origins`: pages of other sites that may connect;
        `codec`: what moving images are sent as, "h264" or "jpeg"; "auto" takes H.264 where FFmpeg's libraries and a
        client's browser have it; `own_views`: clients, 0 to 64, that may have a camera and settings of their own at a time;
        `own_views_for_watchers`: those who came by watch_url too; `files`: a folder beneath which who controls the view may
        have files opened. Raises FileError when it is not there."""
        handle = self._handle.serve(
            port, bind, socket, token_file, list(host_names), list(origins), max_clients, codec, own_views,
            own_views_for_watchers, files)
        server = Server(handle)
        self._serve_panels(server)
        if block:
            print(server.url, flush=True)
            server.wait()
        return server

    def save_html(
        self,
        path: str | os.PathLike[str],
        orbit: tuple[int, int] = (36, 3),
        *,
        row_step: float = 20.0,
        size: ArrayLike | None = None,
        samples: int | None = None,
        format: str = "webp",
        quality: int = 85,
        max_mb: float = 20.0,
        title: str = "",
    ) -> Path:
        """Writes images from all around as one HTML file that is turned by dragging, without a server. `orbit`: directions
        around the content (1 to 360) by elevations (1 to 60), `row_step` degrees apart, the camera's own among them. The images
        are "webp" or "jpeg" of at most this quality (1 to 100); where they do not fit into `max_mb` megabytes, their quality goes
        down to 40, then their size. `title`: by default the objects' names."""
        columns, rows = orbit
        return self._handle.save_html(path, (columns, rows), row_step, size, samples_of(samples), format, quality, max_mb, title)

    def save_svg(
        self,
        path: str | os.PathLike[str],
        *,
        hidden: Literal["none", "dashed", "solid"] = "dashed",
        size: ArrayLike | None = None,
    ) -> Path:
        """Writes the scene, as the camera sees it, as a line drawing: an SVG file with the contours, borders and creases of
        faces and the lines of what is drawn as lines. `hidden`: how lines are drawn that faces hide. settings.outline has
        width, colour, kinds of edges and the angle of creases."""
        return self._handle.save_svg(path, hidden, size)

    def widget(self, size: ArrayLike | None = None) -> Any:
        """A widget for notebooks (pip install easypbr[jupyter]): the view in a cell, turned with the mouse, over the kernel's
        own channel. It has a camera of its own, which begins as the view's; what the program changes in the scene and in the
        settings is seen in it. `size`: (width, height) in CSS pixels, 16 to 4096, by default that of the images, at most 800
        wide. Members: keep(), add_animations(name, animations), close()."""
        from .widget import size_for, widget_class

        view = cast(Any, self)  # A Viewer.
        return widget_class()(view, size_for(view, size))

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, Any] | None:
        """The widget, one for all cells, with the present image beside it; None: no notebook, or no support for widgets."""
        from .widget import can_show, note_shown, size_for, widget_class

        if not self.scene.names() or not can_show():
            return None
        widget = None if self._widget is None else self._widget()
        if widget is None or widget.comm is None:
            view = cast(Any, self)  # A Viewer.
            widget = widget_class()(view, size_for(view, None), holds=False)
            self._widget = weakref.ref(widget)
        else:
            widget.keep()
        note_shown(widget)
        bundle: dict[str, Any] = widget._repr_mimebundle_()
        return bundle

    def _repr_png_(self) -> bytes | None:
        if not self.scene.names():
            return None
        return _easypbr.encode_png(self._handle.render(None, None, "srgb8"))

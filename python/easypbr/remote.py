"""Server: a view in the browsers of other machines."""

import time
import weakref
from types import TracebackType

from . import _easypbr


class Server:
    """A served view; Viewer.serve() makes it. It answers and draws on threads of its own, so that the program goes on;
    what the program changes in the scene and in the view's settings is seen by all clients. Closes when it is dropped."""

    def __init__(self, handle: "_easypbr.ServerHandle") -> None:
        self._handle = handle
        # Threads within the library must not outlive the interpreter.
        weakref.finalize(self, handle.close)

    @property
    def _panel_handle(self) -> "_easypbr.ServerHandle":
        return self._handle

    @property
    def url(self) -> str:
        """What to open in a browser, with the secret that lets it control the view."""
        return self._handle.url

    @property
    def urls(self) -> list[str]:
        """`url`, and the same at each address of this machine when all are listened on (`bind="0.0.0.0"`)."""
        return self._handle.urls

    @property
    def watch_url(self) -> str:
        """What to open in a browser that may watch and change nothing."""
        return self._handle.watch_url

    @property
    def port(self) -> int:
        """The port that is listened on; 0 of a Unix socket."""
        return self._handle.port

    @property
    def clients(self) -> "list[_easypbr.ServerClient]":
        """Who looks."""
        return self._handle.clients()

    @property
    def is_open(self) -> bool:
        """Whether it answers; False after close()."""
        return self._handle.is_open

    def forward_command(self, host: str) -> str:
        """The ssh command that makes this server reachable on one's own machine; `host`: this machine's name there."""
        return self._handle.forward_command(host)

    def add_animations(self, name: str, animations: "_easypbr.Animations") -> None:
        """Lets clients play the animations of a file: server.add_animations("robot", load_scene(path).animations)."""
        self._handle.add_animations(name, animations)

    def wait(self) -> None:
        """Returns when the server is closed by another thread; Ctrl-C closes it."""
        try:
            while self.is_open:
                time.sleep(0.1)
        except KeyboardInterrupt:
            self.close()

    def close(self) -> None:
        """Says goodbye to all clients and frees the port."""
        self._handle.close()

    def __enter__(self) -> "Server":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def __repr__(self) -> str:
        # Without the secret: representations end up in logs and notebooks.
        return f"<Server: {self.url.partition('#')[0] if self.is_open else 'closed'}, {len(self.clients)} clients>"

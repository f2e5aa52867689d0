"""What stands between a browser and a server: a slow line, a reverse proxy."""

import asyncio
import contextlib
import shutil
import socket
import subprocess
import threading
import time
from collections.abc import Iterator
from pathlib import Path


class SlowLine:
    """A TCP proxy with limited bandwidth and latency: `megabits` per second and half of `round_trip_s` in each direction,
    first in, first out, as a router's queue. A context manager; it listens on `port` of the loopback interface."""

    def __init__(self, target: int, megabits: float, round_trip_s: float) -> None:
        self.target, self.bytes_a_second, self.delay_s = target, megabits * 1e6 / 8, round_trip_s / 2
        self.port = 0
        self._loop = asyncio.new_event_loop()
        self._ready = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self) -> "SlowLine":
        self._thread.start()
        self._ready.wait()
        return self

    def __exit__(self, *_: object) -> None:
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        server = self._loop.run_until_complete(asyncio.start_server(self._accept, "127.0.0.1", 0))
        self.port = server.sockets[0].getsockname()[1]
        self._ready.set()
        self._loop.run_forever()
        for task in asyncio.all_tasks(self._loop):
            task.cancel()
        self._loop.run_until_complete(asyncio.sleep(0.05))
        self._loop.close()

    async def _accept(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        there, away = await asyncio.open_connection("127.0.0.1", self.target)
        with contextlib.suppress(OSError, asyncio.CancelledError):
            await asyncio.gather(self._carry(reader, away), self._carry(there, writer))

    async def _carry(self, source: asyncio.StreamReader, sink: asyncio.StreamWriter) -> None:
        """Bytes leave one after another at the line's rate, and arrive later by the delay."""
        on_the_way: asyncio.Queue[tuple[float, bytes]] = asyncio.Queue(maxsize=64)

        async def deliver() -> None:
            while True:
                due, data = await on_the_way.get()
                await asyncio.sleep(max(0, due - time.monotonic()))
                if not data:
                    return sink.close()
                sink.write(data)

        delivery = asyncio.ensure_future(deliver())
        free = time.monotonic()
        while data := await source.read(1500):
            free = max(free, time.monotonic()) + len(data) / self.bytes_a_second
            # What is sent too early waits before the line, and so does who sends it.
            await asyncio.sleep(max(0, free - time.monotonic()))
            await on_the_way.put((free + self.delay_s, data))
        await on_the_way.put((0, b""))
        await delivery


NGINX = """
daemon off; worker_processes 1; pid {folder}/pid; error_log {folder}/error.log;
events {{ worker_connections 64; }}
http {{
    access_log off;
    client_body_temp_path {folder}/body; proxy_temp_path {folder}/proxy; fastcgi_temp_path {folder}/f;
    uwsgi_temp_path {folder}/u; scgi_temp_path {folder}/s;
    server {{
        listen 127.0.0.1:{port};
        location /views/helmet/ {{
            proxy_pass http://127.0.0.1:{target}/;
            proxy_http_version 1.1;
            proxy_set_header Host $http_host;
            proxy_set_header Upgrade $http_upgrade;
            proxy_set_header Connection "upgrade";
            proxy_read_timeout 1h;
            proxy_buffering off;
        }}
    }}
}}
"""


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@contextlib.contextmanager
def reverse_proxy(target: int, folder: Path) -> Iterator[str]:
    """An nginx that has the server below /views/helmet/. The page's address."""
    program = shutil.which("nginx") or shutil.which("nginx", path="/usr/sbin")
    assert program, "nginx is not installed (`scripts/setup.sh tests` installs it)"
    port = free_port()
    (folder / "nginx.conf").write_text(NGINX.format(folder=folder, port=port, target=target))
    process = subprocess.Popen([program, "-c", folder / "nginx.conf", "-p", folder, "-e", folder / "error.log"])
    try:
        for _ in range(200):
            with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), 1):
                break
            time.sleep(0.05)
        yield f"http://127.0.0.1:{port}/views/helmet/"
    finally:
        process.terminate()
        process.wait()

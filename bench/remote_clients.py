"""What clients of the browser view cost while nothing changes, and what connections leave behind.

usage: remote_clients.py [--clients N] [--seconds S] [--connects N]
"""
import argparse
import pathlib
import resource
import sys
import threading
import time

import easypbr

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "tests/remote"))
from client import Client  # noqa: E402


def cpu_seconds() -> float:
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def resident_mb() -> float:
    pages = int(pathlib.Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize() / 2**20


def main(clients: int, seconds: float, connects: int) -> None:
    scene = easypbr.Scene()
    scene.show(easypbr.shapes.teapot(), "teapot")
    view = easypbr.Viewer((1280, 720), {"image": {"samples": 4}}, scene=scene)
    with view.serve() as server:
        alone = [Client(server.url, (1280, 720)) for _ in range(clients)]
        for client in alone:
            client.until_exact()
        for client in alone:
            client.collect(0.5)
        frames = sum(len(client.frames) for client in alone)
        threads = [thread.name for thread in threading.enumerate()]
        begun = cpu_seconds()
        time.sleep(seconds)
        print(f"{clients} clients at rest: {100 * (cpu_seconds() - begun) / seconds:.2f} % of a core, theirs included "
              f"({len(threads)} threads of Python)")
        for client in alone:
            client.collect(0.05)
        print(f"pictures meanwhile: {sum(len(client.frames) for client in alone) - frames}")
        for client in alone:
            client.close()
        for _ in range(50):
            Client(server.url).close()
        before = resident_mb()
        for _ in range(connects):
            client = Client(server.url)
            client.until_told("welcome")
            client.close()
        print(f"{connects} connections: memory {before:.1f} -> {resident_mb():.1f} MB")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--clients", type=int, default=10)
    parser.add_argument("--seconds", type=float, default=20)
    parser.add_argument("--connects", type=int, default=1000)
    options = parser.parse_args()
    main(options.clients, options.seconds, options.connects)

"""Many clients: what they cost, and what they leave behind. The server is a process of its own, so that its memory and its
processor time are its own."""

import os
import statistics
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
import websockets

from client import Client

PROGRAM = """
import sys
import easypbr
scene = easypbr.Scene()
scene.show(easypbr.shapes.sphere(1, 24), "ball")
view = easypbr.Viewer((160, 120), {"image": {"samples": 4}}, scene=scene)
server = view.serve(max_clients=100)
print(server.url, server.watch_url, flush=True)
"""
WAITS = "sys.stdin.read()"
# A call by PyDLL keeps Python's lock, and a sleep takes no processor time from the drawing.
HOLDS = """
import ctypes
import threading
import time
library = ctypes.PyDLL(None)
reader = threading.Thread(target=sys.stdin.read)
reader.start()
while reader.is_alive():
    now = time.monotonic()
    left = 1 - now % 1
    library.usleep(int(1e6 * left)) if int(now) % 2 else time.sleep(left)
"""


class Process:
    def __init__(self, then=WAITS):
        # Images, which are larger, go back to the system when they are freed: what an allocator keeps of those of the drawing,
        # up to 36 MB, would be taken for the clients' memory.
        environment = {**os.environ, "MALLOC_MMAP_THRESHOLD_": "65536"}
        self.process = subprocess.Popen([sys.executable, "-c", PROGRAM + then], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        text=True, env=environment)
        self.url, self.watch_url = self.process.stdout.readline().split()
        self.folder = Path(f"/proc/{self.process.pid}")

    def cpu_s(self, thread=None):
        """Of the process, or of the threads of this name."""
        files = [self.folder / "stat"]
        if thread:
            files = [task / "stat" for task in (self.folder / "task").iterdir() if (task / "comm").read_text().strip() == thread]
            assert files, thread
        rows = [path.read_text().rsplit(")", 1)[1].split() for path in files]
        return sum(int(row[11]) + int(row[12]) for row in rows) / os.sysconf("SC_CLK_TCK")

    def memory(self):
        """Bytes that are its own."""
        rows = (self.folder / "smaps_rollup").read_text().splitlines()
        return 1024 * sum(int(row.split()[1]) for row in rows if row.startswith(("Private_Clean", "Private_Dirty")))

    def things(self):
        """Open files and threads."""
        return len(list((self.folder / "fd").iterdir())), len(list((self.folder / "task").iterdir()))


@pytest.fixture
def server():
    server = Process()
    yield server
    server.process.communicate()


def come_and_go(server, count):
    for number in range(count):
        client = Client(server.url, size=(64, 48))
        client.until_told("welcome")
        if number % 2:
            client.close()
        else:
            client.socket.socket.close()  # Without a goodbye.


def test_a_thousand_clients_leave_nothing_behind(server):
    come_and_go(server, 1000)  # The allocator's and the driver's caches fill, by how many are there at once.
    time.sleep(1)
    memory, (files, threads) = server.memory(), server.things()
    come_and_go(server, 1000)
    for _ in range(100):
        if server.things()[0] <= files:
            break
        time.sleep(0.1)
    now = server.things()
    assert now[0] <= files
    assert now[1] <= threads + 16  # The drawing's pool may begin some; none is a client's.
    assert server.memory() - memory <= 1 << 20


def test_an_idle_view_costs_next_to_nothing(server):
    clients = [Client(server.url) for _ in range(10)]
    for client in clients:
        client.until_exact()
    for client in clients:
        client.collect(0.2)
    frames = [len(client.frames) for client in clients]
    time.sleep(2)  # a view that has rested for 1 s tells less often what has changed
    shares = []
    for _ in range(3):
        used, begun = server.cpu_s(), time.monotonic()
        time.sleep(8)
        shares.append((server.cpu_s() - used) / (time.monotonic() - begun))
    for client in clients:
        client.collect(0.1)
    assert [len(client.frames) for client in clients] == frames
    # The least: what else runs on the machine makes the same work take up to three times the CPU time.
    assert min(shares) < 0.01, shares
    for client in clients:
        client.close()


class Watcher(threading.Thread):
    """Answers pictures until it is closed."""

    def __init__(self, url):
        super().__init__(daemon=True)
        self.client = Client(url)
        self.count = 0

    def run(self):
        try:
            while True:
                if (message := self.client.receive()) is not None and not isinstance(message, dict):
                    self.count += 1
                    self.client.frames.clear()
        except (websockets.exceptions.ConnectionClosed, TimeoutError):
            pass


def turn(controller, seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        controller.inputs += 1
        controller.send("turn", id=controller.inputs, right=1, up=0)
        controller.collect(0.03)


def test_fifty_watchers_cost_a_quarter_of_a_core_at_thirty_pictures(server):
    """By processor seconds of the network's thread for each picture that one of them gets: how many there are in a second
    depends on the machine and on the watchers, which are slower than a server."""
    controller = Client(server.url, size=(1280, 720))
    controller.until_exact()
    turn(controller, 4)  # What the still was drawn with is freed.

    def memory_of_turns():
        """The least: images come and go."""
        return min(turn(controller, 1.5) or server.memory() for _ in range(8))

    before = memory_of_turns()
    watchers = [Watcher(server.watch_url) for _ in range(50)]
    for watcher in watchers:
        watcher.start()
    turn(controller, 2)
    used = server.cpu_s("easypbr network")
    counted = sum(watcher.count for watcher in watchers)
    after = memory_of_turns()
    pictures = sum(watcher.count for watcher in watchers) - counted
    share = (server.cpu_s("easypbr network") - used) / pictures * 50 * 30
    each = (after - before) / 50
    print(f"{pictures} pictures, {share:.3f} of a core at 30 a second, {each / 1000:.0f} kB a watcher")
    assert min(watcher.count for watcher in watchers) > 10
    assert share <= 0.25
    assert each <= 256e3
    controller.close()
    for watcher in watchers:
        watcher.client.close()


def test_a_program_that_holds_python_s_lock_is_not_felt():
    """In every other second the program holds the lock all the time: inputs take as long as in the seconds between."""
    server = Process(HOLDS)
    client = Client(server.url, size=(640, 480))
    client.until_exact()
    taken = {0: [], 1: []}
    end = time.monotonic() + 18
    while time.monotonic() < end:
        client.inputs += 1
        begun = time.monotonic()
        client.send("turn", id=client.inputs, right=1, up=0)
        client.until(lambda message: not isinstance(message, dict) and message.input >= client.inputs)
        now = time.monotonic()
        if int(now) == int(begun):
            taken[int(now) % 2].append(now - begun)
        client.collect(0.01)
    client.close()
    server.process.communicate()
    free, held = (statistics.median(taken[phase]) for phase in (0, 1))
    print(f"{1000 * free:.1f} ms, with the lock held {1000 * held:.1f} ms, of {len(taken[0])} and {len(taken[1])}")
    assert min(map(len, taken.values())) > 20
    assert held <= 1.2 * free

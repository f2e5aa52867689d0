"""No thread of the library works while a program waits."""
import subprocess
import sys

PROGRAM = """
import os
import time

import easypbr
from easypbr import Scene, Viewer, shapes


def others():
    \"\"\"State and nanoseconds on a processor of every thread but this.\"\"\"
    threads = {}
    for thread in os.listdir("/proc/self/task"):
        if int(thread) == os.getpid():
            continue
        folder = f"/proc/self/task/{thread}/"
        try:
            with open(folder + "stat") as stat, open(folder + "schedstat") as schedule:
                threads[thread] = (stat.read().rpartition(")")[2].split()[0], int(schedule.read().split()[0]))
        except (FileNotFoundError, ProcessLookupError):
            pass  # It has ended.
    return threads


def assert_still(after):
    # Threads of a pool look for work some milliseconds before they sleep: they have a minute, also on a busy machine.
    deadline = time.monotonic() + 60
    while True:
        before = others()
        time.sleep(0.5)
        now = others()
        if before == now and all(state == "S" for state, _ in now.values()):
            print(f"after {after}: {len(now)} threads are still")
            return now
        assert time.monotonic() < deadline, f"after {after}: {before} became {now}"


scene = Scene()
scene.show(shapes.sphere(), "sphere")
view = Viewer((256, 192), {"image": {"samples": 1}}, scene, device="cpu")
view.render()
assert assert_still("a frame"), "the loops had no other thread"
view.settings.image.samples = 4
view.render()
assert_still("a path traced image")
view.layers(["depth"])
assert_still("layers")
"""


def test_threads_sleep_while_the_program_waits():
    done = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, timeout=300,
                          check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("threads are still") == 3

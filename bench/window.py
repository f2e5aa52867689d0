#!/usr/bin/env python3
"""Measures the window on a display without a screen: from the program's start to the first picture, frames a second while
the mouse drags, and the processor's part that an idle window takes.

usage: window.py FILE [WIDTHxHEIGHT]      needs Xvfb, openbox, xdotool, wmctrl; caches are warmed first
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests/window"))
from display import Display  # noqa: E402

PROGRAM = """
import subprocess, sys, time, easypbr
path, width, height = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
scene = easypbr.Scene()
scene.show(path, "model")
view = easypbr.Viewer((width, height), scene=scene)
while view._handle.gui_state()["frames"] < 1:
    view.update()
print("first", flush=True)
if len(sys.argv) > 4:
    state = view._handle.gui_state
    while state()["frames"] < state()["total"]:
        view.update()
    x, y = width // 2, height // 2
    moves = [word for i in range(150) for word in ("mousemove_relative", "--", "2", "1", "sleep", "0.02")]
    window = subprocess.run(["xdotool", "search", "--name", "EasyPBR"], capture_output=True, text=True).stdout.split()[-1]
    drag = subprocess.Popen(["xdotool", "mousemove", "--window", window, str(x), str(y), "mousedown", "1", *moves])
    while state()["pictures"] < 12:  # The resolution has found its level.
        view.update()
    pictures, start = state()["pictures"], time.monotonic()
    while drag.poll() is None:
        view.update()
    print("drag", (state()["pictures"] - pictures) / (time.monotonic() - start), *state()["drawn_size"], flush=True)
    subprocess.run(["xdotool", "mouseup", "1"])
    view.update()
    while state()["frames"] < state()["total"]:
        view.update()
    for _ in range(50):
        view.update()
    cpu, start = time.process_time(), time.monotonic()
    while time.monotonic() < start + 3:
        view.update()
    print("idle", (time.process_time() - cpu) / 3, flush=True)
"""


def main(path, size="1280x720"):
    width, height = size.split("x")
    with tempfile.TemporaryDirectory() as folder:
        display = Display(pathlib.Path(folder))
        environment = {**os.environ, "DISPLAY": display.name}
        command = [sys.executable, "-c", PROGRAM, path, width, height]
        first = []
        for _ in range(4):
            start = time.monotonic()
            with subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True) as process:
                process.stdout.readline()
                first.append(time.monotonic() - start)
        done = subprocess.run([*command, "measure"], env=environment, capture_output=True, text=True, check=True)
        print(f"start to first picture: {min(first[1:]):.2f} s")
        for line in done.stdout.splitlines()[1:]:
            name, value, *rest = line.split()
            print({"drag": f"dragging: {float(value):.1f} frames/s at {'x'.join(rest)}",
                   "idle": f"idle: {100 * float(value):.1f} % of a core"}[name])
        display.stop()


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])

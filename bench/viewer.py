#!/usr/bin/env python3
"""Measures the viewer against what it is asked to reach: what recording a turntable costs beside drawing it, the time from
the program's start to the first picture, frames a second while the mouse drags, and what an idle window takes.

usage: viewer.py FILE [WIDTHxHEIGHT]      needs build/bench_recording, Xvfb, openbox, xdotool, wmctrl and a quiet machine
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import window

ROOT = pathlib.Path(__file__).resolve().parents[1]
FRAMES = 120


def recording_cost(path: str, size: str) -> dict[str, float]:
    with tempfile.TemporaryDirectory() as folder:
        command = [ROOT / "build/bench_recording", path, str(FRAMES), size, f"{folder}/turntable.mp4"]
        return json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


def main(path: str, size: str = "1280x720") -> None:
    cost = recording_cost(path, size)
    print(
        f"turntable, {FRAMES} frames, {size}: {cost['draw_s']:.2f} s drawn, {cost['record_s']:.2f} s recorded, "
        f"{100 * cost['cost']:+.1f} % (asked: at most 15 %)"
    )
    print("asked of the window: first picture within 1.5 s, 10 frames/s while dragging, below 5 % of a core idle")
    window.main(path, size)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])

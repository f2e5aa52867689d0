#!/usr/bin/env python3
"""Memory that a path traced picture takes beside the program and its scene: a sphere on a ground that catches shadows, 4 samples.

usage: path_memory.py [WIDTHxHEIGHT]            default 1920x1080

With the denoiser oidn too where the package pyoidn is installed. Each picture is drawn by a process of its own; what one of
64x36 takes is subtracted.
"""
import importlib.util
import re
import subprocess
import sys
from pathlib import Path

from easypbr import Scene, Viewer, shapes

DENOISERS = ("off", "filter", *(["oidn"] if importlib.util.find_spec("pyoidn") else []))


def draw(width: int, height: int, denoise: str) -> None:
    """Prints the peak of the resident memory in MB."""
    scene = Scene()
    scene.show(shapes.sphere(1, 128), "sphere")
    Viewer((width, height), {"path": {"enabled": True, "denoise": denoise}}, scene).render(samples=4)
    # Of this program alone, where getrusage() would count what the shell or test that started it has taken.
    status = Path("/proc/self/status").read_text()
    print(int(re.search(r"VmHWM:\s*(\d+) kB", status)[1]) * 1024 / 1e6)


def peak_mb(width: int, height: int, denoise: str) -> float:
    command = [sys.executable, __file__, "draw", str(width), str(height), denoise]
    return float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def main() -> None:
    arguments = sys.argv[1:]
    if arguments[:1] == ["draw"]:
        draw(int(arguments[1]), int(arguments[2]), arguments[3])
        return
    width, height = (int(side) for side in (arguments or ["1920x1080"])[0].split("x"))
    for denoise in DENOISERS:
        beside = peak_mb(width, height, denoise) - peak_mb(64, 36, denoise)
        print(f"{width}x{height}, denoise {denoise}: {beside:.0f} MB beside the program and its scene")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""What the first steps cost: processor seconds and peak memory of programs that import the package and draw a teapot of 16,256 faces
at 640 x 480. Processor seconds, for they depend less than time on what else the machine does. Prints a table in Markdown.

usage: first_picture.py [ROUNDS]      default 3, of which the least counts; the easypbr package must be importable
"""

import os
import subprocess
import sys
import tempfile

DRAW = "import easypbr; easypbr.render(easypbr.shapes.teapot(), 'picture.png', size=(640, 480), {})"
PROGRAMS = {
    "`import numpy` alone": "import numpy",
    "`import easypbr`": "import easypbr",
    "a picture of one sample (rasterised)": DRAW.format("samples=1"),
    "a picture of 8 samples (path traced, the default)": DRAW.format("samples=8"),
    "a picture of 8 samples, rasterised": DRAW.format("samples=8, settings={'path.enabled': False}"),
    "the layers depth, normal and albedo": "import easypbr; s = easypbr.Scene(); s.show(easypbr.shapes.teapot(), 'pot'); "
                                           "easypbr.Viewer((640, 480), scene=s).layers(['depth', 'normal_world', 'albedo'])",
}  # fmt: skip


def cost(program: str, folder: str) -> tuple[float, float]:
    """Processor seconds and peak memory in MB."""
    child = subprocess.Popen([sys.executable, "-c", program], cwd=folder)
    _, status, used = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        sys.exit(f"{program}: exit code {child.returncode}")
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 3
    print("| | CPU s | memory |\n|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name, program in PROGRAMS.items():
            cost(program, folder)  # Caches are filled by the first.
            costs = [cost(program, folder) for _ in range(rounds)]
            print(f"| {name} | {min(c for c, _ in costs):.2f} | {min(m for _, m in costs):.0f} MB |", flush=True)


if __name__ == "__main__":
    main()

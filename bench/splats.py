#!/usr/bin/env python3
"""Frames of splats beside F3D 4, in turns in one run: seconds to load, milliseconds and CPU seconds of a frame, memory.

usage: splats.py F3D_PYTHON [SPLATS [FRAMES [ROUNDS [WIDTHxHEIGHT]]]]
F3D_PYTHON: the Python of a virtual environment with F3D: python3 -m venv f3d && f3d/bin/pip install f3d==4.0.0
The scene is that of make_splats.py, of degree 3. The middle one of the rounds is printed. Needs the easypbr package.
"""
import json
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

FOLDER = pathlib.Path(__file__).resolve().parent
COLUMNS = ("load_s", "first_s", "frame_ms", "cpu_s", "peak_mb")


def measure(path: str, frames: int, size: tuple[int, int], out: str | None) -> dict[str, float]:
    """As peer_f3d.py does it."""
    import numpy as np

    import easypbr

    start = time.perf_counter()
    mesh = easypbr.Mesh(path)
    loaded = time.perf_counter()
    view = easypbr.Viewer(size)
    easypbr.Scene.show(mesh, "splats")
    image = view.render(samples=1)
    first = time.perf_counter()
    target, up = np.median(mesh.V, axis=0), np.array([0.0, 1, 0])
    offset = view.camera.position - target
    up = up if offset[1] > 0 else -up
    times, cpu = [], time.process_time()
    for i in range(frames):
        begin = time.perf_counter()
        angle = np.radians(3 * (i + 1))
        turned = offset * np.cos(angle) + np.cross(up, offset) * np.sin(angle) + up * (up @ offset) * (1 - np.cos(angle))
        view.camera = (target + turned, target, up)
        image = view.render(samples=1)
        times.append(time.perf_counter() - begin)
    cpu = time.process_time() - cpu
    if out:
        easypbr.save_image(image, out)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return dict(zip(COLUMNS, (loaded - start, first - loaded, 1000 * statistics.median(times), cpu / frames, peak)))


def run(command: list[str]) -> dict[str, float]:
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()[-1])


def main(python: str, count: str = "1000000", frames: str = "10", rounds: str = "3", size: str = "1280x720") -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = f"{folder}/splats.ply"
        subprocess.run([sys.executable, FOLDER / "make_splats.py", count, path], check=True, stdout=subprocess.DEVNULL)
        found: dict[str, list[dict[str, float]]] = {"EasyPBR": [], "F3D": []}
        for _ in range(int(rounds)):
            found["EasyPBR"].append(run([sys.executable, __file__, "--measure", path, frames, size]))
            found["F3D"].append(run([python, str(FOLDER / "peer_f3d.py"), path, frames, size]))
    middle = {name: {key: statistics.median(r[key] for r in results) for key in COLUMNS} for name, results in found.items()}
    print(f"{count} splats, {size}, {frames} frames, the middle of {rounds} rounds")
    print(f"{'':<10}" + "".join(f"{key:>12}" for key in COLUMNS))
    for name, row in middle.items():
        print(f"{name:<10}" + "".join(f"{row[key]:12.2f}" for key in COLUMNS))
    print(f"{'ratio':<10}" + "".join(f"{middle['F3D'][key] / middle['EasyPBR'][key]:12.2f}" for key in COLUMNS))


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    if sys.argv[1] == "--measure":
        width, height = map(int, sys.argv[4].split("x"))
        print(json.dumps(measure(sys.argv[2], int(sys.argv[3]), (width, height), sys.argv[5] if len(sys.argv) > 5 else None)))
    else:
        main(*sys.argv[1:])

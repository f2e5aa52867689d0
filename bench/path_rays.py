#!/usr/bin/env python3
"""Rays that a path traced picture traces a second, and how many Embree alone would trace: it gets the same ones.

usage: path_rays.py MESH [WIDTHxHEIGHT] [SAMPLES]            default 1280x720, 8

A library that is loaded before Embree counts its calls and the time within, callbacks included. The second picture is measured: the
tree of rays is there by then. A segment is a ray to the nearest hit, or to a light.
"""
import ctypes
import os
import pathlib
import subprocess
import sys
import tempfile
import time

FOLDER = pathlib.Path(__file__).resolve().parent


def measure(counter: str, path: str, width: int, height: int, samples: int) -> None:
    from easypbr import Mesh, Scene, Viewer

    total = (ctypes.c_uint64 * 3)()
    count = ctypes.CDLL(counter).count_rays_total
    scene = Scene()
    scene.show(Mesh(path), "mesh")
    view = Viewer((width, height), {"path": {"enabled": True}}, scene)
    view.render(samples=1)
    count(total)
    before = list(total)
    start, cpu_start = time.perf_counter(), time.process_time()
    view.render(samples=samples)
    wall, cpu = time.perf_counter() - start, time.process_time() - cpu_start
    count(total)
    met, shadowed, nanoseconds = (now - then for now, then in zip(total, before))
    rays, within = met + shadowed, nanoseconds / 1e9
    print(f"{rays / 1e6:.1f} M segments, {met / 1e6:.1f} M to the nearest hit and {shadowed / 1e6:.1f} M to lights")
    print(f"{rays / wall / 1e6:.2f} M/s in {wall:.2f} s, {rays / cpu / 1e6:.2f} M for each CPU second")
    print(f"Embree alone: {rays / within / 1e6:.2f} M for each CPU second; the whole is {within / cpu:.0%} as quick")


def main() -> None:
    if sys.argv[1:2] == ["measure"]:
        measure(sys.argv[2], sys.argv[3], *map(int, sys.argv[4:]))
        return
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    path, size, samples = (sys.argv[1:] + ["1280x720", "8"][len(sys.argv) - 2:])[:3]
    with tempfile.TemporaryDirectory() as folder:
        counter = f"{folder}/count_rays.so"
        subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-o", counter, FOLDER / "count_rays.c", "-ldl"], check=True)
        command = [sys.executable, __file__, "measure", counter, path, *size.split("x"), samples]
        subprocess.run(command, check=True, env={**os.environ, "LD_PRELOAD": counter})


if __name__ == "__main__":
    main()

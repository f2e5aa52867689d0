#!/usr/bin/env python3
"""Memory of a program that shows new data under the same name again and again.

usage: cloud_updates.py [UPDATES] [POINTS]
Shows POINTS (100000) points UPDATES (10000) times as "cloud", each drawn, and prints how far the resident memory grows after
the first 500 updates. Ends with 1 when that is 20 MB or more.
"""
import gc
import pathlib
import sys

import numpy as np

import easypbr

LIMIT_MB = 20
#: Allocators, caches and the driver's compiled shaders settle first.
WARM_UP = 500


def resident_mb() -> float:
    pages = int(pathlib.Path("/proc/self/statm").read_text().split()[1])
    return pages * 4096 / 1e6


def main(updates: int = 10000, points: int = 100_000) -> int:
    generator = np.random.default_rng(1)
    base = generator.random((points, 3), np.float32)
    scene = easypbr.Scene()
    view = easypbr.Viewer((320, 240), {"image": {"samples": 1}}, scene=scene)
    start = 0.0
    for update in range(updates):
        # Other positions, colours and values each time: nothing of the last update can be used again.
        mesh = easypbr.Mesh(base + np.float32(update % 7))
        mesh.C = generator.random((points, 3), np.float32)
        mesh.add_scalar("time", base[:, 0] * update)
        scene.show(mesh, "cloud")
        view.screenshot((320, 240)) if update % 10 == 0 else view.render()
        if update == WARM_UP:
            gc.collect()
            start = resident_mb()
        if update % 1000 == 0:
            print(f"{update:6d} updates: {resident_mb():.0f} MB", file=sys.stderr, flush=True)
    gc.collect()
    grown = resident_mb() - start
    print(f"{updates} updates of {points} points: memory grew by {grown:.1f} MB (limit {LIMIT_MB})")
    return int(grown >= LIMIT_MB)


if __name__ == "__main__":
    if len(sys.argv) > 3 or not all(argument.isdigit() for argument in sys.argv[1:]):
        sys.exit(__doc__)
    sys.exit(main(*map(int, sys.argv[1:])))

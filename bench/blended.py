#!/usr/bin/env python3
"""Frames of blended points and surfels: milliseconds and CPU seconds of a frame.

usage: blended.py [VERTICES [ROUNDS [WIDTHxHEIGHT]]]
By default 100000 vertices on a ball, 3 rounds, 1280x720; the middle one of the rounds is printed. Needs the easypbr package.
"""
import statistics
import sys
import time

import numpy as np

import easypbr


def ball(kind: str, count: int) -> easypbr.Mesh:
    """Vertices at random places of a unit ball's surface, of an opacity of 0.4."""
    random = np.random.default_rng(1)
    normals = random.normal(size=(count, 3)).astype(np.float32)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    mesh = easypbr.Mesh(normals)
    mesh.C = np.concatenate([(normals + 1) / 2, np.full((count, 1), 0.4)], axis=1).astype(np.float32)
    if kind != "points":
        mesh.N = normals
    mesh.style.mode = "surfels" if kind == "surfels" else "points"
    return mesh


def view_of(kind: str, count: int, size: tuple[int, int]) -> easypbr.Viewer:
    scene = easypbr.Scene()
    scene.show(ball(kind, count), "ball")
    view = easypbr.Viewer(size, scene=scene)
    view.render(samples=1)
    return view


def seconds_of_a_frame(view: easypbr.Viewer) -> tuple[float, float]:
    """On the clock, and of the process."""
    start, cpu = time.perf_counter(), time.process_time()
    view.render(samples=1)
    return time.perf_counter() - start, time.process_time() - cpu


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 100000
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 3
    width, height = (int(n) for n in (sys.argv[3] if len(sys.argv) > 3 else "1280x720").split("x"))
    print(f"{'':22}{'ms':>8}{'CPU s':>8}")
    for kind in ("points", "points with normals", "surfels"):
        view = view_of(kind, count, (width, height))
        times = [seconds_of_a_frame(view) for _ in range(rounds)]
        wall, cpu = (statistics.median(values) for values in zip(*times))
        print(f"{kind:22}{1000 * wall:8.0f}{cpu:8.2f}")


if __name__ == "__main__":
    main()

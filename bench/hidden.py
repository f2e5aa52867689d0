#!/usr/bin/env python3
"""What hidden surfaces cost: milliseconds of a frame of what is seen alone, and of the same before much that is hidden.
`layers`: grids of 1 M faces one behind another, as one mesh. `parts`: a wall, and 1200 balls behind it, as objects.

usage: hidden.py [ROUNDS [WIDTHxHEIGHT]]      needs the easypbr package; without a GPU
By default 15 rounds, 1280x720; the middle one of the rounds is printed.
"""
import statistics
import sys
import time

import numpy as np

import easypbr
import easypbr.shapes


def layers(count: int) -> easypbr.Scene:
    """Wavy grids of 708 x 708 quads, the nearest one last in the list of faces."""
    n = 709
    x, y = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n))
    corner = np.arange(n * n).reshape(n, n)
    a, b, c, d = (part.ravel() for part in (corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]))
    quads = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]).reshape(2, -1, 3)
    faces = quads.transpose(1, 0, 2).reshape(-1, 3)
    wave = 0.03 * np.sin(12 * x) * np.cos(12 * y)
    scene = easypbr.Scene()
    meshes = [np.stack([x, y, wave - 0.2 * i], -1).reshape(-1, 3) for i in reversed(range(count))]
    offsets = [faces + i * n * n for i in range(count)]
    scene.show(easypbr.Mesh(np.concatenate(meshes).astype(np.float32), np.concatenate(offsets).astype(np.int32)), "layers")
    return scene


def parts(count: int) -> easypbr.Scene:
    """Balls of 4800 faces behind a wall."""
    random = np.random.default_rng(1)
    wall = easypbr.Mesh(
        np.array([[-1, -1, 0.3], [1, -1, 0.3], [1, 1, 0.3], [-1, 1, 0.3]], np.float32), np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    )
    scene = easypbr.Scene()
    scene.show(wall, "wall")
    ball = easypbr.shapes.sphere(0.05, 50)
    for i in range(count):
        place = random.uniform(-0.8, 0.8, 3) * [1, 1, 0.2] - [0, 0, 0.4]
        scene.show(easypbr.Mesh((ball.V + place).astype(np.float32), ball.F), f"ball {i}")
    return scene


def view_of(scene: easypbr.Scene, size: tuple[int, int]) -> easypbr.Viewer:
    view = easypbr.Viewer(size, scene=scene)
    view.camera = ((0, 0, 3.4), (0, 0, 0), (0, 1, 0))
    for _ in range(3):
        view.render(samples=1)
        time.sleep(1)  # clusters are made in the background
    return view


def milliseconds(view: easypbr.Viewer, turn: int) -> float:
    view.camera = ((0.01 * (turn % 7), 0, 3.4), (0, 0, 0), (0, 1, 0))
    start = time.perf_counter()
    view.render(samples=1)
    return 1000 * (time.perf_counter() - start)


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 15
    width, height = (int(n) for n in (sys.argv[2] if len(sys.argv) > 2 else "1280x720").split("x"))
    for name, make, counts in (("layers", layers, (1, 8)), ("parts", parts, (1, 1200))):
        views = [view_of(make(count), (width, height)) for count in counts]
        times = [[milliseconds(view, turn) for view in views] for turn in range(rounds)]
        alone, all_of_them = (statistics.median(values) for values in zip(*times))
        print(f"{name:8}{counts[0]:6} {alone:7.1f} ms{counts[1]:8} {all_of_them:7.1f} ms   {all_of_them / alone:.2f} x")


if __name__ == "__main__":
    main()

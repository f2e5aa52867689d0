#!/usr/bin/env python3
"""Time and memory of a picture so large that it is drawn in tiles: a torus and a sphere with the default effects.

usage: large_picture.py [WIDTHxHEIGHT]          default 16384x9216
"""
import resource
import sys
import time

from easypbr import Scene, Viewer, shapes


def main() -> None:
    width, height = (int(side) for side in (sys.argv[1:] or ["16384x9216"])[0].split("x"))
    scene = Scene()
    scene.show(shapes.torus(1.0, 0.35, 512, 256), "torus")
    scene.show(shapes.sphere(0.5, 256), "sphere")
    view = Viewer((width, height), scene=scene)
    start = time.perf_counter()
    picture = view.render(samples=1)
    seconds = time.perf_counter() - start
    if picture.shape != (height, width, 4):
        sys.exit(f"expected a picture of {width}x{height}, got {picture.shape}")
    gigabytes = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    print(f"{width}x{height}, one sample: {seconds:.0f} s, {gigabytes:.1f} GiB at most")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Milliseconds per image of a script for pyrender, with pyrender and with easypbr.compat.pyrender, in turns.

usage: bench/compat_pyrender.py PYTHON FILE [FILE ...]      PYTHON: an interpreter that has pyrender
(python3 -m venv PEER && PEER/bin/pip install pyrender "numpy<2")

The camera turns around the mesh: colour and depth, 640 x 480, a directional light, without and with its shadows. Medians of
the rounds, and how many times as fast ours is.
"""
import argparse
import os
import statistics
import subprocess
import sys

SCRIPT = """
import sys, time
import numpy as np
import trimesh
if sys.argv[1] == "ours":
    import easypbr.compat.pyrender as pyrender
else:
    import pyrender
loaded = trimesh.load(sys.argv[2])
if isinstance(loaded, trimesh.Scene):
    scene = pyrender.Scene.from_trimesh_scene(loaded)
else:
    scene = pyrender.Scene()
    scene.add(pyrender.Mesh.from_trimesh(loaded))
def pose(turn):
    c, s = np.cos(turn), np.sin(turn)
    pose = np.array([[c, 0, s, 0], [0, 1, 0, 0], [-s, 0, c, 0], [0, 0, 0, 1.0]])
    pose[:3, 3] = centre + pose[:3, 2] * 1.5 * scale
    return pose
centre, scale = scene.centroid, scene.scale
camera = scene.add(pyrender.PerspectiveCamera(np.pi / 3, znear=0.01 * scale, zfar=10 * scale), pose=pose(0))
scene.add(pyrender.DirectionalLight(intensity=3), pose=pose(0))
renderer = pyrender.OffscreenRenderer(640, 480)
for flags in (pyrender.RenderFlags.NONE, pyrender.RenderFlags.SHADOWS_DIRECTIONAL):
    renderer.render(scene, flags)
    times = []
    for step in range(20):
        scene.set_pose(camera, pose(0.3 * step))
        start = time.perf_counter()
        renderer.render(scene, flags)
        times.append(time.perf_counter() - start)
    print(sorted(times)[len(times) // 2] * 1000)
"""


def medians(python: str, which: str, file: str) -> list[float]:
    environment = {**os.environ, "PYOPENGL_PLATFORM": "egl"}
    done = subprocess.run([python, "-c", SCRIPT, which, file], env=environment, capture_output=True, text=True, check=True)
    return [float(line) for line in done.stdout.split()[-2:]]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("python")
    parser.add_argument("files", nargs="+")
    parser.add_argument("--rounds", type=int, default=3)
    arguments = parser.parse_args()
    for file in arguments.files:
        rounds = [(medians(sys.executable, "ours", file), medians(arguments.python, "theirs", file)) for _ in range(arguments.rounds)]
        for at, name in enumerate(("without shadows", "with shadows")):
            ours, theirs = (statistics.median(each[which][at] for each in rounds) for which in (0, 1))
            print(f"{os.path.basename(file)}, {name}: {ours:.1f} ms, pyrender {theirs:.1f} ms, {theirs / ours:.2f} times as fast", flush=True)


if __name__ == "__main__":
    main()

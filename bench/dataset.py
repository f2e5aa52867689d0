#!/usr/bin/env python3
"""Images per second of ground truth, end to end with PNG files, beside pyrender's colour and depth of the same scene.

usage: bench/dataset.py [--count N] [--pyrender PYTHON] [--workers local|ray]   PYTHON: an interpreter that has pyrender
(python3 -m venv PEER && PEER/bin/pip install pyrender "numpy<2")

Ten balls of 20,000 faces, 640 x 480, one sample: colour, depth, normals, instance ids, boxes; pyrender draws colour and
depth and writes nothing. With --workers instead: the built-in drones by one and by two workers of one core each, from a
worker's first frame to the last frame of all.
"""
import argparse
import concurrent.futures
import pathlib
import subprocess
import tempfile
import time

import numpy as np

from easypbr import Camera, Scene, Viewer, _easypbr, shapes
from easypbr.dataset import DatasetSpec, generate
from easypbr.dataset.folder import keep_memory

PEER = """
import os, sys, time
os.environ["PYOPENGL_PLATFORM"] = "egl"
import numpy as np, pyrender
data = np.load(sys.argv[1])
scene = pyrender.Scene(ambient_light=[0.3] * 3)
mesh = pyrender.Mesh([pyrender.Primitive(positions=data["V"], normals=data["N"], indices=data["F"])])
nodes = [scene.add(mesh, pose=pose) for pose in data["poses"][0]]
scene.add(pyrender.IntrinsicsCamera(600, 600, 320, 240), pose=np.eye(4))
scene.add(pyrender.DirectionalLight(intensity=3), pose=np.eye(4))
renderer = pyrender.OffscreenRenderer(640, 480)
renderer.render(scene)
start = time.time()
for poses in data["poses"]:
    for node, pose in zip(nodes, poses):
        scene.set_pose(node, pose)
    renderer.render(scene)
print(len(data["poses"]) / (time.time() - start))
"""


def rate(engine: str, workers: int, count: int) -> float:
    """Images per second without the time that workers take to start."""
    spec = DatasetSpec.demo()
    spec.count, spec.image.samples, spec.background.skies = count, 1, 1
    with tempfile.TemporaryDirectory() as folder:
        generate(spec, folder, workers, engine=engine, threads=1)
        ends = sorted(path.stat().st_mtime for path in pathlib.Path(folder, "records").iterdir())
    # The first frame of each worker holds the making of its context and sky.
    return (len(ends) - workers) / (ends[-1] - ends[workers - 1])


def write(files: pathlib.Path, frame: int, data: dict) -> None:
    depth = np.minimum(np.rint(data["depth"] * 1000), 65535).astype(np.uint16)
    normals = np.rint(127.5 * (data["normal_camera"] + 1)).astype(np.uint8)
    pictures = {"rgb": data["color"][..., :3], "depth": depth, "normal": normals, "id": data["instance_id"].astype(np.uint16)}
    for name, picture in pictures.items():
        (files / f"{frame}_{name}.png").write_bytes(_easypbr.encode_png(picture, deep=True))
    (files / f"{frame}.txt").write_text(str([instance.box_visible for instance in data["instances"]]))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=24)
    parser.add_argument("--pyrender")
    parser.add_argument("--workers", choices=("local", "ray"))
    arguments = parser.parse_args()
    if arguments.workers:
        one, two = (rate(arguments.workers, workers, arguments.count) for workers in (1, 2))
        print(f"{arguments.workers}: one worker {one:.2f}, two {two:.2f} images/s: {two / one:.2f} times as many")
        return
    keep_memory()  # as the workers of `easypbr dataset` do
    random = np.random.default_rng(0)
    ball = shapes.sphere(0.3, 144)
    poses = np.tile(np.eye(4), (arguments.count, 10, 1, 1))
    poses[..., :3, 3] = random.uniform((-1.2, -0.9, -5), (1.2, 0.9, -3), (arguments.count, 10, 3))
    scene = Scene()
    balls = [ball.clone() for _ in range(10)]
    for i, mesh in enumerate(balls):
        mesh.material.base_color = tuple(random.uniform(0.1, 0.9, 3))
        scene.show(mesh, str(i))
    view = Viewer((640, 480), scene=scene)
    view.settings.image.samples = 1
    K = np.array([[600, 0, 319.5], [0, 600, 239.5], [0, 0, 1.0]])
    view.camera = Camera.from_opencv(K, np.diag([1, -1, -1, 1.0]), (640, 480))
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(1) as writer:
        files = pathlib.Path(folder)
        written = writer.submit(time.time)
        for frame in range(-2, arguments.count):
            if frame == 0:
                written.result()
                start, used = time.time(), time.process_time()
            for mesh, pose in zip(balls, poses[frame]):
                mesh.T_parent_mesh = pose
            data = view.render_layers(["color", "depth", "normal_camera", "instance_id", "instances"])
            written.result()  # as the data sets' own loop does: a frame is written while the next one is drawn
            written = writer.submit(write, files, frame, data)
        written.result()
        ours = arguments.count / (time.time() - start)
        busy = 1000 * (time.process_time() - used) / arguments.count
        print(f"{len(ball.F)} faces each; ours, everything on disk: {ours:.1f} images/s, {busy:.0f} ms of processors each")
        if arguments.pyrender:
            np.savez(files / "scene.npz", V=ball.V, N=ball.N, F=ball.F, poses=poses)
            done = subprocess.run([arguments.pyrender, "-c", PEER, files / "scene.npz"], capture_output=True, text=True, check=True)
            peer = float(done.stdout)
            print(f"pyrender, colour and depth in memory: {peer:.1f} images/s; ours is {ours / peer:.2f} times as fast")


if __name__ == "__main__":
    main()

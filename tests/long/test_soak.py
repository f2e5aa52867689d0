"""What leaks shows only after long: memory, open files and threads over many frames and many viewers, and recorders that are
killed. `make check-long` runs these.

EASYPBR_LONG_SOAK (1) is the part of the whole that is run: 100,000 frames by the CPU and 10,000 by OpenGL, 2,000 viewers,
1000 kills of a recorder.
"""

import gc
import os
import pathlib
import random
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import easypbr
from easypbr import Mesh, Scene, Viewer, shapes

PART = float(os.environ.get("EASYPBR_LONG_SOAK", "1"))
#: What may be added to the memory after the first tenth, MB.
LIMIT_MB = 20


def scaled(count: int, least: int = 20) -> int:
    return max(least, round(count * PART))


class Usage:
    """What the process holds."""

    def __init__(self):
        gc.collect()
        self.memory_mb = int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6
        self.files = len(os.listdir("/proc/self/fd"))
        self.threads = len(os.listdir("/proc/self/task"))


def soak(count: int, step, what: str) -> None:
    """Calls step(i); memory, files and threads are looked at a hundred times after the first tenth."""
    begin = time.process_time()
    first = None
    most_mb = 0.0
    for i in range(count):
        step(i)
        if i == count // 10:
            first = Usage()
        elif first and i % max(1, count // 100) == 0 or i == count - 1:
            now = Usage()
            most_mb = max(most_mb, now.memory_mb)
            assert (now.files, now.threads) == (first.files, first.threads), f"after {i} {what}"
    print(f"{count} {what}: {first.memory_mb:.1f} MB, {first.files} files, {first.threads} threads after the first tenth; "
          f"at most {most_mb:.1f} MB since; {time.process_time() - begin:.0f} CPU s")
    assert most_mb - first.memory_mb < LIMIT_MB


@pytest.mark.parametrize("device, count", [("cpu", 100_000), ("gl", 10_000)])
def test_frames_of_a_scene_that_changes(device, count):
    scene = Scene()
    view = Viewer((48, 36), {"image.samples": 1}, scene=scene, device=device)
    random_numbers = np.random.default_rng(1)
    sphere = shapes.sphere(1.0, 12)
    scene.show(sphere, "sphere")
    meshes = [shapes.box(), shapes.cone(), shapes.torus(segments=12, tube_segments=6)]

    def step(i):
        # Something else in each frame; what was made for the last one cannot be used again.
        mesh = Mesh(random_numbers.random((50, 3)).astype(np.float32))
        mesh.C = random_numbers.random((50, 3)).astype(np.float32)
        scene.show(mesh, "cloud")
        sphere.material.base_color = tuple(random_numbers.random(3))
        if i % 3 == 0:
            scene.show(meshes[i // 3 % 3], f"shape {i // 3 % 2}")
        if i % 7 == 0:
            view.add_light("lamp", position=tuple(random_numbers.normal(size=3) * 3), intensity=2)
        if i % 11 == 0:
            view.settings.ssao.enabled = i % 2 == 0
            view.settings.background.color = tuple(random_numbers.random(3))
        if i % 97 == 0:
            view.settings.image.size = (48, 36) if i % 2 else (64, 48)
        picture = view.render()
        assert picture.shape[2] == 4

    # Fewer do not make all variants of the shaders in their first tenth.
    soak(scaled(count, 1000), step, f"frames by {device}")


@pytest.mark.parametrize("device", ["cpu", "gl"])
def test_viewers_that_are_made_and_dropped(device):
    mesh = shapes.sphere(1.0, 12)

    def step(i):
        scene = Scene()
        scene.show(mesh, "sphere")
        view = Viewer((32, 24), {"image.samples": 1}, scene=scene, device=device)
        view.render()
        if i % 10 == 0:
            view.screenshot((64, 48))

    soak(scaled(2000 if device == "cpu" else 500), step, f"viewers by {device}")


RECORDING = """
import sys, easypbr
scene = easypbr.Scene()
scene.show(easypbr.shapes.box(), "box")
view = easypbr.Viewer((64, 48), {"image.samples": 1}, scene=scene)
view.recorder.start(sys.argv[1], fps=25)
print("begun", flush=True)
for frame in range(300):
    view.recorder.add_frame()
    print(frame, flush=True)
"""


def frames_of(path: pathlib.Path) -> int:
    """How many frames a player finds without a complaint."""
    command = ["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames", "-of", "csv=p=0", path]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    return int(done.stdout) if done.returncode == 0 and done.stdout.strip().isdigit() else 0


@pytest.mark.parametrize("name, kills", [("frame_%04d.png", 500), ("out.mp4", 500)])
def test_a_recorder_that_is_killed(tmp_path, name, kills):
    """Pictures are whole, without gaps; of a video what docs/animation.md promises is there."""
    number = random.Random(1)
    frames = 0
    for kill in range(scaled(kills)):
        folder = tmp_path / str(kill)
        folder.mkdir()
        process = subprocess.Popen([sys.executable, "-c", RECORDING, folder / name], stdout=subprocess.PIPE, text=True)
        assert process.stdout.readline() == "begun\n"
        try:
            process.wait(number.uniform(0, 0.5))
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGKILL)
        told = [int(line) for line in process.communicate()[0].splitlines()]
        if name.endswith(".png"):
            pictures = sorted(folder.glob("frame_*.png"))
            assert [path.name for path in pictures] == [f"frame_{i:04d}.png" for i in range(len(pictures))]
            for path in pictures:
                assert easypbr.load_image(path).shape[:2] == (48, 64)
            frames += len(pictures)
        else:
            # What a fragment or two holds, and what is on its way, may be missing.
            found = frames_of(folder / name) if (folder / name).exists() else 0
            assert found <= len(told) + 1
            frames += found
    print(f"{scaled(kills)} kills, {frames} frames of {name} read back")
    assert frames > 0

#!/usr/bin/env python3
"""Steps of gpu_check.sh that draw. Exit status 77: left out, the last line says why.

usage: gpu_steps.py golden|cuda|recording|frames|tests_python|textures|splats|bench FOLDER [SIZE]
SIZE: pixels along the texture's side, by default 4096; the video's or frames' width, by default 320; millions of the
bench's faces, by default 1; thousands of splats, by default 20.
"""
import concurrent.futures
import json
import os
import pathlib
import shutil
import subprocess
import sys
import time

import numpy as np

import easypbr
from easypbr import Scene, Viewer, shapes

ROOT = pathlib.Path(__file__).resolve().parents[1]
LEFT_OUT = 77
FRAMES = 30


def golden(folder: pathlib.Path, _: int) -> int:
    """Each golden scene beside the committed picture; both in one image."""
    sys.path.insert(0, str(ROOT / "tests/golden"))
    from effects import EFFECTS
    from test_golden import agrees, difference

    failed = 0
    for name, draw in EFFECTS.items():
        picture, wanted = draw(), easypbr.load_image(ROOT / f"tests/golden/pictures/{name}.png")
        mean, part = difference(picture, wanted)
        fine = agrees(picture, wanted)
        print(f"{name:30} mean {mean:.4f}, above 8: {100 * part:.3f} %{'' if fine else '  disagrees'}")
        easypbr.save_image(np.concatenate([picture, wanted], axis=1), folder / f"golden_{name}.png")
        failed += not fine
    return 1 if failed else 0


def cuda(folder: pathlib.Path, _: int) -> int:
    """Layers as tensors on the device equal those that numpy gets, and what each way takes."""
    try:
        import torch
    except ImportError:
        print("PyTorch is not installed")
        return LEFT_OUT
    if not torch.cuda.is_available():
        print("PyTorch sees no CUDA device")
        return LEFT_OUT
    scene = Scene()
    scene.show(shapes.sphere(1.0, 256))
    view = Viewer((1920, 1080), scene=scene)
    names = ["color", "depth", "normal_camera", "position", "instance_id"]
    found = {}
    for device in ("cpu", "cuda"):
        seconds = []
        for _ in range(10):
            start = time.perf_counter()
            found[device] = view.render_layers(names, samples=1, as_="torch", device=device)
            torch.cuda.synchronize()
            seconds.append(time.perf_counter() - start)
        print(f"{device}: {1000 * min(seconds):.2f} ms for {', '.join(names)} of 1920 x 1080")
    fine = True
    for name in names:
        apart = (found["cuda"][name].cpu().double() - found["cpu"][name].double()).abs()
        part = (apart > 1e-3).double().mean().item()
        print(f"{name}: {100 * part:.4f} % of the values are more than 1e-3 apart, at most {apart.max().item():.6f}")
        # The rasteriser's depths have its rounding, which is more where a surface is seen from its side.
        fine &= part < 1e-3
    return 0 if fine else 1


def recording(folder: pathlib.Path, width: int) -> int:
    """A video of a torus by NVENC and by the CPU's encoder; fails where NVENC is there and does not work."""
    width = width or 320
    has_gpu = shutil.which("nvidia-smi") is not None
    failed = 0
    for codec, name in (("", "the default encoder"), ("h264_nvenc", "NVENC")):
        scene = Scene()
        scene.show(shapes.torus(0.7, 0.3))
        view = Viewer((width, width * 9 // 16), scene=scene)
        start = time.perf_counter()
        try:
            with view.recorder.start(folder / f"video_{codec or 'default'}.mp4", fps=30, samples=1, codec=codec):
                for _ in range(FRAMES):
                    view.recorder.add_frame()
        except easypbr.Error as error:
            print(f"{name}: {error}")
            failed += has_gpu or not codec
            continue
        print(f"{name}: {FRAMES} frames, {width} pixels wide, in {time.perf_counter() - start:.2f} s")
    return 1 if failed else 0


def frames(_folder: pathlib.Path, size: int) -> int:
    """Frames of a moving camera as numpy arrays, by OpenGL and by the CPU: what programs see of both."""
    size = size or 320
    scene = Scene()
    scene.show(shapes.sphere(1.0, 640))
    for device in ("gl", "cpu"):
        view = Viewer((size, size * 9 // 16), scene=scene, device=device)
        for name, settings in (("frames", {}), ("without shadows", {"shadows.enabled": False})):
            for key, value in settings.items():
                view.settings[key] = value
            view.render(samples=1)
            seconds = []
            for _ in range(FRAMES):
                view.settings["camera.azimuth_deg"] = view.settings["camera.azimuth_deg"] + 1
                start = time.perf_counter()
                view.render(samples=1)
                seconds.append(time.perf_counter() - start)
            print(f"{device}, {name}: {1000 * sorted(seconds)[FRAMES // 2]:.2f} ms, {size} pixels wide")
    return 0


def tests_python(folder: pathlib.Path, _: int) -> int:
    """The tests of the Python package, each file in a process of its own, which has its own context."""

    def run(path: pathlib.Path) -> tuple[str, bool, list[str]]:
        command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", path]
        with open(folder / f"{path.stem}.txt", "w+") as log:
            try:
                status = subprocess.run(command, stdout=log, stderr=subprocess.STDOUT, timeout=150, check=False).returncode
            except subprocess.TimeoutExpired:
                return path.stem, False, ["more than 150 s"]
            log.seek(0)
            return path.stem, status == 0, [line.rstrip() for line in log if line.startswith(("FAILED", "ERROR"))]

    with concurrent.futures.ThreadPoolExecutor() as pool:
        done = list(pool.map(run, sorted((ROOT / "tests/python").glob("test_*.py"))))
    for name, passed, lines in done:
        if not passed:
            print(name, *lines, sep="\n  ")
    print(f"{sum(passed for _, passed, _ in done)} of {len(done)} files pass")
    return 0 if all(passed for _, passed, _ in done) else 1


def textures(folder: pathlib.Path, size: int) -> int:
    """A texture of 16384 x 16384 pixels with alpha is 1 GiB: its two halves must be seen where they are."""
    size = size or 4096
    image = np.full((size, size, 4), 255, np.uint8)
    image[:, : size // 2, 1:3] = 0  # red on the left
    image[:, size // 2 :, :2] = 0  # blue on the right
    scene = Scene()
    plane = shapes.image_plane(image, width=2)
    scene.show(plane)
    settings = {"camera.position": (0, 0, 3), "camera.target": (0, 0, 0), "camera.up": "+y", "ground.mode": "none"}
    start = time.perf_counter()
    picture = Viewer((256, 256), settings, scene=scene).render(samples=1)
    print(f"{image.nbytes / 2**30:.3f} GiB drawn within {time.perf_counter() - start:.2f} s")
    easypbr.save_image(picture, folder / "texture.png")
    left, right = picture[128, 96].astype(int), picture[128, 160].astype(int)
    fine = left[0] > left[2] + 50 and right[2] > right[0] + 50
    print("red and blue are seen" if fine else f"wrong colours: {left} and {right}")
    return 0 if fine else 1


def splats(folder: pathlib.Path, thousands: int) -> int:
    """Frames of a scene of splats of degree 3; the CPU's picture of it must be the same."""
    sys.path.insert(0, str(ROOT / "bench"))
    from make_splats import scene as splats_of

    scene = Scene()
    scene.show(splats_of((thousands or 20) * 1000))
    size = (1920, 1080) if thousands else (480, 270)
    pictures = {}
    for device in ("gl", "cpu"):
        if device == "cpu":
            os.environ.pop("EASYPBR_NATIVE", None)
        view = Viewer(size, scene=scene, device=device)
        pictures[device] = view.render(samples=1)
        start = time.perf_counter()
        for _ in range(FRAMES if thousands and device == "gl" else 2):
            view.settings["camera.azimuth_deg"] = view.settings["camera.azimuth_deg"] + 1
            view.render(samples=1)
        seconds = (time.perf_counter() - start) / (FRAMES if thousands and device == "gl" else 2)
        print(f"{device}: {1000 * seconds:.1f} ms a frame of {size[0]} x {size[1]}, read to numpy")
    easypbr.save_image(pictures["gl"], folder / "splats.png")
    # Harmonics are 16-bit floats on a GPU, and splats of the same depth in another order: tests/render/splat_driver_test.cpp.
    apart = (np.abs(pictures["gl"].astype(int) - pictures["cpu"]).max(axis=2) > 2).mean()
    print(f"{100 * apart:.3f} % of the pixels are more than 2 of 255 apart")
    return 0 if apart < 1e-3 else 1


def bench(folder: pathlib.Path, millions: int) -> int:
    """The sizes of the paper's Table 2, of generated meshes: 23 million faces; 0.5 million with a texture of 8192 pixels."""
    environment = folder / "environment.hdr"
    sky = np.ones((64, 128, 3), np.float32)
    sky[:20, 30:50] = 8
    easypbr.save_image(sky, environment)
    y, x = np.mgrid[0:8192, 0:8192] // 128
    checker = np.repeat(((x + y) % 2 * 155 + 100).astype(np.uint8)[..., None], 3, axis=2)
    for faces, texture in ((0.5e6, checker), ((millions or 1) * 1e6, None)):
        mesh = shapes.sphere(1.0, int(64 * np.sqrt(faces / len(shapes.sphere(1.0, 64).F))))
        mesh.material.base_color_texture = texture
        path = folder / ("bench.ply" if texture is None else "bench.glb")
        mesh.save(path)
        command = [ROOT / "build/bench_frames", path, "20", environment, "1920x1080"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        path.unlink()
        if done.returncode:
            print(done.stderr)
            return 1
        print(f"{len(mesh.F) / 1e6:.2f} M faces, 1920 x 1080: {json.dumps(json.loads(done.stdout))}", flush=True)
    return 0


STEPS = {step.__name__: step for step in (golden, cuda, recording, frames, tests_python, textures, splats, bench)}

if __name__ == "__main__":
    if len(sys.argv) < 3 or sys.argv[1] not in STEPS:
        sys.exit(__doc__)
    sys.exit(STEPS[sys.argv[1]](pathlib.Path(sys.argv[2]), int(sys.argv[3]) if len(sys.argv) > 3 else 0))

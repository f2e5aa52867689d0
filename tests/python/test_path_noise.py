"""Denoising and ending path traced images."""

import os
import pathlib
import subprocess
import sys
import time

import numpy as np
import pytest

import easypbr

SIZE = (64, 64)


def view(**path: object) -> easypbr.Viewer:
    scene = easypbr.Scene()
    scene.show(easypbr.shapes.sphere(1), "ball")
    return easypbr.Viewer(SIZE, {"path": {"enabled": True, **path}, "ground": {"mode": "plane"}}, scene=scene)


def test_denoising_comes_nearer_to_many_samples() -> None:
    reference = view(denoise="off").render(samples=256).astype(float)
    noisy, smooth = (np.abs(view(denoise=how).render(samples=8) - reference).mean() for how in ("off", "filter"))
    assert smooth < noisy / 2


def test_a_library_that_is_missing_is_named(tmp_path: pathlib.Path) -> None:
    # In a process of its own: another test may have loaded one.
    program = """import easypbr
scene = easypbr.Scene()
scene.show(easypbr.shapes.sphere(1), "ball")
view = easypbr.Viewer((32, 32), {"path": {"enabled": True, "denoise": "oidn"}}, scene=scene)
try:
    view.render(samples=2)
except easypbr.Error as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", program], env={**os.environ, "EASYPBR_OIDN": str(tmp_path)},
                          capture_output=True, text=True, check=True)
    assert "pip install pyoidn" in done.stdout


def test_the_library_gets_light_with_its_guides(tmp_path: pathlib.Path) -> None:
    """A caught shadow is that of a white ground: dark where light is missing, as the surfaces beside it are."""
    subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-Wall", "-o", tmp_path / "libOpenImageDenoise.so.2",
                    pathlib.Path(__file__).parent / "fake_oidn.c"], check=True)
    program = """import easypbr, numpy as np, sys
scene = easypbr.Scene()
scene.show(easypbr.shapes.sphere(1), "ball")
settings = {"path": {"enabled": True}, "ground": {"mode": "shadow"}, "lights": {"fill": {"enabled": False}, "rim": {"enabled": False}}}
pictures = [easypbr.Viewer((64, 48), {**settings, "path": {"enabled": True, "denoise": how}}, scene=scene).render(samples=16)
            for how in ("off", "oidn")]
np.save(sys.argv[1], pictures)
"""
    environment = {**os.environ, "EASYPBR_OIDN": str(tmp_path), "FAKE_OIDN_FOLDER": str(tmp_path)}
    subprocess.run([sys.executable, "-c", program, tmp_path / "pictures.npy"], env=environment, check=True)
    off, oidn = np.load(tmp_path / "pictures.npy").astype(int)
    # It changes nothing, so that what it is given comes back; 1 - (1 - x) rounds.
    assert np.abs(off - oidn).max() <= 1
    color, albedo, normal = (np.fromfile(tmp_path / name, np.float32).reshape(48, 64, 3) for name in ("color", "albedo", "normal"))
    ground = (albedo > 0.999).all(-1) & (normal[..., 1] > 0.999)
    assert ground.sum() > 200
    assert color[ground].max() > 0.95 and color[ground].min() < 0.6
    # Where the picture is dark the ground is.
    assert np.corrcoef(color[ground][:, 0], off[ground][:, 0])[0, 1] > 0.9
    assert "maxMemoryMB 800" in (tmp_path / "numbers").read_text()


def test_squares_that_end_by_their_noise_do_not_depend_on_threads() -> None:
    program = """import hashlib, os, sys
if sys.argv[1] == "one":
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
import easypbr
scene = easypbr.Scene()
scene.show(easypbr.shapes.sphere(1), "ball")
view = easypbr.Viewer((96, 64), {"ground": {"mode": "plane"}, "image": {"noise": 0.05}}, scene=scene)
print(hashlib.sha256(view.render(samples=32).tobytes()).hexdigest())
"""
    one, all_of_them = (subprocess.run([sys.executable, "-c", program, threads], capture_output=True, text=True, check=True).stdout
                        for threads in ("one", "all"))
    assert one == all_of_them


def test_an_unknown_denoiser_is_refused() -> None:
    with pytest.raises(easypbr.ArgumentError, match="denoise.*best, oidn, filter"):
        view(denoise="median")


def test_images_end_by_their_noise_and_by_their_time() -> None:
    seen = view(denoise="off")
    whole = seen.render(samples=64)
    seen.settings.image.noise = 0.05
    assert not np.array_equal(seen.render(samples=64), whole)
    seen.settings.image.noise = 0
    seen.settings.image.time_budget = 0.3
    begin = time.monotonic()
    seen.render(samples=65536)
    assert time.monotonic() - begin < 30

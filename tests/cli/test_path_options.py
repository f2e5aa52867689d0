"""Path tracing from the command line: its mode, its denoiser, and when images end."""
import time

import numpy as np
import pytest

import png

SCENE = ("--size", "64x48", "--set", "ground.mode=plane")


def drawn(easypbr, tmp_path, box, *options, mode="path", samples=8):
    easypbr("render", box, *SCENE, "--mode", mode, "--samples", str(samples), *options, "-o", tmp_path / "a.png")
    return png.read(tmp_path / "a.png").astype(float)


def test_modes_and_denoisers_draw_different_pictures(easypbr, tmp_path, box):
    noisy = drawn(easypbr, tmp_path, box, "--set", "path.denoise=off")
    assert np.abs(drawn(easypbr, tmp_path, box, "--set", "path.denoise=filter") - noisy).mean() > 0.5
    assert np.abs(drawn(easypbr, tmp_path, box, mode="raster") - noisy).mean() > 0.5


def test_images_end_by_their_noise_and_by_their_time(easypbr, tmp_path, box):
    off = ("--set", "path.denoise=off")
    assert not np.array_equal(drawn(easypbr, tmp_path, box, *off, "--noise", "1"), drawn(easypbr, tmp_path, box, *off))
    begin = time.monotonic()
    drawn(easypbr, tmp_path, box, *off, "--time-budget", "0.5", samples=65536)
    assert time.monotonic() - begin < 60


@pytest.mark.parametrize("option, value, said", [("--noise", "2", "image.noise"), ("--time-budget", "-1", "image.time_budget"),
                                                 ("--mode", "rays", "--mode")])
def test_bad_values_are_refused(easypbr, box, option, value, said):
    done = easypbr("render", box, "-o", "a.png", option, value, code=2)
    assert said in done.stderr

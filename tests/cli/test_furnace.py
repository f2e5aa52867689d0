"""White furnace (techniques: Heitz 2014): a surface that absorbs nothing, in an environment of constant radiance,
has that radiance everywhere, whatever its roughness and wherever it is seen from."""
import numpy as np
import pytest

import exr

RADIANCE = 0.7
TURNS = [("0", "30", "15"), ("70", "-100", "60"), ("-145", "200", "-35")]


@pytest.fixture(scope="session")
def constant(tmp_path_factory):
    path = tmp_path_factory.mktemp("environment") / "constant.exr"
    exr.write(path, np.full((32, 64, 3), RADIANCE, np.float32))
    return path


def interior(path):
    """Radiance of the pixels that the object covers wholly (premultiplied alpha 1): n x 3."""
    planes = exr.read(path)
    inside = planes["A"] == 1
    assert inside.sum() > 1500  # a sphere as high as 0.95 of 48 rows covers 1633 pixels
    return np.stack([planes[c][inside] for c in "RGB"], axis=1)


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("roughness", ["0.1", "0.25", "0.5", "0.75", "1"])
@pytest.mark.parametrize("metallic", ["1", "0"])
def test_white_surface_shows_the_environments_radiance(render, tmp_path, sphere, constant, metallic, roughness, turn):
    rotation, azimuth, elevation = turn
    render(sphere, "-o", "out.exr", "--env", constant, "--env-rotation", rotation, "--background", "transparent",
           "--color", "white", "--metallic", metallic, "--roughness", roughness,
           "--set", f"camera.azimuth_deg={azimuth}", "--set", f"camera.elevation_deg={elevation}")
    values = interior(tmp_path / "out.exr")
    # 0.5 %: the resolution of the DFG table (0.002) and of half floats in the prefiltered environment (0.0005).
    assert abs(values - RADIANCE).max() <= 0.005 * RADIANCE


def test_environment_intensity_scales_the_radiance(render, tmp_path, sphere, constant):
    render(sphere, "-o", "out.exr", "--env", constant, "--env-intensity", "2", "--background", "transparent",
           "--color", "white", "--metallic", "1", "--roughness", "0.5")
    assert abs(interior(tmp_path / "out.exr") - 2 * RADIANCE).max() <= 0.005 * 2 * RADIANCE

"""The helmet on a ground under a sky against Mitsuba 3 (make_helmet.py says what the scene is) and beside VTK 9
(make_helmet_vtk.py): shadows, occlusion, reflections, textures and glow together, with default settings: a still of 64 samples sends rays into the
sky and the scene.
"""
import hashlib
import json
import os
import pathlib
import subprocess

import numpy as np
import pytest

import easypbr
from easypbr import Material, Mesh, Scene, Viewer

HERE = pathlib.Path(__file__).resolve().parent
DATA = os.environ.get("EASYPBR_TEST_DATA")
ORACLE_PYTHON = HERE.parents[1] / ".venv-oracle/bin/python"
HELMET = json.loads((HERE / "helmet.json").read_text())
VTK = json.loads((HERE / "helmet_vtk.json").read_text())

pytestmark = pytest.mark.skipif(not DATA, reason="left out: EASYPBR_TEST_DATA does not name the folder of test files")


def srgb8(linear):
    curve = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)
    return (np.clip(curve, 0, 1) * 255 + 0.5).astype(np.uint8)


def hash_of(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def draw(samples=64):
    """Radiance and coverage of ours."""
    data = pathlib.Path(DATA)
    about = HELMET["ground"]
    half, y = about["size"] / 2, about["height"]
    ground = Mesh()
    ground.V = np.array([[-half, y, half], [half, y, half], [half, y, -half], [-half, y, -half]])
    ground.F = np.array([[0, 1, 2], [0, 2, 3]])
    # Mitsuba's ground is diffuse alone.
    ground.material = Material(base_color=3 * (about["reflectance"],), roughness=1, specular=0)
    scene = Scene()
    scene.show(Mesh(data / HELMET["mesh"]), "helmet")
    scene.show(ground, "ground")
    view = Viewer(tuple(HELMET["size"]), {
        "camera": HELMET["camera"], "environment": {"file": str(data / HELMET["environment"])},
        "background": {"mode": "transparent"}}, scene)
    return view.render(samples=samples, hdr=True)


@pytest.fixture(scope="module")
def pictures():
    """8-bit sRGB of the reference, of ours and of VTK's, the exposure fixed by the reference, and where both see something."""
    assert hash_of(HERE / "helmet.exr") == HELMET["sha256"]
    assert hash_of(HERE / "helmet_vtk.png") == VTK["sha256"]
    for file, known in HELMET["inputs"].items():
        assert hash_of(pathlib.Path(DATA) / file) == known
    reference = easypbr.load_image(HERE / "helmet.exr")
    ours = draw()
    mask = (reference[:, :, 3] > 0.999) & (ours[:, :, 3] > 0.999)
    assert np.mean(abs(reference[:, :, 3] - ours[:, :, 3])) < 0.005
    exposure = 0.9 / np.quantile(reference[mask][:, :3], 0.99)
    assert abs(exposure / VTK["exposure"] - 1) < 0.005, exposure
    vtk = easypbr.load_image(HERE / "helmet_vtk.png")[:, :, :3]
    return srgb8(reference[:, :, :3] * exposure), srgb8(ours[:, :, :3] * exposure), vtk, mask


def mean_flip(reference, test, mask, folder):
    np.savez(folder / "pair.npz", reference=reference, test=test, mask=mask)
    done = subprocess.run([ORACLE_PYTHON, HERE / "flip.py", folder / "pair.npz"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return float(done.stdout.splitlines()[-1])


@pytest.mark.skipif(not ORACLE_PYTHON.exists(), reason="left out: scripts/oracle.sh has not made .venv-oracle")
def test_flip_is_lower_than_vtks(pictures, tmp_path):
    reference, ours, vtk, mask = pictures
    assert mask.mean() > 0.5
    flip, vtks = mean_flip(reference, ours, mask, tmp_path), mean_flip(reference, vtk, mask, tmp_path)
    assert flip < vtks / 2, (flip, vtks)
    assert flip < 0.08, flip

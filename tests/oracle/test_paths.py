"""Path tracing against Mitsuba 3: a box that is open to the sky, with a lamp, a matt and a metal ball in it (path_scene.py)."""
import hashlib
import json
import pathlib

import numpy as np
import path_scene
import pytest

import easypbr
from easypbr import Material, Scene, Viewer, shapes

HERE = pathlib.Path(__file__).resolve().parent


def sha256(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


@pytest.fixture(scope="module")
def reference():
    about = json.loads((HERE / "paths.json").read_text())
    assert sha256(HERE / "paths.exr") == about["sha256"] and sha256(HERE / "path_scene.py") == about["scene"]
    return easypbr.load_image(HERE / "paths.exr")


@pytest.fixture(scope="module")
def view():
    scene = Scene()
    for name, (size, centre, reflectance) in path_scene.BOXES.items():
        mesh = shapes.box(size)
        mesh.material = Material(base_color=reflectance, roughness=1)
        mesh.translate(centre)
        scene.show(mesh, name)
    for name, (radius, centre, reflectance, roughness) in path_scene.BALLS.items():
        mesh = shapes.sphere(radius, 256)
        mesh.material = Material(base_color=reflectance, metallic=roughness is not None,
                                 roughness=1 if roughness is None else roughness)
        mesh.translate(centre)
        scene.show(mesh, name)
    view = Viewer(path_scene.SIZE, {
        "camera": path_scene.CAMERA, "shading": {"dielectric_f0": 0, "multiple_scattering": False},
        "background": {"mode": "transparent"}, "path": {"enabled": True, "clamp": 0, "bounces": 64}}, scene)
    view.load_environment_map(path_scene.sky())
    for name in ("key", "fill", "rim"):
        view.lights[name].enabled = False
    view.add_light("lamp", **path_scene.LIGHT, radius=0)
    return view


def errors(view, reference, samples):
    ours = view.render(samples=samples, hdr=True)
    mask = (reference[:, :, 3] > 0.999) & (ours[:, :, 3] > 0.999)
    assert mask.mean() > 0.4
    difference = (ours - reference)[mask][:, :3]
    return difference, reference[mask][:, :3].mean()


def test_light_is_the_same(view, reference):
    """1 %: Schlick's rise at grazing angles (test_mitsuba.py) is at most that much of a diffuse surface's light, and the
    balls here are of triangles. Noise of both sides averages out over the picture."""
    difference, mean = errors(view, reference, 512)
    assert abs(difference.mean()) < 0.01 * mean
    assert abs(np.median(difference, axis=0)).max() < 0.01 * mean


def test_errors_fall_with_the_samples(view, reference):
    """As the square root at least: 16 times as many samples, a quarter of the error."""
    few, many = (np.sqrt(np.mean(errors(view, reference, samples)[0] ** 2)) for samples in (8, 128))
    assert many < few / 3

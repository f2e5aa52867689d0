"""What pictures are drawn by."""
import os
import subprocess
import sys

import numpy as np
import pytest

import easypbr
from easypbr import Scene, Viewer, shapes


@pytest.fixture
def environment_without_opengl(tmp_path):
    """Libraries that are no libraries stand for a machine without OpenGL."""
    for name in ("libEGL.so.1", "libGL.so.1", "libOpenGL.so.0"):
        (tmp_path / name).touch()
    environment = {**os.environ, "LD_LIBRARY_PATH": str(tmp_path)}
    environment.pop("EASYPBR_DEVICE", None)
    return environment


def drawn_by(device):
    scene = Scene()
    scene.show(shapes.sphere(), "sphere")
    view = Viewer((64, 48), {"image": {"samples": 1}}, scene, device=device)
    return view.device, np.asarray(view.render())


def test_the_cpu_and_opengl_draw_the_same():
    (device, native), (other, by_driver) = drawn_by("cpu"), drawn_by("gl")
    assert (device, other) == ("cpu", "gl")
    # Both round to 8 bits; at edges either may cover a pixel.
    difference = np.abs(native.astype(int) - by_driver).max(axis=2)
    assert (difference > 1).mean() < 0.01


def test_an_unknown_device_names_the_known_ones():
    with pytest.raises(easypbr.UnknownNameError, match="expected auto, gl or cpu"):
        Viewer(device="cuda")


def test_without_opengl_pictures_are_drawn_and_errors_say_what_needs_it(environment_without_opengl):
    program = """
import easypbr
from easypbr import Scene, Viewer, shapes

scene = Scene()
scene.show(shapes.box(), "box")
view = Viewer((32, 32), {"image": {"samples": 2}}, scene)
assert view.device == "cpu" and view.render().shape == (32, 32, 4)
for name in ("clearcoat", "iridescence", "anisotropy"):
    setattr(view.settings.material, name, 0.5)
view.settings.material.sheen_color = (0.2, 0.3, 0.4)
assert view.render()[16, 16, 3] == 255
view.settings.material.opacity = 0.5
view.settings.background.mode = "transparent"
assert 128 < view.render()[16, 16, 3] < 255
view.settings.material.transmission = 0.5
assert 64 < view.render()[16, 16, 3] < 192
for mode in ("points", "surfels"):
    view.settings.style.mode = mode
    assert 0 < view.render()[..., 3].max() < 255
view.settings.style.overlay = True
assert 0 < view.render()[..., 3].max() < 255
box = shapes.box()
box.material.shader = "void surface(inout Surface s) { s.roughness = 0.3; }"
view.settings.style.mode = "mesh"
scene.show(box, "box")
try:
    view.render()
except easypbr.ContextError as error:
    print(error)
scene.show(shapes.box(), "box")
view.settings.material.opacity, view.settings.material.transmission, view.settings.style.overlay = 1, 0, False
view.add_light("lamp", "directional", direction=(0.3, -1, -0.5))
assert view.render()[..., 3].max() == 255
"""
    done = subprocess.run([sys.executable, "-c", program], env=environment_without_opengl, capture_output=True, text=True,
                          timeout=120)
    assert done.returncode == 0, done.stderr
    assert "transparency: this needs OpenGL" in done.stdout and "Install" in done.stdout

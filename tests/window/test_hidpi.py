"""A screen of twice the usual resolution: windows, panels, text and handles are twice as large."""
import os
import subprocess
import sys

import numpy as np
import pytest

from display import Display, wait_until

# GLFW asks for the screen's scale when it starts, so that each test is a program of its own.
PROGRAM = """
import sys
sys.path.insert(0, sys.argv[1])
import numpy as np, easypbr
from conftest import Window
from display import Display

class Shown(Display):
    def __init__(self, name, framebuffer):
        import os, pathlib
        self.name, self.framebuffer, self.environment = name, pathlib.Path(framebuffer), dict(os.environ)

scene = easypbr.Scene()
scene.show(easypbr.shapes.sphere(1, 32), "ball")
view = easypbr.Viewer((640, 400), {"image": {"samples": 2}}, scene=scene)
window = Window(Shown(*sys.argv[2:4]), view)
"""

CHECKS = """
state = window.state
assert state["size"] == [1280, 800], state["size"]
assert state["scale"] == 2
places = state["places"]
np.savez(sys.argv[4], shown=window.shown(), drawn=view.screenshot((1280, 800), scale=2),
         heading=places["Scene"])

# The left panels alone, beside the picture's middle.
view.show_panels("Scene", "Object")
window.update(4)

# Picking: a click on the ball's middle, in pixels of the screen.
window.mouse("mousemove", 640, 400, "click", 1)
assert window.state["object"] == "ball"
pick = view.pick(640, 400, (1280, 800))
assert pick.object == "ball"

# The handle along x, 90 plain pixels long: twice as many here, and so 120 pixels from the middle are on it.
ball = scene.get("ball")
window.settle()
camera = view.camera
before = np.array(ball.T_parent_mesh)
assert window.state["object"] == "ball"
right = np.array(camera.T_world_cam)[:3, 0]
view.camera = easypbr.Camera.look_at((0, 0, 5), (0, 0, 0))
window.settle()
window.mouse("mousemove", 640 + 120, 400)
window.mouse("mousedown", 1)
window.mouse("mousemove", 640 + 160, 400)
window.mouse("mousemove", 640 + 200, 400)
window.mouse("mouseup", 1)
moved = np.array(ball.T_parent_mesh)[:3, 3] - before[:3, 3]
# By 80 pixels at a distance of 5.
pitch = 2 * 5 * np.tan(np.radians(view.camera.fov_y_deg) / 2) / 800
np.testing.assert_allclose(moved, (80 * pitch, 0, 0), atol=pitch)

# Larger on request.
view.panel_scale = 0.75
window.update(4)
assert window.state["scale"] == 1.5
view.close()
print("done")
"""


@pytest.fixture
def dense(tmp_path):
    with Display(tmp_path, dpi=192) as display:
        yield display


def test_everything_is_twice_as_large(dense, tmp_path):
    result = tmp_path / "result.npz"
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM + CHECKS, os.path.dirname(__file__), dense.name, dense.framebuffer, result],
        env=dense.environment, capture_output=True, text=True, timeout=120)
    assert done.stdout.endswith("done\n"), done.stderr
    values = np.load(result)
    # The window system draws the pointer, and what the program counts (milliseconds) changes.
    assert np.mean(np.any(values["shown"] != values["drawn"][:, :, :3], axis=2)) < 0.01
    left, top, right, bottom = values["heading"]
    # 270 plain pixels of panel, its text in lines of 14 with 3 above and below.
    assert 2 * 230 < right - left < 2 * 270
    assert 2 * 19 < bottom - top < 2 * 24

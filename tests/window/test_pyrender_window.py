"""easypbr.compat.pyrender: the window of a Viewer that runs in a thread."""
import time

import easypbr.compat.pyrender as pyrender
import numpy as np
from display import wait_until

CORNERS = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])


def square(color):
    material = pyrender.MetallicRoughnessMaterial(baseColorFactor=(0.0, 0, 0, 1), emissiveFactor=color)
    return pyrender.Mesh([pyrender.Primitive(CORNERS, indices=[[0, 1, 2], [0, 2, 3]], material=material)])


def test_a_window_in_a_thread_follows_the_scene_and_rests(display, monkeypatch):
    updates, pressed = [], []
    update = pyrender.Viewer.update
    monkeypatch.setattr(pyrender.Viewer, "update", lambda viewer: (updates.append(1), update(viewer))[1])
    scene = pyrender.Scene(bg_color=[0.0, 0.0, 0.0], ambient_light=[0.1, 0.1, 0.1])
    camera = scene.add(pyrender.PerspectiveCamera(yfov=0.9))
    viewer = pyrender.Viewer(scene, viewport_size=(800, 600), run_in_thread=True, registered_keys={"k": pressed.append})
    try:
        state = viewer._drawing.view._handle.gui_state
        wait_until(lambda: state()["frames"] == state()["total"] > 0)
        left, top = display.place(next(title for title in display.windows() if "EasyPBR" in title))
        middle = lambda: display.screen()[top + 300, left + 400].tolist()  # noqa: E731
        with viewer.render_lock:
            red = scene.add(square((1.0, 0, 0)), pose=[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, -3], [0, 0, 0, 1]])
        wait_until(lambda: middle()[0] > 200 and max(middle()[1:]) < 80)
        with viewer.render_lock:
            scene.remove_node(red)
            scene.add(square((0, 1.0, 0)), pose=[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, -3], [0, 0, 0, 1]])
        wait_until(lambda: middle()[1] > 200 and middle()[0] < 80)
        with viewer.render_lock:
            turned = np.diag([-1.0, 1, -1, 1])
            scene.set_pose(camera, turned)
        wait_until(lambda: max(middle()) < 80)
        wait_until(lambda: state()["frames"] == state()["total"])
        updates.clear()
        drawn = state()["frames"]
        time.sleep(0.5)
        assert not updates and state()["frames"] == drawn, "nothing has changed"
        display.run("xdotool", "mousemove", str(left + 400), str(top + 300), "key", "k")
        wait_until(lambda: pressed == [viewer])
    finally:
        viewer.close_external()
    assert not viewer.is_active

import numpy as np
import pytest

from easypbr import Mesh, Scene, Viewer, render, shapes

SIZE = (80, 60)


def room(size: tuple[float, float, float]) -> tuple[np.ndarray, np.ndarray]:
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]) * size
    sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return corners, np.array([[a, b, c] for a, b, c, d in sides] + [[a, c, d] for a, b, c, d in sides])


# Nothing from outside lights the room. White is 255: a tenth of it is dark, and nine tenths are washed out.
@pytest.mark.parametrize("mode", ["raster", "path"])
def test_a_closed_room_is_lit_from_the_camera(mode):
    camera = {"position": (0, 0, 2.5), "target": (0, -0.2, 0), "fov_y_deg": 70}
    picture = render([room((6, 3, 6)), shapes.sphere(0.5)], size=SIZE, camera=camera, mode=mode)
    assert 50 < np.median(picture[..., :3]) < 230


def test_the_lamp_at_the_camera_is_shown_and_kept():
    scene = Scene()
    scene.show(Mesh(*room((6, 3, 6))), "room")
    view = Viewer(scene=scene)
    view.settings.camera.position = (0, 0, 2.5)
    view.settings.camera.target = (0, 0, 0)
    view.render(size=SIZE, samples=1)
    lamp = np.array(view.settings.lights.key.position.value)
    # The wall behind the camera is 0.5 away: the lamp goes half of it to the upper left.
    np.testing.assert_allclose(lamp, (-0.25 * 0.5**0.5, 0.25 * 0.5**0.5, 2.5), atol=1e-6)
    view.settings.camera.position = (1, 0, 0)
    view.render(size=SIZE, samples=1)
    np.testing.assert_array_equal(view.settings.lights.key.position.value, lamp)


def test_a_room_that_no_light_is_in_is_a_warning(caplog):
    scene = Scene()
    scene.show(Mesh(*room((6, 3, 6))), "room")
    view = Viewer(scene=scene)
    view.settings.camera.position = (0, 0, 2.5)
    view.settings.camera.target = (0, 0, 0)
    view.settings.lights.key.position = (0, 9, 0)
    view.render(size=SIZE, samples=1)
    assert "no light is within" not in caplog.text, "single frames have the environment's light"
    view.settings.path.enabled = True
    view.render(size=SIZE, samples=2)
    view.render(size=SIZE, samples=2)
    assert caplog.text.count("no light is within") == 1
    caplog.clear()
    view.settings.lights.key.position = (0, 1, 0)
    view.render(size=SIZE, samples=2)
    assert not caplog.text

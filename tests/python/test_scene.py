import copy

import numpy as np
import pytest

import easypbr
from easypbr import Environment, Light, Scene, Viewer, auto, shapes


def test_methods_on_the_class_act_on_the_default_scene(square):
    own = Scene()
    Scene.show(shapes.box(), "box")
    own.show(square, "square")
    assert Scene.names() == ["box"] and own.names() == ["square"]
    assert Scene.contains("box") and not Scene.contains("square")
    assert "square" in own
    assert Viewer().scene.names() == ["box"]
    assert Viewer(scene=own).scene.names() == ["square"]
    Scene.remove("box")
    assert Scene.names() == []
    own.clear()
    assert own.names() == []


def test_unknown_names_get_a_hint():
    Scene.show(shapes.box(), "crate")
    for act in (Scene.get, Scene.remove, Scene.hide):
        with pytest.raises(KeyError, match="did you mean 'crate'") as caught:
            act("crat")
        assert isinstance(caught.value, easypbr.UnknownNameError)
        assert not str(caught.value).startswith(("'", '"'))


def test_hidden_meshes_are_not_drawn(size):
    Scene.show(shapes.sphere(1, 8), "sphere")
    Scene.show(shapes.box(), "box")
    view = Viewer(size)
    both = view.layers(["depth"])["depth"]
    Scene.hide("sphere")
    box = view.layers(["depth"])["depth"]
    Scene.hide("sphere", False)
    assert (box > 0).sum() < (both > 0).sum()
    np.testing.assert_array_equal(view.layers(["depth"])["depth"], both)


def test_added_lights(size):
    view = Viewer(size)
    light = view.add_light("lamp", position=(1, 2, 3), color="#ff0000", intensity=5)
    assert list(view.lights) == ["key", "fill", "rim", "lamp"]
    light.intensity = 7
    assert view.lights["lamp"].intensity == 7
    assert Scene.light("lamp").position == (1, 2, 3)
    assert view.lights["lamp"].color == (1, 0, 0)
    view.lights["lamp"].color = (0.25, 0.5, 0.75)
    assert view.lights["lamp"].color == (0.25, 0.5, 0.75)
    view.remove_light("lamp")
    assert "lamp" not in view.lights and len(view.lights) == 3
    with pytest.raises(KeyError, match="did you mean 'sun'"):
        view.add_light("sun", type="directional", direction=(0, -1, 0))
        view.lights["sum"]
    with pytest.raises(ValueError, match="did you mean 'spot'"):
        view.add_light("x", type="spott")
    with pytest.raises(ValueError, match="light.intensity: expected a number of at least 0, got -1"):
        view.add_light("x", intensity=-1)
    with pytest.raises(AttributeError):
        view.add_light("x", brightness=1)


def test_copies_of_lights_are_the_same_lights(size):
    view = Viewer(size, scene=Scene())
    view.add_light("lamp", type="point")
    for name in ("key", "lamp"):
        copied = copy.copy(view.lights[name])
        copied.intensity = 7
        assert view.lights[name].intensity == 7
        assert copied.intensity == 7


def test_studio_lights_are_settings(size):
    view = Viewer(size)
    key = view.lights["key"]
    assert key.enabled == auto and key.position == auto
    key.position = (1, 2, 3)
    key.color = "#808080"
    assert view.settings.lights.key.position == (1, 2, 3)
    # Settings are sRGB (128 / 255), lights are linear: ((128/255 + 0.055) / 1.055)^2.4 = 0.21586.
    assert view.settings.lights.key.color == pytest.approx((128 / 255,) * 3, abs=1e-6)
    assert key.color == pytest.approx((0.21586,) * 3, abs=1e-5)
    key.color = (0.21586, 0, 1)
    assert view.settings.lights.key.color == pytest.approx((128 / 255, 0, 1), abs=1e-4)
    key.position = auto
    assert view.settings.lights.key.position == auto
    with pytest.raises(AttributeError, match="no 'range'"):
        key.range = 2
    key.radius = 0.5
    key.casts_shadows = False
    assert view.settings.lights.key.radius == 0.5 and view.settings.lights.key.casts_shadows is False
    with pytest.raises(ValueError, match="cannot be removed"):
        view.remove_light("key")


def test_radius_of_a_light_is_inferred_and_latched(size):
    own = Scene()
    own.show(shapes.box(), "box")
    view = Viewer(size, scene=own)
    light = view.add_light("lamp", position=(1, 2, 3))
    assert light.radius == auto and light.radius.value is None and light.casts_shadows
    view.render(samples=1)
    # A twentieth of half the diagonal of a unit cube.
    assert light.radius.value == pytest.approx(3**0.5 / 2 / 20)
    own.show(shapes.sphere(10, 8), "box")
    view.render(samples=1)
    assert light.radius.value == pytest.approx(3**0.5 / 2 / 20)
    view.refit()
    view.render(samples=1)
    assert light.radius.value == pytest.approx(0.5, rel=0.8) and light.radius.value > 0.4
    light.radius = 0.25
    assert light.radius == 0.25
    light.radius = auto
    assert light.radius == auto
    expected = "light.radius: expected a number of at least 0 world units, or 'auto' or 'follow', got "
    with pytest.raises(ValueError, match=expected + "-1"):
        light.radius = -1
    with pytest.raises(ValueError, match=expected + "'big'"):
        light.radius = "big"
    assert view.add_light("sun", "directional", direction=(0, -1, 0), angular_radius_deg=2).angular_radius_deg == 2


def test_light_value():
    light = Light("spot", position=(0, 1, 0), inner_cone_deg=10, outer_cone_deg=20)
    assert (light.type, light.position, light.outer_cone_deg) == ("spot", (0, 1, 0), 20)


def test_area_lights():
    """Below a disc of radius r at height h a diffuse surface of albedo a shows a L r^2 / (r^2 + h^2). 1 %: in a single frame
    a disc is a polygon of 12 corners."""
    scene = Scene()
    ground = shapes.plane(0.1)
    ground.material = easypbr.Material(base_color=(0.5, 0.5, 0.5), roughness=1, metallic=0)
    scene.show(ground, "ground")
    scene.set_light("disc", Light("disc", position=(0, 1.5, 0), direction=(0, -1, 0), radius=0.5, intensity=4))
    values = {"camera": {"position": (0, 2, 2.5), "target": (0, 0, 0), "fov_y_deg": 1}, "environment.enabled": False,
              "lights": {"key": {"enabled": False}}, "shading.dielectric_f0": 0, "ground.mode": "none"}
    for samples in (1, 64):
        picture = Viewer((9, 9), values, scene).render(hdr=True, samples=samples)
        assert picture[4, 4, 0] == pytest.approx(0.5 * 4 * 0.25 / (0.25 + 2.25), rel=0.01)


def test_area_lights_have_a_size():
    light = Light("rectangle", size=(2, 1), width_axis=(0, 0, 1))
    assert (light.type, light.size, light.width_axis) == ("rectangle", (2, 1), (0, 0, 1))
    with pytest.raises(ValueError, match="size: expected 2 numbers, each a number of at least"):
        light.size = (1, 0)
    with pytest.raises(ValueError, match="size.*2 numbers"):
        light.size = (1, 2, 3)
    scene = Scene()
    scene.show(shapes.sphere(), "ball")
    scene.set_light("point", Light("sphere", radius=0))
    with pytest.raises(ValueError, match="light 'point': radius: expected more than 0"):
        Viewer((8, 8), scene=scene).render()


def test_environments(tmp_path):
    picture = np.full((4, 8, 3), 0.5, dtype=np.float32)
    environment = Environment(picture)
    np.testing.assert_array_equal(environment.to_numpy(), picture)
    assert environment and not Environment()
    easypbr.save_image(picture, tmp_path / "e.exr")
    np.testing.assert_array_equal(Environment(tmp_path / "e.exr").to_numpy(), picture)
    Scene.default().environment = picture
    np.testing.assert_array_equal(Scene.default().environment.to_numpy(), picture)
    with pytest.raises(OSError, match="none.hdr"):
        Environment(tmp_path / "none.hdr")
    with pytest.raises(ValueError, match="environment: expected height x width"):
        Environment(np.zeros(3))

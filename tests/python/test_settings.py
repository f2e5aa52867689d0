import json
import os
from pathlib import Path

import numpy as np
import pytest

import easypbr
from easypbr import ArgumentError, Scene, Viewer, auto, follow, shapes


@pytest.fixture
def view(size):
    scene = Scene()
    scene.show(shapes.sphere(1, 8), "sphere")
    return Viewer(size, scene=scene)


def test_values_of_every_kind(view):
    s = view.settings
    s.image.samples = 3
    assert s.image.samples == 3 and isinstance(s.image.samples, int)
    s.image.size = np.array([32, 16])
    assert s.image.size == (32, 16) and isinstance(s.image.size[0], int)
    s.shading.multiple_scattering = np.bool_(False)
    assert s.shading.multiple_scattering is False
    s.tonemap.operator = "agx"
    assert s.tonemap.operator == "agx"
    s.camera.fov_y_deg = np.float64(45)
    assert s.camera.fov_y_deg == 45
    s.background.color = "#ff0000"
    assert s.background.color == (1, 0, 0)
    s.background.color = (0, 0.5, 1)
    assert s.background.color == (0, 0.5, 1)
    s.camera.pose = np.eye(4)
    assert s.camera.pose == tuple(np.eye(4).ravel())
    s.camera.pose = None
    assert s.camera.pose == ()
    s.environment.file = Path("map.hdr")
    assert s.environment.file == "map.hdr"
    s.environment.file = None
    assert s.environment.file == ""
    s.lights.key.position = [1, 2, 3]
    assert s["lights.key.position"] == (1, 2, 3)


def test_auto_and_follow(view):
    s = view.settings
    assert s.tonemap.exposure == auto and s.tonemap.exposure.value is None
    s.tonemap.exposure = 2
    assert s.tonemap.exposure == 2
    s.tonemap.exposure = follow
    assert s.tonemap.exposure == follow
    s.tonemap.exposure = auto
    view.render(samples=1)
    latched = s.tonemap.exposure
    assert latched == auto and latched.value > 0
    assert repr(latched).startswith("auto (now ")
    # Assigning what was read keeps it.
    s.tonemap.exposure = latched
    assert s.tonemap.exposure.value == latched.value
    view.refit()
    assert s.tonemap.exposure.value is None
    with pytest.raises(ValueError, match="image.samples"):
        s.image.samples = auto


def test_resolve_gives_what_would_be_drawn_and_keeps_nothing(view):
    exposure = view.settings.resolve("tonemap.exposure")
    assert view.settings.tonemap.exposure.value is None
    view.render(samples=1)
    assert view.settings.tonemap.exposure.value == exposure


def test_misspelt_names_get_a_hint(view):
    with pytest.raises(AttributeError, match="there is no setting 'camera.fovy_deg'.*'camera.fov_y_deg'"):
        view.settings.camera.fovy_deg
    with pytest.raises(AttributeError, match="did you mean 'camera.fov_y_deg'"):
        view.settings.camera.fovy_deg = 3
    with pytest.raises(AttributeError, match="tonemap"):
        view.settings.tonemapp.exposure = 3
    with pytest.raises(KeyError, match="did you mean 'camera.fov_y_deg'"):
        view.settings["camera.fovy_deg"]
    with pytest.raises(AttributeError, match="'lights.key' is a group"):
        view.settings.lights.key = 3


@pytest.mark.parametrize(
    "name, value, message",
    [
        ("camera.fov_y_deg", "wide", "camera.fov_y_deg.*got 'wide'"),
        ("image.samples", 1.5, "image.samples.*whole"),
        ("image.size", (1, 2, 3), "image.size.*2 numbers"),
        ("tonemap.operator", "acees", "did you mean 'aces'"),
        ("background.color", "#12", "background.color"),
        ("background.color", (1, 2, 3), "background.color"),
        ("camera.margin", None, "None is no value"),
        ("camera.position", ["a", "b", "c"], "camera.position.*expected 3 numbers"),
    ],
)
def test_bad_values_are_refused_and_change_nothing(view, name, value, message):
    before = view.settings[name]
    with pytest.raises(ValueError, match=message):
        view.settings[name] = value
    assert view.settings[name] == before


def test_several_values_are_set_all_or_none(view):
    s, before = view.settings, list(view.settings)

    def assign(group, values):
        if group:
            setattr(s, group, values)
        else:
            view.settings = values

    for group, values in (
        ("", {"camera": {"fov_y_deg": 60, "margn": 0.1}}),
        ("", {"image.samples": 3, "camera": {"fov_y_deg": 500}}),
        ("camera", {"fov_y_deg": 60, "margin": "wide"}),
        ("lights", {"key": {"intensity": 3}, "fill": {"intensity": "much"}}),
    ):
        with pytest.raises((KeyError, ValueError)):
            assign(group, values)
        assert list(s) == before
        if not group:
            with pytest.raises((KeyError, ValueError)):
                s.update(values)
            assert list(s) == before
    s.update({"camera": {"fov_y_deg": 60}, "image.samples": 3})
    assert s.camera.fov_y_deg == 60 and s.image.samples == 3


def test_a_bad_environment_map_leaves_the_one_before(view):
    view.settings.environment.file = "map.hdr"
    with pytest.raises(ValueError, match="5 channels"):
        view.load_environment_map(np.zeros((4, 8, 5)))
    assert view.settings.environment.file == "map.hdr"
    view.load_environment_map(np.ones((4, 8, 3), np.float32))
    assert view.settings.environment.file == ""


def test_names_can_be_listed_and_described(view):
    assert {"camera", "lights", "tonemap"} <= set(dir(view.settings))
    assert {"key", "fill", "rim", "intensity"} <= set(dir(view.settings.lights))
    assert "position" in dir(view.settings.lights.key)
    text = view.settings.describe("camera.fov_y_deg")
    assert "camera.fov_y_deg" in text and "degrees" in text and "default: 30" in text
    assert "tonemap.operator = 'aces'" in repr(view.settings).splitlines()
    assert dict(view.settings.camera)["camera.fov_y_deg"] == 30


def test_from_dict(size):
    nested = Viewer(settings={"camera": {"fov_y_deg": 40}, "lights": {"key": {"intensity": 3}}})
    assert nested.settings.camera.fov_y_deg == 40 and nested.settings.lights.key.intensity == 3
    flat = Viewer(size, settings={"camera.fov_y_deg": 40, "image.size": (1, 1)})
    assert flat.settings.camera.fov_y_deg == 40 and flat.settings.image.size == size
    with pytest.raises(KeyError, match="camera.fovy"):
        Viewer(settings={"camera": {"fovy": 40}})


def test_saved_settings_give_the_same_picture_bit_for_bit(view, tmp_path):
    view.settings.tonemap.operator = "neutral"
    view.add_light("lamp", position=(2, 2, 2), intensity=4)
    picture = view.render(samples=2)
    view.save_settings(tmp_path / "look.json")
    assert json.loads((tmp_path / "look.json").read_text()) == view.settings.to_dict() | {
        "files": json.loads((tmp_path / "look.json").read_text())["files"]
    }
    for settings in (tmp_path / "look.json", str(tmp_path / "look.json"), view.settings.to_dict()):
        scene = Scene()
        scene.show(view.scene.get("sphere"), "sphere")
        again = Viewer(settings=settings, scene=scene)
        assert again.settings.tonemap.operator == "neutral"
        np.testing.assert_array_equal(again.render(samples=2), picture)


def test_saved_settings_name_no_file_whose_name_is_not_utf8(view, tmp_path):
    """JSON cannot hold the name; one with another letter in place of the byte could not be loaded."""
    light = tmp_path / os.fsdecode(b"caf\xe9.png")
    easypbr.save_image(np.full((2, 4, 3), 200, np.uint8), light)
    view.settings.environment.file = light
    for save in (lambda: view.save_settings(tmp_path / "look.json"), view.settings.to_dict):
        with pytest.raises(ArgumentError, match="environment.file': expected UTF-8"):
            save()
    assert not (tmp_path / "look.json").exists()


def test_unreadable_settings_files(tmp_path):
    with pytest.raises(OSError, match="none.json"):
        Viewer(settings=tmp_path / "none.json")
    (tmp_path / "bad.json").write_text("{")
    with pytest.raises(easypbr.FormatError, match="bad.json"):
        Viewer(settings=tmp_path / "bad.json")


def test_the_stub_names_every_setting():
    stub = (Path(easypbr.__file__).parent / "settings.pyi").read_text()
    compile(stub, "settings.pyi", "exec")
    for field in easypbr._easypbr.fields():
        assert f"def {field.name.split('.')[-1]}(self)" in stub
    assert "class LightsKeySettings(SettingsGroup):" in stub


def test_up_is_inferred_and_pinned():
    """A floor and a wall that faces no axis, z up."""
    floor = np.random.default_rng(1).random((40_000, 3)) * (4, 3, 0)
    wall = np.random.default_rng(2).random((10_000, 3)) * (3, 2, 1) * np.array([1, 0, 1])
    wall[:, 1] = 0.5 * wall[:, 0]
    scene = Scene()
    scene.show(easypbr.as_mesh(np.concatenate([floor, wall])), "scan")
    view = Viewer((32, 24), scene=scene)
    assert view.settings.camera.up == auto
    view.render(samples=1)
    assert view.settings.camera.up.value == "+z"
    view.settings.camera.up = "-Y"
    assert view.settings.camera.up == "-y"
    view.settings.camera.up = auto
    assert view.settings.resolve("camera.up") == "+z"
    with pytest.raises(easypbr.ArgumentError, match=r"\+x, -x, \+y, -y, \+z, -z.*auto"):
        view.settings.camera.up = "north"


@pytest.mark.parametrize("scale, offset", [
    ((1, 1, 1), (0, 0, 0)), ((1, 1, 2000), (11, 48, 500)), ((15_000, 9_000, 100), (691_000, 5_335_000, 520)),
])
@pytest.mark.parametrize("count", [10, 60, 100])
def test_height_fields_have_z_up(count, scale, offset):
    """The points of a grid and the mesh of them, with and without holes."""
    x, y = np.meshgrid(*[np.linspace(-1, 1, count)] * 2)
    i = np.arange(count * count).reshape(count, count)
    quads = np.stack([i[:-1, :-1], i[:-1, 1:], i[1:, 1:], i[1:, :-1]], -1).reshape(-1, 4)
    gone = np.random.default_rng(1).random((count, count)) < 0.05
    for z in (np.sinc(4 * np.hypot(x, y)), 0.3 * np.sin(4 * x), x * y):
        points = np.stack([x, y, z], -1) * scale + offset
        holes = np.where(gone[..., None], np.nan, points)
        for shown in (points, holes, (points.reshape(-1, 3), quads),
                      (points.reshape(-1, 3), quads[~gone.ravel()[quads].any(1)])):
            scene = Scene()
            scene.show(easypbr.as_mesh(shown), "field")
            assert Viewer((32, 24), scene=scene).settings.resolve("camera.up") == "+z"


def test_presets(size, tmp_path):
    ball = shapes.sphere(segments=16)
    white, red = (255, 255, 255, 255), (255, 0, 0, 255)
    paper = easypbr.render(ball, size=size, samples=1, preset="paper")
    assert tuple(paper[0, 0]) == white
    assert tuple(easypbr.render(ball, size=size, samples=1, preset="paper", background="#ff0000")[0, 0]) == red
    view = Viewer(size, {"background": {"color": "#ff0000"}}, preset="paper")
    assert view.settings.ground.mode == "shadow" and view.settings.background.color == (1, 0, 0)
    (tmp_path / "mine.json").write_text('{"easypbr": 1, "settings": {"background": {"color": "#ff0000"}}}')
    view = Viewer(size, tmp_path / "mine.json", preset="paper")
    assert view.settings.ground.mode == "shadow" and view.settings.background.color == (1, 0, 0)
    view.apply_preset(tmp_path / "mine.json")
    assert view.settings.ground.mode == "shadow"
    view.apply_preset("dark")
    assert view.settings.ground.mode == "none"
    with pytest.raises(easypbr.UnknownNameError, match="did you mean 'paper'"):
        view.apply_preset("papr")


def test_presets_infer_anew_but_for_the_camera(view):
    view.render(samples=1)
    position, exposure = view.settings.camera.position.value, view.settings.tonemap.exposure.value
    view.apply_preset("paper")
    view.render(samples=1)
    assert view.settings.camera.position.value == position
    assert view.settings.tonemap.exposure.value != exposure

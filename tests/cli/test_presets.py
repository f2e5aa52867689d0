"""--preset: built-in presets and settings files. Every option that is given overrides the preset."""
import json

import numpy as np
import pytest

import png

SIZE = ("--size", "64x48", "--samples", "1")


def corner(path) -> list[int]:
    return png.read(path)[0, 0, :3].tolist()


def write_preset(path, settings: dict) -> None:
    path.write_text(json.dumps({"easypbr": 1, "settings": settings}))


def one_error(done) -> str:
    (line,) = done.stderr.splitlines()
    assert line.startswith("easypbr: error: ")
    return line


@pytest.mark.parametrize("name, background", [("dark", 64), ("studio", 217), ("paper", 255), ("flat", 255)])
def test_presets_have_their_background(render, sphere, tmp_path, name, background):
    render(sphere, "-o", "out.png", "--preset", name)
    assert corner(tmp_path / "out.png") == [background] * 3


def test_studio_is_the_default_look(render, sphere, tmp_path):
    render(sphere, "-o", "default.png")
    render(sphere, "-o", "studio.png", "--preset", "studio")
    assert (tmp_path / "default.png").read_bytes() == (tmp_path / "studio.png").read_bytes()


@pytest.mark.parametrize("name", ["studio", "paper"])
def test_the_content_casts_a_shadow_on_the_ground(render, sphere, tmp_path, name):
    render(sphere, "-o", "out.png", "--preset", name)
    render(sphere, "-o", "without.png", "--preset", name, "--set", "ground.mode=none")
    with_ground, without = (png.read(tmp_path / f).astype(int) for f in ("out.png", "without.png"))
    assert (without - with_ground).max() > 30


def test_flat_has_the_own_colors_of_surfaces(render, box, tmp_path):
    render(box, "-o", "out.png", "--preset", "flat", "--color", "#c0392b")
    colors = np.unique(png.read(tmp_path / "out.png")[:, :, :3].reshape(-1, 3), axis=0).tolist()
    assert [0xC0, 0x39, 0x2B] in colors and [255, 255, 255] in colors


@pytest.mark.parametrize("first", [True, False])
def test_options_win_whatever_their_order(easypbr, sphere, tmp_path, first):
    preset, other = ("--preset", "paper"), ("--background", "#102030")
    easypbr("render", sphere, "-o", "out.png", *SIZE, *(preset + other if first else other + preset))
    assert corner(tmp_path / "out.png") == [0x10, 0x20, 0x30]


def test_a_preset_is_a_file_that_says_what_it_wants(render, sphere, tmp_path):
    write_preset(tmp_path / "mine.json", {"background": {"color": "#405060"}})
    render(sphere, "-o", "out.png", "--preset", "mine.json", "--save-settings", "all.json")
    assert corner(tmp_path / "out.png") == [0x40, 0x50, 0x60]
    assert json.loads((tmp_path / "all.json").read_text())["settings"]["ground"]["mode"] == "auto"


def test_a_settings_file_wins_over_a_preset(render, sphere, tmp_path):
    write_preset(tmp_path / "mine.json", {"background": {"color": "#405060"}})
    render(sphere, "-o", "out.png", "--preset", "paper", "--settings", "mine.json", "--save-settings", "all.json")
    assert corner(tmp_path / "out.png") == [0x40, 0x50, 0x60]
    assert json.loads((tmp_path / "all.json").read_text())["settings"]["ground"]["mode"] == "shadow"


def test_wrong_presets_are_errors(render, sphere, tmp_path):
    assert "did you mean 'paper'" in one_error(render(sphere, "-o", "out.png", "--preset", "papr", code=2))
    assert "missing.json" in one_error(render(sphere, "-o", "out.png", "--preset", "missing.json", code=1))
    write_preset(tmp_path / "wrong.json", {"ground": {"mod": "shadow"}})
    assert "ground.mode" in one_error(render(sphere, "-o", "out.png", "--preset", "wrong.json", code=1))
    assert not (tmp_path / "out.png").exists()


def test_the_window_takes_presets(easypbr, sphere, tmp_path):
    white = []
    for preset in ("dark", "paper"):
        easypbr("view", sphere, "--screenshot", "out.png", "--size", "900x700", "--preset", preset)
        white.append((png.read(tmp_path / "out.png")[:, :, :3] == 255).all(axis=2).mean())
    assert white[0] < 0.001 and white[1] > 0.01

"""Shaders and passes of one's own from Python; what they compute is held to numbers in tests/app/own_shader_test.cpp."""
import os
import pathlib

import numpy as np
import pytest

import easypbr
from easypbr import Scene, Viewer
from easypbr.errors import ArgumentError, FileError, ShaderError, UnknownNameError

BLUE = "void surface(inout Surface s) {\n    s.base_color = vec3(0.25, 0.5, 1.0);\n}\n"
RED = "layout(location = 0) out vec4 o_color;\nvoid main() { o_color = vec4(1.0, 0.0, 0.0, 1.0); }\n"


@pytest.fixture
def view():
    scene = Scene()
    scene.show(easypbr.shapes.box(), "box")
    return Viewer((32, 24), {"image": {"samples": 1}}, scene=scene)


def albedo(view):
    return view.layers("albedo")["albedo"][12, 16, :3]


def write(path, text):
    """With another time than the file had."""
    time = path.stat().st_mtime_ns + 10**9 if path.exists() else None
    path.write_text(text)
    if time:
        os.utime(path, ns=(time, time))


def test_a_text_is_the_shader(view):
    box = view.scene.get("box")
    assert box.material.shader is None
    before = albedo(view)
    box.material.shader = BLUE
    assert box.material.shader == BLUE
    assert np.allclose(albedo(view), (0.25, 0.5, 1.0), atol=0.5 / 65535)
    box.material.shader = None
    assert np.array_equal(albedo(view), before)


def test_a_path_is_read_again_when_it_changes(view, tmp_path):
    path = tmp_path / "own.glsl"
    write(path, BLUE)
    view.scene.get("box").material.shader = path
    assert view.scene.get("box").material.shader == path
    assert np.allclose(albedo(view), (0.25, 0.5, 1.0), atol=0.5 / 65535)
    write(path, BLUE.replace("0.25", "0.75"))
    assert np.allclose(albedo(view), (0.75, 0.5, 1.0), atol=0.5 / 65535)


@pytest.mark.parametrize("of_material", [True, False], ids=["material", "setting"])
def test_a_path_is_that_of_the_folder_it_was_given_in(view, tmp_path, monkeypatch, of_material):
    (tmp_path / "sub").mkdir()
    write(tmp_path / "own.glsl", BLUE)
    monkeypatch.chdir(tmp_path)
    if of_material:
        view.scene.get("box").material.shader = pathlib.Path("own.glsl")
    else:
        view.settings.material.shader = "own.glsl"
    monkeypatch.chdir(tmp_path / "sub")
    assert np.allclose(albedo(view), (0.25, 0.5, 1.0), atol=0.5 / 65535)


def test_a_setting_is_for_all(view, tmp_path):
    write(tmp_path / "own.glsl", BLUE)
    view.settings.material.shader = str(tmp_path / "own.glsl")
    assert np.allclose(albedo(view), (0.25, 0.5, 1.0), atol=0.5 / 65535)


def test_mistakes_are_errors_with_the_line(view):
    material = view.scene.get("box").material
    material.shader = BLUE.replace("vec3", "colour")
    with pytest.raises(ShaderError, match=r"material\.shader:2") as caught:
        view.render()
    assert isinstance(caught.value, ValueError) and "colour" in str(caught.value)
    for wrong in ("", 3):
        with pytest.raises((ArgumentError, TypeError), match="shader"):
            material.shader = wrong
    material.shader = None
    view.render()


def test_clouds_have_none(view, caplog):
    view.scene.show(easypbr.Mesh(np.random.default_rng(1).random((50, 3), np.float32)), "cloud")
    view.scene.get("cloud").material.shader = BLUE
    view.render()
    assert "'cloud' is not drawn as faces" in caplog.text


def test_a_pass_draws_over_pictures(view, tmp_path):
    before = view.render()
    view.add_pass("red", RED)
    assert np.all(view.render() == (255, 0, 0, 255))
    write(tmp_path / "pass.frag", RED.replace("1.0, 0.0, 0.0", "0.0, 0.0, 1.0"))
    view.add_pass("red", tmp_path / "pass.frag", "picture")
    assert np.all(view.render() == (0, 0, 255, 255))
    write(tmp_path / "pass.frag", RED)
    assert np.all(view.render() == (255, 0, 0, 255))
    view.remove_pass("red")
    assert np.array_equal(view.render(), before)


def test_bad_passes_are_refused(view):
    view.add_pass("wrong", RED.replace("vec4(1.0", "vec5(1.0"))
    with pytest.raises(ShaderError, match=r"pass 'wrong': .*\n  wrong:2"):
        view.render()
    view.remove_pass("wrong")
    with pytest.raises(UnknownNameError, match="no pass 'wrong'"):
        view.remove_pass("wrong")
    with pytest.raises(UnknownNameError, match="expected light, overlay or picture"):
        view.add_pass("red", RED, "later")
    with pytest.raises(FileError, match="no.frag"):
        view.add_pass("red", pathlib.Path("/nowhere/no.frag"))


def test_a_window_keeps_the_last_good_picture(view, tmp_path):
    """Without a display: what the window would show."""
    path = tmp_path / "own.glsl"
    write(path, BLUE)
    view.scene.get("box").material.shader = path
    view._handle.set_gui("show_panels", False)
    good = view.screenshot((800, 600))
    write(path, BLUE.replace("vec3", "colour"))
    broken = view.screenshot((800, 600))
    messages = view._handle.gui_state()["messages"]
    assert len(messages) == 1 and "own.glsl:2" in messages[0]
    # All but the message is as it was.
    assert np.any(broken != good)
    rows = np.flatnonzero(np.any(broken != good, axis=(1, 2)))
    assert rows[0] > 400 and np.ptp(rows) < 150, (rows[0], rows[-1])
    write(path, BLUE.replace("0.5, 1.0", "0.5, 0.0"))
    mended = view.screenshot((800, 600))
    assert mended[300, 400, 2] < 0.7 * good[300, 400, 2]

"""Line drawings: view.save_svg()."""
import pytest

import easypbr
from easypbr import shapes


@pytest.fixture
def view():
    scene = easypbr.Scene()
    scene.show(shapes.box(), "box")
    return easypbr.Viewer((200, 100), scene=scene)


def test_hidden_lines_are_dashed_solid_or_left_out(view, tmp_path):
    path = view.save_svg(tmp_path / "a.svg")
    assert path == tmp_path / "a.svg"
    dashed = path.read_text()
    assert 'viewBox="0 0 200 100"' in dashed and "dasharray" in dashed
    solid = view.save_svg(tmp_path / "b.svg", hidden="solid").read_text()
    assert "dasharray" not in solid and 'class="hidden"' in solid
    assert 'class="hidden"' not in view.save_svg(tmp_path / "c.svg", hidden="none").read_text()


def test_size_and_settings_are_followed(view, tmp_path):
    view.settings.outline.width = 3
    view.settings.outline.color = "#336699"
    text = view.save_svg(tmp_path / "a.svg", size=(64, 48)).read_text()
    assert 'viewBox="0 0 64 48"' in text and 'stroke-width="3"' in text and '"#336699"' in text


def test_what_cannot_be_is_refused(view, tmp_path):
    with pytest.raises(easypbr.ArgumentError, match="expected a file named .svg"):
        view.save_svg(tmp_path / "a.png")
    with pytest.raises(easypbr.UnknownNameError, match="did you mean 'dashed'"):
        view.save_svg(tmp_path / "a.svg", hidden="dashd")
    with pytest.raises(easypbr.FileError):
        view.save_svg(tmp_path / "no/such/a.svg")
    assert not list(tmp_path.iterdir())

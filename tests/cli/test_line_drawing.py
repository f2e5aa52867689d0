"""Line drawings from the command line: SVG files."""
import xml.etree.ElementTree as ElementTree

import pytest

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture
def box(tmp_path):
    path = tmp_path / "box.obj"
    corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    faces = ["1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4"]
    path.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "".join(f"f {face}\n" for face in faces))
    return path


def segments(path, kind):
    """Straight lines of the group of this class."""
    groups = [group for group in ElementTree.parse(path).getroot() if group.get("class") == kind]
    return sum(each.get("d").count("L") + each.get("d").count("Z") for group in groups for each in group.iter(f"{SVG}path"))


def test_a_box_has_nine_visible_edges_and_three_hidden(easypbr, box, tmp_path):
    easypbr("render", box, "-o", tmp_path / "a.svg", "--size", "320x240")
    root = ElementTree.parse(tmp_path / "a.svg").getroot()
    assert (root.get("width"), root.get("height")) == ("320", "240")
    assert [title.text for title in root.iter(f"{SVG}title")] == ["box", "box"]
    assert (segments(tmp_path / "a.svg", "visible"), segments(tmp_path / "a.svg", "hidden")) == (9, 3)
    easypbr("render", box, "-o", tmp_path / "b.svg", "--hidden-lines", "None")
    assert (segments(tmp_path / "b.svg", "visible"), segments(tmp_path / "b.svg", "hidden")) == (9, 0)


def test_each_file_of_a_batch_gets_its_drawing(easypbr, box, tmp_path):
    other = tmp_path / "other.obj"
    other.write_text(box.read_text())
    easypbr("render", "--batch", box, other, "-o", tmp_path / "{name}.svg")
    assert segments(tmp_path / "box.svg", "visible") == segments(tmp_path / "other.svg", "visible") == 9


@pytest.mark.parametrize("options, code, text", [
    (["-o", "a.png", "--hidden-lines", "none"], 2, "--hidden-lines needs an SVG file"),
    (["-o", "a.svg", "--turntable", "3"], 2, "a line drawing is no recording"),
    (["-o", "a.svg", "--layers", "depth"], 2, "--layers are of an image"),
    (["-o", "a.svg", "--hidden-lines", "dotted"], 2, "dotted"),
    (["-o", "no/such/a.svg"], 1, "no/such/a.svg"),
])
def test_what_cannot_be_is_refused(easypbr, box, options, code, text):
    assert text in easypbr("render", box, *options, code=code).stderr

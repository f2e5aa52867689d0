"""Colour maps: reversed ones, tables of users, matplotlib's."""
import json

import numpy as np
import pytest

import easypbr
from easypbr import Mesh, Scene, Viewer

NAMES = ["viridis", "plasma", "inferno", "magma", "turbo", "cividis", "grey", "coolwarm"]


def drawn_colors(values, **style) -> list:
    """The colours of unlit points, each with its value; the one of a point that is not seen is None."""
    cloud = Mesh()
    cloud.V = [[i, 0, 0] for i in range(len(values))]
    cloud.add_scalar("t", values)
    for name, value in {"point_size": 9, "lit": False, **style}.items():
        setattr(cloud.style, name, value)
    scene = Scene()
    scene.show(cloud, "cloud")
    view = Viewer((200, 100), scene=scene)
    element = view.layers(["element_id"])["element_id"].astype(int)
    picture = view.render(samples=1)
    found = [{tuple(color) for color in picture[element == i + 1][:, :3].tolist()} for i in range(len(values))]
    assert all(len(colors) == 1 for colors in found), "points of one colour each"
    return [colors.pop() for colors in found]


@pytest.mark.parametrize("name", NAMES)
def test_reversed_maps(name):
    assert (easypbr.colormap(name + "_r") == easypbr.colormap(name)[::-1]).all()


def test_the_colour_of_a_value_is_that_of_an_own_table():
    """Values 0, 1/4, 1/2 and 1 of 0 to 1 have the entries 0, 64, 128 and 255; entry i of a table from black to white is i / 255
    of the way: exactly the code i."""
    colors = drawn_colors([0, 0.25, 0.5, 1], colormap=[[0, 0, 0], [1, 1, 1]])
    assert colors == [(0, 0, 0), (64, 64, 64), (128, 128, 128), (255, 255, 255)]
    table = easypbr.colormap("turbo")
    assert drawn_colors([0, 0.25, 0.5, 1], colormap=table) == [tuple(table[i].tolist()) for i in (0, 64, 128, 255)]


@pytest.mark.parametrize("given, text", [
    ("plasma_r", "plasma_r"),
    ("navy,white, maroon", "#000080,#ffffff,#800000"),
    (["#000080", "#fff"], "#000080,#ffffff"),
    ([[0, 0, 0.5], [1, 1, 1]], "#000080,#ffffff"),  # 127.5 is rounded to the even 128
    (np.array([[0, 0, 128, 255], [255, 255, 255, 255]], np.uint8), "#000080,#ffffff"),
    (np.array([[0, 0, 1, 1], [1, 0, 0, 1]], np.float32), "#0000ff,#ff0000"),
    (easypbr.auto, easypbr.auto),
    ("auto", easypbr.auto),
])
def test_what_a_style_takes(given, text):
    mesh = Mesh()
    mesh.style.colormap = given
    assert mesh.style.colormap == text
    if isinstance(text, str):
        mesh.style.colormap = mesh.style.colormap
        assert (easypbr.colormap(given) == easypbr.colormap(text)).all()


def test_a_table_is_accepted_again():
    for name in NAMES:
        table = easypbr.colormap(name)
        assert (easypbr.colormap(table) == table).all()


@pytest.mark.parametrize("given, message", [
    ([[0, 0, 1]], "at least 2 of them, got 1 x 3"),
    ([[0, 0, 2], [1, 1, 1]], "from 0 to 1, or of uint8, got 2"),
    ([[0, 0, np.nan], [1, 1, 1]], "from 0 to 1"),
    ([[0, 0, 0, 1], [1, 1, 1, 0.5]], "opaque colours, got one with alpha in row 1 of 2"),
    (np.zeros((3, 2)), "got 3 x 2"),
    (["red"], "at least 2 colours, got 1"),
    ("red,", "colour 2"),
    (3, "expected n x 3"),
    ({}, "got dict"),
])
def test_bad_tables_are_named(given, message):
    mesh = Mesh()
    with pytest.raises(easypbr.ArgumentError, match=message):
        mesh.style.colormap = given
    assert mesh.style.colormap == easypbr.auto


def test_files_keep_a_table():
    view = Viewer((32, 24))
    view.settings.style.colormap = [[0, 0, 0], [0.2, 0.4, 1]]
    kept = json.dumps(view.settings.to_dict())
    other = Viewer((32, 24))
    other.settings.update(json.loads(kept))
    assert other.settings.style.colormap == "#000000,#3366ff"


def test_maps_of_matplotlib():
    matplotlib = pytest.importorskip("matplotlib")
    from matplotlib.colors import LinearSegmentedColormap

    steps = easypbr.colormap("tab10")  # by name: ten colours, each over a tenth
    assert (easypbr.colormap(matplotlib.colormaps["tab10"]) == steps).all()
    assert len(np.unique(steps, axis=0)) == 10
    assert (steps[0] == np.rint(np.array(matplotlib.colormaps["tab10"].colors[0]) * 255)).all()
    own = LinearSegmentedColormap.from_list("own", ["black", "red"])
    # Its table has 256 entries, too: entry i is i / 255 of the way.
    assert easypbr.colormap(own).tolist() == [[i, 0, 0] for i in range(256)]
    mesh = Mesh()
    mesh.style.colormap = "jet"
    assert (easypbr.colormap(mesh.style.colormap) == easypbr.colormap("jet")).all()
    with pytest.raises(easypbr.ArgumentError, match="no colormap 'jett'"):
        mesh.style.colormap = "jett"


def test_names_without_matplotlib(monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "matplotlib", None)  # importing it is an ImportError
    with pytest.raises(easypbr.UnknownNameError, match="no colormap 'jet'"):
        easypbr.colormap("jet")


def test_the_middle_of_a_logarithmic_scale_is_the_geometric_mean():
    """Of 0.01 to 100: sqrt(0.01 * 100) = 1 has entry 128 of 256; where rounding decides, 127. Zero and less are
    missing values."""
    colors = drawn_colors([0.01, 1, 100, 0, -7], colormap="grey", color_scale="log", nan_color="#ff0000")
    assert colors[0] == (0, 0, 0) and colors[2] == (255, 255, 255) and colors[3] == colors[4] == (255, 0, 0)
    assert colors[1] in ((127, 127, 127), (128, 128, 128))


@pytest.mark.parametrize("end", ["color_min", "color_max"])
def test_a_logarithmic_range_above_zero(end):
    with pytest.raises(easypbr.ArgumentError, match=f"expected {end} above 0, as color_scale is log, got 0"):
        drawn_colors([1, 2], color_scale="log", **{end: 0})


def test_steps_are_bands():
    """Five bands of 0 to 1 have the entries 0, 64, 128, 191 and 255: k * 255 / 4, rounded."""
    colors = drawn_colors([0, 0.19, 0.21, 0.5, 0.61, 0.79, 0.81, 1], colormap="grey", color_steps=5)
    assert [red for red, *_ in colors] == [0, 0, 64, 128, 191, 191, 255, 255]


def test_bands_of_a_surface_end_where_they_should():
    """A square seen from the front, its value rising from 0 at the left to 1 at the right, in ten bands: each pixel has the
    colour of its band, but for those within a hundredth of a band of a border, where rounding decides."""
    mesh = Mesh(V=[[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], F=[[0, 1, 2], [0, 2, 3]])
    mesh.add_scalar("t", [0, 1, 1, 0])
    mesh.style.lit, mesh.style.colormap, mesh.style.color_steps = False, "grey", 10
    scene = Scene()
    scene.show(mesh, "square")
    camera = {"projection": "orthographic", "ortho_height": 3.0, "azimuth_deg": 0, "elevation_deg": 0}
    picture = Viewer((200, 150), {"camera": camera}, scene).render(samples=1)
    x = (np.arange(200) + 0.5 - 100) * 3 / 150
    t = (x + 1) / 2 * 10
    inside = (np.abs(x) < 0.999) & (np.abs(t - np.rint(t)) > 0.01)
    expected = np.rint(np.clip(np.floor(t), 0, 9) * 255 / 9)
    assert inside.sum() > 90
    assert (picture[75, inside, 0] == expected[inside]).all()


@pytest.mark.parametrize("name, value", [
    ("color_scale", "logarithm"), ("color_steps", 257), ("color_steps", -1), ("color_steps", 2.5),
])
def test_bad_scales_and_steps_are_named(name, value):
    mesh = Mesh()
    with pytest.raises(easypbr.ArgumentError, match=f"style.{name}.*expected"):
        setattr(mesh.style, name, value)

"""Colours of labels and values in pictures, and what is written beside them."""
import numpy as np
import pytest

import easypbr
from easypbr import LabelMap, Material, Mesh, Scene, Viewer, shapes


def labelled_cloud(count: int = 3000) -> Mesh:
    rng = np.random.default_rng(5)
    cloud = Mesh()
    label_map = LabelMap.semantic_kitti()
    labels = np.array(label_map.labels)[rng.integers(0, len(label_map), count)]
    cloud.assign(V=rng.random((count, 3)), L=labels, label_map=label_map)
    return cloud


def viewer(mesh: Mesh, **groups) -> Viewer:
    scene = Scene()
    scene.show(mesh, "object")
    return Viewer((200, 150), groups, scene)


def table_of(label_map: LabelMap) -> np.ndarray:
    """Colours by label."""
    table = np.zeros((max(label_map.labels) + 1, 3), np.uint8)
    table[label_map.labels] = label_map.colors
    return table


def colors_by_element(view: Viewer, labels: np.ndarray, table: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where an element is seen, and the colour that it must have there."""
    element = view.layers(["element_id"])["element_id"].astype(int)
    return element > 0, table[labels[np.maximum(element - 1, 0)]]


@pytest.mark.parametrize("samples", [1, 16])
@pytest.mark.parametrize("tone", [{}, {"operator": "agx", "exposure": 7.0}])
def test_labels_of_points_are_the_tables_colours(samples, tone):
    cloud = labelled_cloud()
    view = viewer(cloud, tonemap=tone)
    picture = view.render(samples=samples)
    seen, expected = colors_by_element(view, cloud.L, table_of(cloud.label_map))
    assert seen.mean() > 0.1
    assert (picture[seen][:, :3] == expected[seen]).all()
    # And nothing is mixed with them where they end.
    assert (picture[~seen][:, :3] == 217).all()


def test_labels_of_faces_are_exact_when_they_are_not_lit():
    mesh = shapes.sphere(1.0, 24)
    labels = np.arange(len(mesh.F)) % 5
    mesh.L = labels
    mesh.label_map = LabelMap(list("abcde"))
    mesh.style.lit = False
    view = viewer(mesh)
    seen, expected = colors_by_element(view, labels, table_of(mesh.label_map))
    assert (view.render(samples=4)[seen][:, :3] == expected[seen]).all()
    mesh.style.lit = True
    lit = view.render(samples=4)[seen][:, :3]
    assert (lit != expected[seen]).any(axis=1).mean() > 0.9


@pytest.mark.parametrize("samples", [1, 4])
def test_lines_are_drawn_over_exact_colours(samples):
    mesh = shapes.box()
    mesh.L = np.arange(len(mesh.F)) % 3
    mesh.style.lit = False
    view = viewer(mesh)
    plain = view.render(samples=samples)
    mesh.style.show_wireframe = True
    mesh.style.line_color = "#ffffff"
    mesh.style.line_width = 3
    wired = view.render(samples=samples)
    element = view.layers(["element_id"])["element_id"] > 0
    white = (wired[:, :, :3] == 255).all(axis=2)
    # The three front faces of a box have nine edges and three diagonals: their pixels, three wide.
    assert (white & element).sum() > 500
    untouched = element & (wired == plain).all(axis=2)
    assert untouched.sum() > 0.5 * element.sum()


@pytest.mark.parametrize("samples", [1, 4])
@pytest.mark.parametrize("paths", [False, True])
def test_glass_is_seen_before_exact_colours(samples, paths):
    back, front = shapes.plane(4), shapes.plane(2)
    back.L = [7, 7]
    back.label_map = LabelMap(list("abcdefgh"))
    back.style.lit = False
    front.material = Material(base_color=(0, 0, 0), opacity=0.5, alpha_mode="blend", unlit=True)
    scene = Scene()
    scene.show(back, "back")
    scene.show(front.transform([[1, 0, 0, 0], [0, 1, 0, 0.5], [0, 0, 1, 0], [0, 0, 0, 1]]), "front")
    view = Viewer((120, 90), {"camera": {"position": (0, 8, 0), "target": (0, 0, 0), "up": "z"},
                               "path": {"enabled": paths}}, scene)
    picture = view.render(samples=samples)
    exact = np.array(back.label_map.colors[7])
    # In front of the middle half of the light is black.
    linear = np.where(exact > 10, ((exact / 255 + 0.055) / 1.055) ** 2.4, exact / 255 / 12.92) / 2
    half = 255 * np.where(linear > 0.0031308, 1.055 * linear ** (1 / 2.4) - 0.055, 12.92 * linear)
    # A code: the overlay holds halves.
    np.testing.assert_allclose(picture[45, 60, :3], half, atol=1)
    # The larger square ends at 2 of 2.14 units from the middle (30 degrees from 8), the smaller at 1 of 2.
    assert (picture[4, 60, :3] == exact).all() and (picture[86, 60, :3] == exact).all()


def test_labels_of_vertices_are_not_mixed_on_faces():
    mesh = shapes.sphere(1.0, 24)
    mesh.L = np.random.default_rng(1).integers(0, 7, len(mesh.V))
    mesh.style.lit = False
    picture = viewer(mesh).render(samples=4)
    generated = {tuple(color) for color in LabelMap([str(i) for i in range(7)]).colors}
    seen = {tuple(color) for color in picture[:, :, :3].reshape(-1, 3)}
    # And the background.
    assert seen - generated == {(217, 217, 217)}


def test_values_are_mapped_after_they_are_interpolated():
    """A square seen from the front, its value rising from 0 at the left to 1 at the right: the pixel centre at the
    part t of its width has entry 256 t of the table. Where 256 t is near a whole number, rounding of the
    interpolation decides."""
    mesh = Mesh(V=[[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], F=[[0, 1, 2], [0, 2, 3]])
    mesh.add_scalar("t", [0, 1, 1, 0])
    mesh.style.lit = False
    view = viewer(mesh, camera={"projection": "orthographic", "ortho_height": 3.0, "azimuth_deg": 0, "elevation_deg": 0})
    picture = view.render(samples=1)
    x = (np.arange(200) + 0.5 - 100) * 3 / 150
    t = (x + 1) / 2 * 256
    inside = (np.abs(x) < 0.999) & (np.abs(t - np.rint(t)) > 0.01)
    expected = easypbr.colormap("viridis")[np.clip(t, 0, 255).astype(int)]
    assert inside.sum() > 90
    assert (picture[75, inside, :3] == expected[inside]).all()


def test_nan_and_ranges_have_their_colours():
    cloud = Mesh()
    cloud.V = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]
    cloud.add_scalar("t", [np.nan, -5, 0.5, 99])
    cloud.style.color_min, cloud.style.color_max, cloud.style.nan_color = 0, 1, "#ff00ff"
    cloud.style.colormap = "turbo"
    cloud.style.point_size = 15
    cloud.style.lit = False
    view = viewer(cloud)
    element = view.layers(["element_id"])["element_id"].astype(int)
    picture = view.render(samples=1)
    table = easypbr.colormap("turbo")
    for point, color in enumerate([(255, 0, 255), table[0], table[128], table[255]], 1):
        assert (element == point).sum() > 20
        assert (picture[element == point][:, :3] == color).all()


@pytest.mark.parametrize("style, error, message", [
    ({"color_by": "label"}, easypbr.ArgumentError, "color_by is label, but the objects have no labels"),
    ({"scalar": "curvture"}, easypbr.UnknownNameError, "no object has scalars 'curvture' .did you mean 'curvature'"),
])
def test_overrides_that_no_object_has_are_errors(style, error, message):
    mesh = shapes.box()
    mesh.add_scalar("curvature", np.zeros(len(mesh.V)))
    with pytest.raises(error, match=message):
        viewer(mesh, style=style).render(samples=1)


def test_annotations_are_drawn_when_asked_for_and_never_into_layers():
    cloud = labelled_cloud()
    view = viewer(cloud)
    view.camera = view.camera  # pinned: an automatic one leaves room for the legend
    plain, layers = view.render(samples=1), view.layers()
    assert view.settings.annotation.legend.value is False
    view.settings.annotation.legend = True
    view.settings.annotation.corner = "bottom_left"
    written = view.render(samples=1)
    touched = (written != plain).any(axis=2)
    rows, columns = np.nonzero(touched)
    assert touched.any() and rows.min() > 2 and columns.max() < 199
    # A rectangle: outside of it nothing is changed, inside nearly everything is.
    assert touched[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1].mean() > 0.9
    for name, layer in view.layers().items():
        assert (layer == layers[name]).all(), name
    view.settings.annotation.legend = easypbr.auto
    assert (view.render(samples=1) == plain).all()


def test_render_takes_legend_and_colorbar(tmp_path):
    mesh = shapes.sphere(1.0, 24)
    mesh.add_scalar("wave", mesh.V[:, 1])
    barred = easypbr.render(mesh, size=(160, 120), samples=1, colorbar=True)
    linear = easypbr.render(mesh, size=(160, 120), samples=1, colorbar=True, hdr=True)
    table = easypbr.colormap("viridis")
    found = (barred[:, :, None, :3] == table).all(axis=3).any(axis=2).sum(axis=0)
    assert found[100:].max() > 50
    assert found[100:].max() > 2 * found[:100].max(), "the ball is lit"
    assert linear.dtype == np.float32 and linear.max() <= 50


def test_the_camera_leaves_room_for_the_colour_bar():
    mesh = shapes.box((4, 1.2, 1))
    mesh.add_scalar("stress", mesh.V[:, 0])
    view = viewer(mesh, annotation={"colorbar": True})
    view.camera = view.camera  # pinned where it was fitted beside the bar
    seen = (view.layers(["object_id"])["object_id"] > 0).any(axis=0)
    barred = view.render(samples=1)
    view.settings.annotation.colorbar = False
    touched = (view.render(samples=1) != barred).any(axis=(0, 2))
    assert seen.any() and touched.any() and not (touched & seen).any()


def test_asking_for_what_there_is_nothing_for_is_a_warning(caplog):
    easypbr.render(shapes.box(), size=(32, 24), samples=1, legend=True, colorbar=True)
    assert "there is no legend" in caplog.text and "there is no colour bar" in caplog.text


def test_what_there_is_nothing_to_write_of_is_told_once_per_change(caplog):
    def told():
        for _ in range(3):
            view.render(samples=1)
        counts = caplog.text.count("there is no legend"), caplog.text.count("there is no colour bar")
        caplog.clear()
        return counts

    view = viewer(shapes.box(), annotation={"legend": True})
    assert told() == (1, 0)
    view.settings.annotation.colorbar = True
    assert told() == (0, 1)
    view.settings.annotation.legend = False
    assert told() == (0, 0)
    view.settings.annotation.legend = True
    assert told() == (1, 0)

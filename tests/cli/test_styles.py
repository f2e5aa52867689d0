"""--style and --label-map."""
import numpy as np
import pytest

import png


@pytest.mark.parametrize("text, hint", [
    ("color_by", "--style: expected KEY=VALUE or NAME.KEY=VALUE, got 'color_by'"),
    ("=height", "--style: expected KEY=VALUE"),
    ("colr_by=height", "--style: there is no setting 'style.colr_by' (did you mean 'style.color_by'?)"),
    ("color_by=hight", "(did you mean 'height'?)"),
    ("colormap=virids", "(did you mean 'viridis'?)"),
    ("colormap=#000080", "expected at least 2 colours, got 1"),
    ("colormap=#000080,#12", "colour 2: "),
    ("color_scale=logs", "(did you mean 'log'?)"),
    ("color_steps=300", "0 to 256"),
    ("box.point_size=0", "expected a number of"),
    ("bix.flat=true", "--style: there is no object 'bix' (did you mean 'box'?): the files are called box"),
])
def test_bad_styles_exit_with_2_before_anything_is_drawn(render, box, tmp_path, text, hint):
    done = render(box, "-o", "out.png", "--style", text, code=2)
    assert hint in done.stderr and done.stderr.count("\n") == 1
    assert not (tmp_path / "out.png").exists()


def test_label_maps_are_found_before_anything_is_drawn(render, box, tmp_path):
    assert "did you mean 'cityscapes'" in render(box, "-o", "out.png", "--label-map", "cityscape", code=2).stderr
    assert "none.json" in render(box, "-o", "out.png", "--label-map", "none.json", code=1).stderr
    assert not (tmp_path / "out.png").exists()


def test_a_label_map_without_labels_is_a_warning(render, box):
    assert "'box' has no labels" in render(box, "-o", "out.png", "--label-map", "cityscapes").stderr


def test_surfels_of_a_mesh_without_normals_are_a_warning(render, box):
    said = render(box, "-o", "out.png", "--style", "mode=surfels").stderr
    assert "'box' has no normals" in said and "--to-surfels" in said and said.count("\n") == 1


def write_labelled(path):
    """Three points: with the labels of a car, a road and a pole."""
    path.write_text("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                    "property int label\nend_header\n0 0 0 10\n1 0 0 40\n2 0 0 80\n")
    return path


def colors(path):
    return {tuple(color) for color in png.read(path)[:, :, :3].reshape(-1, 3)}


def test_label_maps_colour_labels(render, tmp_path):
    cloud = write_labelled(tmp_path / "cloud.ply")
    render(cloud, "-o", "out.png", "--label-map", "semantic_kitti", "--style", "point_size=9")
    assert colors(tmp_path / "out.png") == {(100, 150, 245), (255, 0, 255), (255, 240, 150), (217, 217, 217)}
    assert "label 40 in row 1 of 3" in render(cloud, "-o", "out.png", "--label-map", "cityscapes", code=1).stderr


def test_styles_are_of_all_objects_or_of_one(render, tmp_path):
    # Two triangles beside each other.
    left, right = tmp_path / "left.obj", tmp_path / "right.obj"
    left.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    right.write_text("v 2 0 0\nv 3 0 0\nv 2 1 0\nf 1 2 3\n")

    def drawn(*styles):
        render(left, right, "-o", "out.png", *(part for style in styles for part in ("--style", style)))
        return png.read(tmp_path / "out.png").astype(int)

    plain, normals, one = drawn(), drawn("color_by=normal"), drawn("left.color_by=normal")
    changed = (normals != plain).any(axis=2)
    changed_by_one = (one != plain).any(axis=2)
    assert changed.sum() > changed_by_one.sum() > 0
    assert np.nonzero(changed_by_one)[1].max() < 32 < np.nonzero(changed)[1].max()


def test_legends_and_colour_bars_are_written(render, tmp_path):
    cloud = write_labelled(tmp_path / "cloud.ply")
    render(cloud, "-o", "plain.png", "--label-map", "semantic_kitti", "--size", "200x150")
    render(cloud, "-o", "legend.png", "--label-map", "semantic_kitti", "--size", "200x150", "--legend")
    render(cloud, "-o", "height.png", "--style", "color_by=height", "--size", "200x150", "--colorbar")
    plain, legend = png.read(tmp_path / "plain.png"), png.read(tmp_path / "legend.png")
    assert (plain != legend).any()
    assert len(colors(tmp_path / "height.png")) > 60  # the bar's entries


def test_colormaps_are_reversed_or_lists_of_colours(render, tmp_path):
    """Three points of the heights 0, 1 and 2 have the first, the middle and the last colour of their map. Entry 128 of
    a map from black to red is 128 / 255 of the way."""
    cloud = tmp_path / "cloud.obj"
    cloud.write_text("v 0 0 0\nv 0 1 0\nv 0 2 0\n")
    common = ["--style", "point_size=9", "--style", "color_by=height", "--style", "lit=false", "--set", "camera.up=+y"]
    render(cloud, "-o", "red.png", *common, "--style", "colormap=#000000,#ff0000")
    assert {(0, 0, 0), (128, 0, 0), (255, 0, 0)} <= colors(tmp_path / "red.png")
    render(cloud, "-o", "grey.png", *common, "--style", "colormap=grey_r", "--style", "color_max=4")
    assert {(255, 255, 255), (191, 191, 191), (127, 127, 127)} <= colors(tmp_path / "grey.png")


def test_unknown_scalars_are_an_error(render, box):
    done = render(box, "-o", "out.png", "--style", "scalar=curvature", code=1)
    assert "no object has scalars 'curvature'" in done.stderr

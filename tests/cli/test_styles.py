"""--style and --label-map."""
import pytest


@pytest.mark.parametrize("text, hint", [
    ("color_by", "--style: expected KEY=VALUE or NAME.KEY=VALUE, got 'color_by'"),
    ("=height", "--style: expected KEY=VALUE"),
    ("colr_by=height", "--style: there is no setting 'style.colr_by' (did you mean 'style.color_by'?)"),
    ("color_by=hight", "(did you mean 'height'?)"),
    ("colormap=virids", "(did you mean 'viridis'?)"),
    ("box.point_size=0", "expected a number of"),
    ("bix.flat=true", "--style: there is no object 'bix' (did you mean 'box'?): the files are called box"),
])
def test_bad_styles_exit_with_2_before_anything_is_drawn(render, box, tmp_path, text, hint):
    done = render(box, "-o", "out.png", "--style", text, code=2)
    assert hint in done.stderr and done.stderr.count("\n") == 1
    assert not (tmp_path / "out.png").exists()


def test_label_maps_are_found_before_anything_is_drawn(render, box, tmp_path):
    assert "did you mean 'cityscapes'" in render(box, "-o", "out.png", "--label-map", "cityscape", code=1).stderr
    assert "none.json" in render(box, "-o", "out.png", "--label-map", "none.json", code=1).stderr
    assert not (tmp_path / "out.png").exists()


def test_a_label_map_without_labels_is_a_warning(render, box):
    assert "'box' has no labels" in render(box, "-o", "out.png", "--label-map", "cityscapes").stderr

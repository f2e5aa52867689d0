"""One picture of each effect against the one that was committed (make.py draws them anew)."""
import json
import pathlib
import sys

import numpy as np
import pytest

import easypbr

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
from effects import EFFECTS, SIZE  # noqa: E402

MANIFEST = json.loads((HERE / "manifest.json").read_text())


def difference(picture, golden):
    """Mean difference in codes of 255, and the part of the pixels that differ by more than 8."""
    codes = abs(picture.astype(int) - golden.astype(int)).max(axis=2)
    return codes.mean(), (codes > 8).mean()


def agrees(picture, golden):
    """Drivers round the places of edges and shadows' texels in their own ways: that is a pixel here and there, mostly on
    edges, of which these pictures have some hundreds in 19,200. What an effect does to a picture is more."""
    mean, part = difference(picture, golden)
    return mean < 0.35 and part < 0.01


@pytest.mark.parametrize("name", EFFECTS)
def test_effect(name, tmp_path):
    golden = easypbr.load_image(HERE / "pictures" / f"{name}.png")
    picture = EFFECTS[name]()
    if not agrees(picture, golden):
        easypbr.save_image(picture, tmp_path / f"{name}.png")
        pytest.fail(f"{name}: mean and part {difference(picture, golden)}; see {tmp_path}")


def test_all_are_there():
    files = sorted(path.stem for path in (HERE / "pictures").glob("*.png"))
    assert files == sorted(EFFECTS) == MANIFEST["pictures"]
    assert list(SIZE) == MANIFEST["size"]


def test_the_comparison_sees_what_matters():
    """No two goldens agree, nor does one with itself moved by a pixel, a little darker, or without a shadow."""
    goldens = {name: easypbr.load_image(HERE / "pictures" / f"{name}.png") for name in EFFECTS}
    for name, golden in goldens.items():
        assert agrees(golden, golden)
        assert not any(agrees(golden, other) for key, other in goldens.items() if key != name), name
        assert not agrees(np.roll(golden, 1, axis=1), golden)
        darker = golden.copy()
        darker[..., :3] = darker[..., :3] * 0.985
        assert not agrees(darker, golden), name

"""One picture of each effect against the one that was committed (make.py draws them anew)."""
import json
import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest

import easypbr

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
from effects import EFFECTS, SIZE  # noqa: E402

# What drivers say of the speed of calls, and why it is left so.
KNOWN_PERFORMANCE_MESSAGES: dict[str, str] = {}

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


def test_the_driver_has_nothing_to_say():
    """No error, and no hint at slow calls that is not listed, in a debug context."""
    environment = {**os.environ, "EASYPBR_DEVICE": "gl", "EASYPBR_NATIVE": "0", "EASYPBR_GL_DEBUG": "1"}
    command = [sys.executable, HERE / "driver_messages.py"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    said = json.loads(done.stdout.splitlines()[-1])
    assert said["device"] == "gl"
    assert said["errors"] == []
    assert set(said["performance"]) <= set(KNOWN_PERFORMANCE_MESSAGES)


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

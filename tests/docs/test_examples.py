"""Every example runs without arguments in an empty folder, and draws its picture; what it claims it asserts itself."""
import re
import subprocess
import sys

import numpy as np
import pytest

import easypbr
from snippets import ROOT

EXAMPLES = sorted((ROOT / "examples").glob("*.py"))

#: Runs an example with pictures of a few pixels. Sizes that an example computes with stay as they are.
SMALL = """
import runpy, sys
import easypbr
recorder = easypbr.viewer.Recorder
original = recorder.record
recorder.record = lambda self, path, size=None, samples=None, deep=False: original(self, path, {size}, 2, deep)
render = easypbr.render
easypbr.render = lambda *a, **k: render(*a, **{{**k, "size": {size}, "samples": 2}})
runpy.run_path(sys.argv[1], run_name="__main__")
"""


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_example_draws_its_picture(example, tmp_path):
    promised = re.findall(r"Writes (\w+)\.png", example.read_text())
    assert len(promised) == 1, "the first lines of an example say what it writes"
    names = [f"{promised[0][:-1]}{n}.png" for n in range(4)] if promised[0].endswith("_N") else [f"{promised[0]}.png"]
    if re.search("^import igl$", example.read_text(), re.MULTILINE):
        pytest.importorskip("igl", reason="libigl is not installed: scripts/setup.sh does")
    code = SMALL.format(size=(96, 72))
    done = subprocess.run([sys.executable, "-c", code, example], cwd=tmp_path, capture_output=True, text=True,
                          timeout=300)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    for name in names:
        picture = easypbr.load_image(tmp_path / name)
        assert picture.shape == (72, 96, 4)
        # The default background is #404040; something else is drawn on at least a tenth of the picture.
        drawn = (picture[:, :, :3] != 0x40).any(axis=2)
        assert 0.1 < drawn.mean() < 1, name
        assert np.ptp(picture[drawn][:, :3].astype(int)) > 30, f"{name} is one flat colour"


def test_every_example_is_found():
    assert len(EXAMPLES) >= 6

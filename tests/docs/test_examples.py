"""Every example runs without arguments in an empty folder, and draws its picture; what it claims it asserts itself."""
import os
import re
import subprocess
import sys

import numpy as np
import pytest

import easypbr
from snippets import ROOT

EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
FIGURES = sorted(path for path in (ROOT / "examples/figures").glob("*.py") if "main(draw)" in path.read_text())

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
        pytest.importorskip("igl", reason="libigl is not installed: `scripts/setup.sh tests` does")
    code = SMALL.format(size=(96, 72))
    done = subprocess.run([sys.executable, "-c", code, example], cwd=tmp_path, capture_output=True, text=True,
                          timeout=300)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    for name in names:
        picture = easypbr.load_image(tmp_path / name)
        assert picture.shape == (72, 96, 4)
        # The default background is #d9d9d9; something else is drawn on at least a tenth of the picture.
        drawn = (picture[:, :, :3] != 0xd9).any(axis=2)
        assert 0.1 < drawn.mean() < 1, name
        assert np.ptp(picture[drawn][:, :3].astype(int)) > 30, f"{name} is one flat colour"


@pytest.mark.parametrize("figure", FIGURES, ids=lambda path: path.stem)
def test_figure_draws_its_picture(figure, tmp_path):
    """Without data; with it the same code draws other meshes."""
    assert f"Writes {figure.stem}.png" in figure.read_text()
    command = [sys.executable, figure, "--scale", "0.2"]
    environment = {name: value for name, value in os.environ.items() if name != "EASYPBR_TEST_DATA"}
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=300, env=environment)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    picture = easypbr.load_image(tmp_path / f"{figure.stem}.png")[:, :, :3].astype(int)
    assert 40 < picture.shape[0] < 160 and 120 < picture.shape[1]
    drawn = (picture != 0xd9).any(axis=2) & (picture != 0xff).any(axis=2)
    assert 0.1 < drawn.mean() < 1
    assert np.ptp(picture[drawn]) > 60


@pytest.mark.skipif("EASYPBR_TEST_DATA" not in os.environ, reason="EASYPBR_TEST_DATA names no folder")
@pytest.mark.parametrize("name", ["bunny_surfels", "eye_dome_lighting"])
def test_figures_draw_real_data(name, tmp_path):
    command = [sys.executable, ROOT / f"examples/figures/{name}.py", "real.png", "--scale", "0.2"]
    subprocess.run(command, cwd=tmp_path, check=True, timeout=300)
    assert np.ptp(easypbr.load_image(tmp_path / "real.png")[:, :, :3]) > 100


def test_every_example_is_found():
    assert len(FIGURES) >= 7
    assert len(EXAMPLES) >= 6

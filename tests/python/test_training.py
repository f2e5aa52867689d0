"""The example that trains, and the figure made of a data set, in a short form."""

import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest

import easypbr

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples"


def run(script, folder, *arguments) -> str:
    done = subprocess.run([sys.executable, EXAMPLES / script, *arguments], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_a_network_learns_parts_of_clouds(tmp_path):
    """Of three classes a third would be right by chance; the ground alone is told by its height."""
    right = float(re.match(r"([\d.]+) of", run("training/segment_clouds.py", tmp_path, "--steps", "40"))[1])
    assert right > 0.6
    assert np.ptp(easypbr.load_image(tmp_path / "segmentation.png")[..., :3]) > 100


def test_a_detector_learns_drones(tmp_path):
    """An untrained network finds next to nothing: boxes must overlap by a half, and there are 300 places for them."""
    said = run("training/detect_drones.py", tmp_path, "--pictures", "80", "--steps", "70")
    assert float(re.match(r"average precision ([\d.]+) at", said)[1]) > 0.15
    picture = easypbr.load_image(tmp_path / "detection.png")
    assert picture.shape == (480, 640, 3)
    assert (picture == (255, 255, 255)).all(-1).sum() > 50  # the true boxes' lines


@pytest.mark.parametrize("count", [1])
def test_figure_7_shows_boxes(tmp_path, count):
    run("figures/figure_07_drone_boxes.py", tmp_path, "--count", str(count))
    picture = easypbr.load_image(tmp_path / "drone_boxes.png")
    assert picture.shape == (480, 480 * count, 3)
    assert (picture == (230, 80, 60)).all(-1).sum() > 500  # the colour of the boxes' lines


def test_a_fit_is_served_while_it_runs(tmp_path):
    said = run("training/watch_fit.py", tmp_path, "--steps", "60")
    assert re.match(r"http://127.0.0.1:\d+/#token=\w+\n", said)
    before, after = map(float, re.search(r"loss ([\d.]+) before, ([\d.]+) after", said).groups())
    assert after < before / 2
    assert np.ptp(easypbr.load_image(tmp_path / "fit.png")[..., :3]) > 50

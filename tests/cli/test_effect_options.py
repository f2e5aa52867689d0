"""Bloom and depth of field from the command line."""
import re

import numpy as np
import pytest

import png

FRONT = ("--camera-position", "0,0,5", "--camera-target", "0,0,0")


@pytest.fixture
def picture(render, tmp_path):
    def draw(*arguments):
        render(*arguments, "-o", "out.png")
        return png.read(tmp_path / "out.png").astype(float)

    return draw


def test_bloom_glows_beyond_the_object(picture, sphere):
    options = (sphere, *FRONT, "--set", "material.emissive=white", "--exposure", "8", "--background", "black")
    plain, glowing = picture(*options), picture(*options, "--set", "bloom.enabled=true")
    outside = plain[:, :, 0] == 0
    assert glowing[outside][:, 0].mean() > plain[outside][:, 0].mean() + 5


def test_focus_is_the_depth_that_a_pixel_shows(render, sphere, tmp_path):
    render(sphere, *FRONT, "--focus", "32,24", "-o", "out.png", "--save-settings", "out.json")
    text = (tmp_path / "out.json").read_text()
    distance = float(re.search(r'"focus_distance": ([\d.]+)', text)[1])
    assert distance == pytest.approx(4, abs=0.01)  # the sphere's front: 5 - 1


def test_what_is_out_of_focus_is_softer(picture, sphere):
    options = (sphere, *FRONT, "--set", "depth_of_field.f_number=0.5", "--set", "depth_of_field.sensor_height=1")
    sharp, soft = picture(sphere, *FRONT), picture(*options, "--focus", "32,24", "--samples", "32")
    assert np.abs(np.diff(soft[24, :, 0])).max() < 0.6 * np.abs(np.diff(sharp[24, :, 0])).max()


@pytest.mark.parametrize("focus, complaint", [
    ("32", "expected the pixel X,Y, got '32'"),
    ("a,b", "expected the pixel X,Y"),
    ("1,2,3", "expected the pixel X,Y"),
])
def test_a_focus_that_is_no_pixel_is_refused(render, sphere, focus, complaint):
    assert complaint in render(sphere, "--focus", focus, "-o", "out.png", code=2).stderr


def test_a_pixel_that_shows_nothing_is_refused(render, sphere):
    assert "shows nothing" in render(sphere, *FRONT, "--focus", "0,0", "-o", "out.png", code=1).stderr


def test_a_focus_outside_of_the_picture_is_refused(render, sphere):
    outside = render(sphere, *FRONT, "--focus", "64,0", "-o", "out.png", code=2).stderr
    assert "expected a pixel of the picture" in outside


@pytest.mark.parametrize("setting", [
    "bloom.intensity=-1", "bloom.levels=0", "bloom.levels=9", "bloom.threshold=-1", "bloom.knee=2",
    "depth_of_field.f_number=0", "depth_of_field.f_number=-2", "depth_of_field.focus_distance=0",
    "depth_of_field.sensor_height=-1", "motion_blur.shutter=1.5",
])
def test_values_out_of_range_are_refused(render, sphere, setting):
    assert setting.split("=")[0] in render(sphere, "--set", setting, "-o", "out.png", code=2).stderr

"""`easypbr thumbnail`, and the files that tell file managers about it."""
import configparser
import pathlib
import re
import shlex
import subprocess
import xml.etree.ElementTree

import pytest

import png
from binary import BINARY

DESKTOP = pathlib.Path(__file__).resolve().parents[2] / "cmake" / "desktop"


def test_objects_stand_on_nothing(easypbr, sphere, tmp_path):
    easypbr("thumbnail", sphere, "-o", "ball.png", "--size", "64")
    pixels = png.read(tmp_path / "ball.png")
    assert pixels.shape == (64, 64, 4)
    assert pixels[0, 0, 3] == 0 and pixels[32, 32, 3] == 255
    # A ball that fills most of the square: pi / 4 of the square that bounds it.
    assert 0.3 < (pixels[..., 3] > 127).mean() < 0.786


def test_pictures_are_png_whatever_the_name(easypbr, sphere, tmp_path):
    easypbr("thumbnail", sphere, "-o", "ball.tmp")
    assert png.read(tmp_path / "ball.tmp").shape == (256, 256, 4)


def test_a_dash_is_standard_output(easypbr, sphere, tmp_path):
    easypbr("thumbnail", sphere, "-o", "ball.png", "--size", "32")
    written = easypbr("thumbnail", sphere, "-o", "-", "--size", "32", text=False).stdout
    assert written == (tmp_path / "ball.png").read_bytes()
    assert not (tmp_path / "-").exists()


def test_users_defaults_count(easypbr, environment, sphere, tmp_path, monkeypatch):
    monkeypatch.setitem(environment, "XDG_CONFIG_HOME", str(tmp_path))
    (tmp_path / "easypbr").mkdir()
    (tmp_path / "easypbr/config.json").write_text('[{"files": "*.obj", "settings": {"material.color": "#ff0000"}}]')
    easypbr("thumbnail", sphere, "-o", "red.png", "--size", "32")
    red, green, *_ = png.read(tmp_path / "red.png")[16, 16].tolist()
    assert red > 2 * green


@pytest.mark.parametrize("arguments, code, message", [
    ((), 2, "expected a mesh file"),
    (("ball.obj",), 2, "expected an output file"),
    (("ball.obj", "-o", "x.png", "--size", "0"), 2, "expected 1 to 4096, got 0"),
    (("none.obj", "-o", "x.png"), 1, "none.obj"),
])
def test_mistakes_are_named(easypbr, tmp_path, arguments, code, message):
    assert message in easypbr("thumbnail", *arguments, code=code).stderr
    assert not (tmp_path / "x.png").exists()


def test_a_damaged_file_leaves_no_picture(easypbr, tmp_path):
    (tmp_path / "half.ply").write_text("ply\nformat ascii 1.0\nelement vertex 3\n")
    assert "half.ply" in easypbr("thumbnail", "half.ply", "-o", "x.png", code=1).stderr
    assert "would write over half.ply" in easypbr("thumbnail", "half.ply", "-o", "half.ply", code=2).stderr
    assert not (tmp_path / "x.png").exists()


def test_the_thumbnailer_calls_the_command(environment, sphere, tmp_path):
    """As a file manager does (freedesktop.org's thumbnail managers; %i input, %o output, %s pixels)."""
    entry = configparser.ConfigParser(interpolation=None)
    entry.read(DESKTOP / "easypbr.thumbnailer")
    values = {"%i": str(sphere), "%o": str(tmp_path / "thumbnail"), "%s": "128"}
    words = [values.get(word, word) for word in shlex.split(entry["Thumbnailer Entry"]["Exec"])]
    assert words[0] == entry["Thumbnailer Entry"]["TryExec"] == "easypbr"
    subprocess.run([BINARY, *words[1:]], env=environment, check=True, timeout=60)
    assert png.read(tmp_path / "thumbnail").shape == (128, 128, 4)


def test_types_of_files_are_all_known():
    """Those of the thumbnailer are ours or stand in shared-mime-info 2.2."""
    tree = xml.etree.ElementTree.parse(DESKTOP / "easypbr.xml")
    own = {node.get("type") for node in tree.findall("{*}mime-type")}
    types = set(re.search(r"MimeType=(.*);", (DESKTOP / "easypbr.thumbnailer").read_text())[1].split(";"))
    assert types - own == {"model/gltf-binary", "model/gltf+json", "model/obj", "model/stl"}
    assert own <= types

"""The program ffmpeg that imageio-ffmpeg brings."""
import sys
import types

import pytest

from easypbr.video import find_ffmpeg


def installed(monkeypatch, get_ffmpeg_exe):
    module = types.ModuleType("imageio_ffmpeg")
    setattr(module, "get_ffmpeg_exe", get_ffmpeg_exe)
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", module)


def test_what_imageio_ffmpeg_names(monkeypatch):
    installed(monkeypatch, lambda: "/opt/ffmpeg-linux64-v7")
    assert find_ffmpeg() == "/opt/ffmpeg-linux64-v7"


def test_nothing_without_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)  # An import of it fails.
    assert find_ffmpeg() == ""


def test_nothing_where_it_has_no_program(monkeypatch):
    def fail():
        raise RuntimeError("No ffmpeg exe could be found.")

    installed(monkeypatch, fail)
    assert find_ffmpeg() == ""


def test_other_errors_are_not_hidden(monkeypatch):
    installed(monkeypatch, lambda: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        find_ffmpeg()

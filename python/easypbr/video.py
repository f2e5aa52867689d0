"""Finds a program `ffmpeg` for videos, where neither FFmpeg's libraries nor PATH have one."""

import importlib
from typing import Any


def find_ffmpeg() -> str:
    """Path of the program that imageio-ffmpeg brings or knows (pip install imageio-ffmpeg); empty without it."""
    try:
        imageio_ffmpeg: Any = importlib.import_module("imageio_ffmpeg")  # It has no types.
        return str(imageio_ffmpeg.get_ffmpeg_exe())
    except (ImportError, RuntimeError):
        return ""

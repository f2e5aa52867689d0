"""A display without a screen: Xvfb with a window manager, mouse and keyboard by xdotool, pictures of the screen."""
import os
import pathlib
import shutil
import struct
import subprocess
import time

import numpy as np

TOOLS = ("Xvfb", "openbox", "xdotool", "wmctrl", "xclip")


def missing_tools():
    return [tool for tool in TOOLS if not shutil.which(tool)]


class Display:
    """Closed at the end of a with block."""

    def __init__(self, folder: pathlib.Path, manager: bool = True):
        reader, writer = os.pipe()
        self.framebuffer = folder / "Xvfb_screen0"
        self._processes = [subprocess.Popen(
            ["Xvfb", "-displayfd", str(writer), "-screen", "0", "1600x1000x24", "-fbdir", str(folder), "-nolisten", "tcp", "-noreset"],
            pass_fds=[writer], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)]
        os.close(writer)
        with os.fdopen(reader) as numbers:
            self.name = ":" + numbers.readline().strip()
        self.environment = {**os.environ, "DISPLAY": self.name}
        if manager:
            # It names itself before it is ready, and loses what programs ask of it in between.
            ready = folder / "ready"
            self._start("openbox", "--startup", f"touch {ready}")
            wait_until(ready.exists)

    def _start(self, *command):
        self._processes.append(subprocess.Popen(command, env=self.environment, stdout=subprocess.DEVNULL,
                                                stderr=subprocess.DEVNULL))

    def run(self, *command, check=True):
        return subprocess.run(command, env=self.environment, check=check, capture_output=True, text=True, timeout=60)

    def windows(self) -> list[str]:
        """Titles of the windows that the window manager knows."""
        return [line.split(None, 3)[-1] for line in self.run("wmctrl", "-l", check=False).stdout.splitlines()]

    def place(self, title: str) -> tuple[int, int]:
        """Screen coordinates of a window's top left pixel."""
        window = self.run("xdotool", "search", "--name", title).stdout.split()[-1]
        # By way of the pointer: getwindowgeometry counts the window manager's frame twice.
        self.run("xdotool", "mousemove", "--window", window, "0", "0")
        location = self.run("xdotool", "getmouselocation", "--shell").stdout.split()
        values = dict(line.split("=") for line in location)
        return int(values["X"]), int(values["Y"])

    def screen(self) -> np.ndarray:
        """The screen as it is now, height x width x 3 (X Window Dump, version 7)."""
        data = self.framebuffer.read_bytes()
        header = struct.unpack(">25I", data[:100])
        width, height, row, colors = header[4], header[5], header[12], header[19]
        start = header[0] + 12 * colors
        pixels = np.frombuffer(data, np.uint8, row * height, start).reshape(height, row)[:, : 4 * width]
        return pixels.reshape(height, width, 4)[:, :, 2::-1]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()

    def stop(self):
        for process in reversed(self._processes):
            process.terminate()
            process.wait(10)


def wait_until(condition, seconds=30):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.02)

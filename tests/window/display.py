"""A display without a screen: Xvfb with a window manager, mouse and keyboard by xdotool, pictures of the screen."""
import ctypes
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

    def __init__(self, folder: pathlib.Path, manager: bool = True, dpi: int | None = None):
        reader, writer = os.pipe()
        self.framebuffer = folder / "Xvfb_screen0"
        self._processes = [subprocess.Popen(
            ["Xvfb", "-displayfd", str(writer), "-screen", "0", "1600x1000x24", "-fbdir", str(folder), "-nolisten", "tcp", "-noreset"],
            pass_fds=[writer], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)]
        os.close(writer)
        with os.fdopen(reader) as numbers:
            self.name = ":" + numbers.readline().strip()
        self.environment = {**os.environ, "DISPLAY": self.name}
        if dpi:
            set_resources(self.name, f"Xft.dpi:\t{dpi}\n")
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


def set_resources(display: str, text: str) -> None:
    """What xrdb does: programs read the resources from a property of the root window."""
    x11 = ctypes.CDLL("libX11.so.6")
    x11.XOpenDisplay.restype = ctypes.c_void_p
    x11.XDefaultRootWindow.argtypes = x11.XCloseDisplay.argtypes = [ctypes.c_void_p]
    x11.XDefaultRootWindow.restype = ctypes.c_ulong
    x11.XChangeProperty.argtypes = [ctypes.c_void_p, *[ctypes.c_ulong] * 3, ctypes.c_int, ctypes.c_int, ctypes.c_char_p,
                                    ctypes.c_int]
    resource_manager, string, replace = 23, 31, 0  # Xatom.h
    connection = x11.XOpenDisplay(display.encode())
    x11.XChangeProperty(connection, x11.XDefaultRootWindow(connection), resource_manager, string, 8, replace, text.encode(),
                        len(text))
    x11.XCloseDisplay(connection)


def wait_until(condition, seconds=30):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.02)

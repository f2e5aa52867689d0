"""Windows are driven as a person drives them, on a display of the tests' own."""
import os
import pathlib
import sys
import tempfile

import pytest

# The executable is found as by the tests of the command line.
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))

_cache = tempfile.TemporaryDirectory(prefix="easypbr-test-cache-")
os.environ["EASYPBR_CACHE_DIR"] = _cache.name
os.environ["EASYPBR_LEAK_WARNINGS"] = "1"  # of this process and of those that tests start

import easypbr  # noqa: E402
from display import Display, missing_tools  # noqa: E402


@pytest.fixture(scope="session")
def display(tmp_path_factory):
    missing = missing_tools()
    assert not missing, f"not installed: {missing} (`scripts/setup.sh tests` installs them)"
    display = Display(tmp_path_factory.mktemp("display"))
    os.environ["DISPLAY"] = display.name
    yield display
    display.stop()


class Window:
    """A viewer with its window, and the mouse and keyboard that act on it."""

    def __init__(self, display, view):
        self.display, self.view = display, view
        self.settle()
        self.title = next(title for title in display.windows() if "EasyPBR" in title)
        self.left, self.top = display.place(self.title)

    @property
    def state(self):
        return self.view._handle.gui_state()

    def update(self, times=1):
        return [self.view.update() for _ in range(times)][-1]

    def settle(self):
        """Until the picture is refined and events of the window manager have come."""
        for _ in range(2000):
            self.update()
            if self.state["frames"] == self.state["total"] > 0:
                return self.update(5)
        raise AssertionError("never ready")

    def send(self, *words):
        """xdotool's words; positions are the window's."""
        words = list(map(str, words))
        for i, word in enumerate(words):
            if word == "mousemove":
                words[i + 1] = str(self.left + int(words[i + 1]))
                words[i + 2] = str(self.top + int(words[i + 2]))
        self.display.run("xdotool", *words)

    def mouse(self, *words):
        """The same, taken at once."""
        self.send(*words)
        self.update(3)

    def key(self, *names):
        for name in names:
            self.display.run("xdotool", "key", name)
            self.update(4)

    def shown(self):
        """The window's part of the screen."""
        width, height = self.state["size"]
        return self.display.screen()[self.top : self.top + height, self.left : self.left + width]


@pytest.fixture
def window(display):
    scene = easypbr.Scene()
    scene.show(easypbr.shapes.sphere(1, 32), "ball")
    view = easypbr.Viewer((800, 600), {"image": {"samples": 4}}, scene=scene)
    yield Window(display, view)
    view.close()

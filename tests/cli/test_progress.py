"""The progress bar of long loads: on a terminal only, and never with --quiet."""
import os
import pty
import re
import select
import signal
import subprocess
import time

import pytest

from binary import BINARY


@pytest.fixture(scope="module")
def large(tmp_path_factory):
    """Beyond the 50 MB from which on progress is reported."""
    path = tmp_path_factory.mktemp("large") / "large.obj"
    path.write_bytes(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" + b"v 0.1234567 0.2345678 0.3456789\n" * 6_000_000)
    yield path
    path.unlink()


def hold_up(process):
    """Stops it for a while; again and again, so that it takes seconds on any machine."""
    process.send_signal(signal.SIGSTOP)
    time.sleep(0.3)
    process.send_signal(signal.SIGCONT)


def said_on_a_terminal(environment, *arguments, until=None):
    """What it says; it is held up until it says what is expected."""
    master, terminal = pty.openpty()
    one_core = {min(os.sched_getaffinity(0))}
    process = subprocess.Popen([str(BINARY), *map(str, arguments)], stderr=terminal, env=environment,
                               preexec_fn=lambda: os.sched_setaffinity(0, one_core))
    os.close(terminal)
    said = b""
    try:
        while True:
            if until and not re.search(until, said):
                hold_up(process)
            if not select.select([master], [], [], 0.02)[0]:
                continue
            if not (piece := os.read(master, 4096)):
                break
            said += piece
    except OSError:
        pass  # Linux reports the end of a terminal as an error
    os.close(master)
    assert process.wait(timeout=120) == 0
    return said.decode()


def test_bar_is_shown_on_a_terminal_and_erased(environment, large, tmp_path):
    said = said_on_a_terminal(environment, "render", large, "-o", tmp_path / "a.png", "--size", "8x8", "--samples", "1",
                              until=rb"%")
    assert "%" in said and "large.obj" in said
    assert said.endswith("\r\033[K")


def test_no_bar_when_quiet_or_not_on_a_terminal(environment, easypbr, large, tmp_path):
    arguments = ("render", large, "-o", tmp_path / "a.png", "--size", "8x8", "--samples", "1")
    assert said_on_a_terminal(environment, *arguments, "--quiet") == ""
    assert easypbr(*arguments).stderr == ""


@pytest.fixture
def small(tmp_path):
    path = tmp_path / "small.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    return path


def test_a_still_of_more_than_two_seconds_shows_the_time_left(environment, small, tmp_path):
    said = said_on_a_terminal(environment, "render", small, "-o", tmp_path / "a.png", "--size", "1600x1200", "--samples", "48")
    found = re.findall(r"picture: sample (\d+) of 48, (\d+):(\d\d) left", said)
    assert found and said.endswith("\r\033[K")
    samples = [int(sample) for sample, _, _ in found]
    assert samples == sorted(samples) and samples[-1] < 48


def test_a_quick_still_says_nothing(environment, easypbr, small, tmp_path):
    arguments = ("render", small, "-o", tmp_path / "a.png", "--size", "16x16", "--samples", "1")
    assert said_on_a_terminal(environment, *arguments) == ""


def test_convert_says_which_step_runs(environment, tmp_path):
    grid = tmp_path / "grid.obj"
    side = 100
    vertices = "".join(f"v {x} {y} {x * y % 7}\n" for y in range(side) for x in range(side))
    faces = "".join(f"f {i} {i + 1} {i + side}\n" for i in range(1, side * (side - 1)) if i % side)
    grid.write_text(vertices + faces)
    smooths = rb"--smooth, 2 of 3, for 0:\d\d"
    said = said_on_a_terminal(environment, "convert", grid, tmp_path / "a.ply", "--smooth", "30000", until=smooths)
    assert re.search(smooths, said.encode()) and said.endswith("\r\033[K")
    assert said_on_a_terminal(environment, "convert", grid, tmp_path / "a.ply", "--smooth", "1") == ""

"""Images that are shown in the terminal."""
import base64
import fcntl
import os
import pty
import re
import struct
import subprocess
import termios
import threading

import numpy as np
import pytest

import png
from binary import BINARY

SIZE = ("--size", "64x48", "--samples", "1")
NAMES = ("TERM", "TERM_PROGRAM", "LC_TERMINAL", "COLORTERM", "EASYPBR_TERMINAL")


@pytest.fixture
def shown(environment, tmp_path):
    """What `easypbr render` writes to a terminal of some rows and columns (and pixels)."""

    def run(*arguments, window=(50, 100, 0, 0), code=0, **variables):
        master, slave = pty.openpty()
        attributes = termios.tcgetattr(slave)
        attributes[1] &= ~termios.OPOST  # no carriage returns
        termios.tcsetattr(slave, termios.TCSANOW, attributes)
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", *window))
        kept = {name: value for name, value in environment.items() if name not in NAMES}
        parts = []

        def read():
            try:
                while part := os.read(master, 1 << 16):
                    parts.append(part)
            except OSError:  # the other end is closed
                pass

        reader = threading.Thread(target=read)
        reader.start()
        done = subprocess.run([str(BINARY), "render", *map(str, arguments)], stdout=slave, stderr=subprocess.PIPE,
                              env={**kept, **variables}, cwd=tmp_path, timeout=300, check=False, text=True)
        os.close(slave)
        reader.join()
        os.close(master)
        assert done.returncode == code, done.stderr
        return b"".join(parts).decode() if code == 0 else done.stderr

    return run


@pytest.fixture
def expected(render, sphere, tmp_path):
    render(sphere, "-o", "expected.png", *SIZE)
    return png.read(tmp_path / "expected.png")


def kitty_png(text: str) -> bytes:
    parts = re.findall(r"\x1b_G([^;]*);([^\x1b]*)\x1b\\", text)
    assert parts[0][0] == "a=T,f=100,q=2,m=1" and parts[-1][0] == "m=0"
    assert all(keys == "m=1" for keys, _ in parts[1:-1]) and all(len(data) <= 4096 for _, data in parts)
    assert re.sub(r"\x1b_G[^\x1b]*\x1b\\", "", text) == "\n"
    return base64.b64decode("".join(data for _, data in parts), validate=True)


def iterm_png(text: str) -> bytes:
    (data,) = re.fullmatch(r"\x1b\]1337;File=inline=1;width=64px;height=48px:([^\a]*)\a\n", text).groups()
    return base64.b64decode(data, validate=True)


@pytest.mark.parametrize("decoded, variables", [
    (kitty_png, {"TERM": "xterm-kitty"}), (kitty_png, {"TERM_PROGRAM": "WezTerm"}), (kitty_png, {"EASYPBR_TERMINAL": "kitty"}),
    (iterm_png, {"TERM_PROGRAM": "iTerm.app"}), (iterm_png, {"EASYPBR_TERMINAL": "iterm", "TERM": "xterm-kitty"}),
])
def test_the_terminal_gets_the_file_that_would_be_written(shown, sphere, expected, tmp_path, decoded, variables):
    (tmp_path / "seen.png").write_bytes(decoded(shown(sphere, *SIZE, **variables)))
    np.testing.assert_array_equal(png.read(tmp_path / "seen.png")[..., :3], expected[..., :3])


def decode_sixel(text: str) -> np.ndarray:
    """RGB, 0 to 1; NaN where nothing is drawn."""
    header, width, height, body = re.fullmatch(r'\x1bP0;1q("1;1;(\d+);(\d+))(.*)\x1b\\\n', text, re.DOTALL).groups()
    colors, picture = {}, np.full((int(height), int(width), 3), np.nan)
    x = top = color = 0
    for number, rgb, count, six, control in re.findall(r"#(\d+)(?:;2;(\d+;\d+;\d+))?|(?:!(\d+))?([?-~])|([$-])", body):
        if rgb:
            colors[number] = np.array([int(part) for part in rgb.split(";")]) / 100
        elif number:
            color = colors[number]
        elif six:
            for row in range(6):
                if (ord(six) - 63) >> row & 1:
                    assert np.isnan(picture[top + row, x : x + int(count or 1)]).all(), "each pixel once"
                    picture[top + row, x : x + int(count or 1)] = color
            x += int(count or 1)
        else:
            x = 0
            top += 6 * (control == "-")
    return picture


@pytest.mark.parametrize("variables", [{"TERM": "foot"}, {"EASYPBR_TERMINAL": "sixel"}])
def test_sixels_are_the_picture_dithered(shown, sphere, expected, variables):
    seen = decode_sixel(shown(sphere, *SIZE, **variables))
    exact = expected[..., :3] / 255
    assert seen.shape == exact.shape
    # A pixel is one of the two palette's colours beside its own; percent are whole numbers.
    assert abs(seen - exact).max() <= 1 / 5 + 0.01
    # The mean over the dithering's pattern of 4 x 4 is exact to a step of it, but for the pixels' own differences.
    means = [array.reshape(12, 4, 16, 4, 3).mean(axis=(1, 3)) for array in (seen, exact)]
    spread = np.ptp(exact.reshape(12, 4, 16, 4, 3), axis=(1, 3))
    assert (abs(means[0] - means[1]) <= 1 / 5 / 16 + 0.01 + spread / 2).all()


def test_what_is_transparent_is_left_out_of_sixels(shown, sphere):
    seen = decode_sixel(shown(sphere, *SIZE, "--background", "transparent", EASYPBR_TERMINAL="sixel"))
    assert np.isnan(seen[0, 0]).all() and not np.isnan(seen[24, 32]).any()


def test_blocks_are_two_pixels_each(shown, sphere, expected):
    lines = shown(sphere, *SIZE, TERM="xterm-256color", COLORTERM="truecolor").splitlines()
    assert len(lines) == 24
    for row, line in enumerate(lines):
        cells = re.findall(r"\x1b\[0m\x1b\[38;2;(\d+);(\d+);(\d+)m\x1b\[48;2;(\d+);(\d+);(\d+)m\u2580", line)
        colors = np.array(cells, int).reshape(64, 2, 3).transpose(1, 0, 2)
        np.testing.assert_array_equal(colors, expected[2 * row : 2 * row + 2, :, :3])


def test_the_picture_has_room(shown, sphere):
    """24 rows, one of which is the prompt's: 46 pixels of blocks; 460 of 480 pixels."""
    assert len(shown(sphere, "--samples", "1", window=(24, 80, 0, 0), EASYPBR_TERMINAL="blocks").splitlines()) == 23
    text = shown(sphere, "--samples", "1", window=(24, 80, 640, 480), EASYPBR_TERMINAL="iterm")
    assert "width=613px;height=460px" in text
    assert "width=640px;height=480px" in shown(sphere, "--samples", "1", "--size", "640x480", EASYPBR_TERMINAL="iterm")


@pytest.mark.parametrize("variables", [{"TERM": "dumb"}, {"TERM": "tmux-256color"}, {"EASYPBR_TERMINAL": "none"}])
def test_terminals_without_images_are_an_error(shown, sphere, variables):
    (line,) = shown(sphere, *SIZE, code=2, **variables).splitlines()
    assert line.startswith(
        "easypbr: error: render: this terminal is not known to show images: expected -o OUT.png, or EASYPBR_TERMINAL")


def test_what_needs_a_file_says_so(shown, easypbr, sphere):
    assert "EASYPBR_TERMINAL: expected kitty" in shown(sphere, code=1, EASYPBR_TERMINAL="vt100")
    for more in (["--turntable", "3"], ["--batch"], ["--layers", "depth"], ["--bit-depth", "16"]):
        assert "expected -o" in shown(sphere, *more, code=2, EASYPBR_TERMINAL="kitty")
    assert "expected -o" in easypbr("render", sphere, code=2).stderr, "no terminal"

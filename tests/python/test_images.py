import numpy as np
import pytest

import easypbr
from easypbr import load_image, save_image


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize("shape", [(5, 7), (5, 7, 3), (5, 7, 4)])
def test_png_round_trip(tmp_path, dtype, shape):
    picture = np.random.default_rng(1).integers(0, np.iinfo(dtype).max, shape, dtype)
    save_image(picture, tmp_path / "a.png")
    loaded = load_image(tmp_path / "a.png")
    assert loaded.dtype == dtype
    np.testing.assert_array_equal(loaded, picture)


@pytest.mark.parametrize("channels", [3, 4])
def test_exr_round_trip(tmp_path, channels):
    picture = np.random.default_rng(1).random((5, 7, channels)).astype(np.float32) * 100
    save_image(picture, tmp_path / "a.exr")
    np.testing.assert_array_equal(load_image(tmp_path / "a.exr"), picture)


def test_floats_are_srgb_encoded_for_png(tmp_path):
    # Linear 0.5 is sRGB 1.055 * 0.5^(1/2.4) - 0.055 = 0.73536, byte 187.5: 187 or 188.
    save_image(np.full((2, 2, 3), 0.5), tmp_path / "a.png")
    assert abs(int(load_image(tmp_path / "a.png")[0, 0, 0]) - 187.5) <= 0.5


def test_strided_pictures(tmp_path):
    picture = np.arange(4 * 6 * 3, dtype=np.uint8).reshape(4, 6, 3)
    save_image(picture[::-1, ::2], tmp_path / "a.png")
    np.testing.assert_array_equal(load_image(tmp_path / "a.png"), picture[::-1, ::2])


@pytest.mark.parametrize("shape", [(3,), (0, 4, 3), (4, 4, 5), (1, 2, 3, 4)])
def test_what_is_no_picture(tmp_path, shape):
    with pytest.raises(ValueError, match="image"):
        save_image(np.zeros(shape, np.uint8), tmp_path / "a.png")
    with pytest.raises(ValueError, match="expected.*uint8, uint16 or float, got 4 x 4 int64"):
        save_image(np.zeros((4, 4), np.int64), tmp_path / "a.png")
    assert list(tmp_path.iterdir()) == []


def test_errors_are_the_matching_builtins(tmp_path):
    with pytest.raises(OSError, match="none.png"):
        load_image(tmp_path / "none.png")
    (tmp_path / "bad.png").write_bytes(b"\x89PNG\r\n\x1a\nrubbish")
    with pytest.raises(easypbr.FormatError, match="bad.png"):
        load_image(tmp_path / "bad.png")
    with pytest.raises(ValueError, match="extension 'pgn'"):
        save_image(np.zeros((2, 2), np.uint8), tmp_path / "a.pgn")


def test_comparison():
    a = np.zeros((2, 2, 3), np.uint8)
    b = a.copy()
    b[0, 0] = 3
    difference = easypbr.compare_images(a, b)
    # One of four pixels differs, by 3 in all its channels: mean 3 / 4.
    assert difference["max"] == 3 and difference["different"] == 1 and difference["mean"] == 0.75


def test_what_a_format_cannot_hold_is_refused_before_it_is_drawn(tmp_path, monkeypatch):
    def draw(*args, **kwargs):
        raise AssertionError("drawn")

    monkeypatch.setattr(easypbr.Viewer, "render", draw)
    with pytest.raises(ValueError, match="65536x1 pixels, jpg holds at most 65500"):
        easypbr.render(easypbr.shapes.box(), tmp_path / "a.jpg", size=(65536, 1))
    for name in ("a.jpg", "a.hdr"):
        with pytest.raises(ValueError, match="has no transparency; write a PNG or EXR, or choose another background"):
            easypbr.render(easypbr.shapes.box(), tmp_path / name, size=(8, 8), background="transparent")
    assert not list(tmp_path.iterdir())

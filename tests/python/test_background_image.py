"""Images behind everything, larger than the picture."""

import json
from pathlib import Path

import numpy as np
import pytest

import easypbr


def background(pixels, size, folder, suffix=".png", **settings):
    """What a picture shows of it where nothing else is."""
    easypbr.save_image(pixels, folder / f"back{suffix}")
    far = easypbr.shapes.box((1e-3, 1e-3, 1e-3))
    camera = {"position": (0, 0, 5), "target": (0, 3, 0)}
    return easypbr.render(far, size=size, samples=1, background=str(folder / f"back{suffix}"), camera=camera, **settings)


def encoded(linear):
    return 255 * np.where(linear > 0.0031308, 1.055 * linear ** (1 / 2.4) - 0.055, 12.92 * linear)


def test_fine_patterns_are_averaged(tmp_path):
    # A checker of single pixels, 65 of them for each of the picture: their mean is 0.5 in linear light, the code 187.5
    # (see test_images). Each pixel of the picture takes between one and two texels of 64 x 64 pixels: none is alone.
    checker = (np.indices((65 * 16, 65 * 24)).sum(0) % 2 * 255).astype(np.uint8)
    picture = background(checker, (24, 16), tmp_path)
    assert np.abs(picture[..., :3].astype(int) - 187.5).max() <= 0.5


@pytest.mark.parametrize("width", [1028, 1029, 1030, 1031])
def test_smaller_levels_stay_in_place(tmp_path, width):
    # Columns up to 1024 are black, the others white; four texels and a bit for each pixel. The level of a quarter has
    # 257 columns, and begins where the image does. A pixel's middle lies at the texel (x + 0.5) / 257 * width / 4.
    edge = np.zeros((80, width), np.uint8)  # higher than the picture is wide: all columns are seen
    edge[:, 1024:] = 255
    picture = background(edge, (257, 16), tmp_path)
    middle = (np.arange(257) + 0.5) / 257 * width / 4
    # A hundredth of a texel: drivers may round texture coordinates to 1/256. And half a code.
    least, most = (encoded(np.clip(middle - 255.5 + error, 0, 1)) for error in (-0.01, 0.01))
    assert ((picture[8, :, 0] >= least - 0.501) & (picture[8, :, 0] <= most + 0.501)).all()


@pytest.mark.parametrize("orientation", range(1, 9))
def test_photographs_are_upright(tmp_path, orientation):
    # Pillow turns them by itself: what it makes of the stored pixels is the background.
    Image = pytest.importorskip("PIL.Image")
    ImageOps = pytest.importorskip("PIL.ImageOps")
    exif = (b"Exif\0\0MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0" + bytes([orientation])) + bytes(6)
    pixels = np.random.default_rng(orientation).integers(0, 256, (16, 24, 3), np.uint8)
    Image.fromarray(pixels).save(tmp_path / "photo.jpg", exif=exif, quality=100, subsampling=0)
    stored = easypbr.load_image(tmp_path / "photo.jpg")
    assert stored.shape == (16, 24, 3)  # as it is
    photo = Image.fromarray(stored)
    photo.getexif()[0x112] = orientation
    upright = np.asarray(ImageOps.exif_transpose(photo))
    far = easypbr.shapes.box((1e-3, 1e-3, 1e-3))
    camera = {"position": (0, 0, 5), "target": (0, 3, 0)}
    size = upright.shape[1::-1]
    picture = easypbr.render(far, size=size, samples=1, background=tmp_path / "photo.jpg", camera=camera)
    assert np.array_equal(picture[..., :3], upright)


def test_floats_that_are_no_numbers_are_replaced(tmp_path, caplog):
    pixels = np.full((640, 1000, 3), 0.25, np.float32)
    pixels[600:, ::100] = np.nan
    picture = background(pixels, (50, 32), tmp_path, ".exr")
    assert "1200 values that are NaN or infinite were replaced by 0" in caplog.text
    # 1.055 * 0.25^(1/2.4) - 0.055 = 0.537, the code 136.96.
    assert (picture[:28, :, :3] == 137).all() and (picture[..., 3] == 255).all()


def test_a_named_image_is_that_of_the_folder_it_was_given_in(tmp_path, monkeypatch):
    (tmp_path / "sub").mkdir()
    easypbr.save_image(np.full((4, 4, 3), (255, 0, 0), np.uint8), tmp_path / "back.png")
    easypbr.save_image(np.full((4, 4, 3), (0, 0, 255), np.uint8), tmp_path / "sub" / "back.png")
    monkeypatch.chdir(tmp_path)
    easypbr.shapes.box((1e-3, 1e-3, 1e-3)).save("far.ply")
    scene = easypbr.Scene()
    scene.show(easypbr.Mesh("far.ply"), "far")
    camera = {"position": (0, 0, 5), "target": (0, 3, 0)}
    view = easypbr.Viewer((8, 8), {"background": {"mode": "image", "image": "back.png"}, "camera": camera}, scene=scene)
    monkeypatch.chdir(tmp_path / "sub")
    assert (view.render(samples=1)[..., :3] == (255, 0, 0)).all()
    assert view.settings.background.image == "back.png"
    view.save_settings("look.json")
    saved = json.loads(Path("look.json").read_text())
    assert str(tmp_path / "back.png") in json.dumps(saved) and str(tmp_path / "far.ply") in json.dumps(saved)
    # Given again, it is one of the folder there.
    view.settings.background.image = "back.png"
    assert (view.render(samples=1)[..., :3] == (0, 0, 255)).all()
    view.settings.background.image = "none.png"
    with pytest.raises(easypbr.FileError, match="cannot read none.png"):
        view.render(samples=1)


def test_a_larger_picture_shows_more_of_it(tmp_path):
    rng = np.random.default_rng(3)
    pixels = rng.integers(0, 256, (64, 96, 3), np.uint8)
    easypbr.save_image(pixels, tmp_path / "back.png")
    camera = {"position": (0, 0, 5), "target": (0, 3, 0)}
    view = easypbr.Viewer((24, 16), {"background": {"mode": "image", "image": str(tmp_path / "back.png")}, "camera": camera})
    view.render(samples=1)
    assert np.array_equal(view.render((96, 64), samples=1)[..., :3], pixels)

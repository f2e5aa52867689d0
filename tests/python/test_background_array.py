"""Arrays and files as images behind everything."""

import numpy as np
import pytest

import easypbr
from easypbr import Camera, Scene, Viewer, shapes

SIZE = (24, 16)
#: Nothing of the small box at the origin is seen: it lies 31 degrees from the middle of the picture.
AWAY = {"position": (0, 0, 5), "target": (0, 3, 0)}


@pytest.fixture
def view():
    scene = Scene()
    scene.show(shapes.box((1e-3, 1e-3, 1e-3)), "box")
    return Viewer(SIZE, {"camera": AWAY, "image.samples": 1}, scene=scene)


def halves(left, right, dtype):
    """An image of the picture's size whose halves have one colour each."""
    pixels = np.empty((SIZE[1], SIZE[0], len(left)), dtype)
    pixels[:, : SIZE[0] // 2], pixels[:, SIZE[0] // 2 :] = left, right
    return pixels


# Linear 0.25 is 1.055 * 0.25^(1/2.4) - 0.055 = 0.5371 in sRGB, the code 136.96; linear 1 is 255. A code of 16 bits is 257 times
# the code of 8 bits.
@pytest.mark.parametrize("pixels, left, right", [
    (halves((200, 10, 30), (1, 2, 3), np.uint8), (200, 10, 30), (1, 2, 3)),
    (halves((200 * 257, 10 * 257, 30 * 257), (257, 514, 771), np.uint16), (200, 10, 30), (1, 2, 3)),
    (halves((0.25, 0, 1), (0, 1, 0.25), np.float32), (137, 0, 255), (0, 255, 137)),
    (halves((0.25, 0, 1), (0, 1, 0.25), np.float64), (137, 0, 255), (0, 255, 137)),
    (halves((200,), (3,), np.uint8)[..., 0], (200, 200, 200), (3, 3, 3)),
    (halves((9, 9, 9, 255), (9, 9, 9, 0), np.uint8), (9, 9, 9), (255, 255, 255)),
])  # fmt: skip
def test_arrays_are_shown_as_they_are(view, pixels, left, right):
    view.settings.background.color = "#ffffff"
    view.load_background_image(pixels)
    at_once = easypbr.render(
        view.scene, size=SIZE, samples=1, camera=AWAY, background=pixels, settings={"background.color": "#ffffff"}
    )
    for picture in (view.render(), at_once):
        # The columns beside the edge may have a part of the other one.
        assert (picture[:, :11, :3] == left).all() and (picture[:, 13:, :3] == right).all() and (picture[..., 3] == 255).all()


def test_an_array_stays_until_another_background_is_set(view, tmp_path):
    easypbr.save_image(np.full((4, 4, 3), 60, np.uint8), tmp_path / "other.png")
    shown = lambda: int(view.render()[0, 0, 0])  # noqa: E731
    view.load_background_image(np.full((4, 4, 3), 200, np.uint8))
    assert view.settings.background.mode == "image" and view.settings.background.image == ""
    assert shown() == 200
    view.load_background_image(tmp_path / "other.png")
    assert shown() == 60
    view.load_background_image(np.full((4, 4, 3), 90, np.uint8))
    assert shown() == 90
    view.settings.background.mode = "color"
    view.settings.background.color = "#0a0a0a"
    assert shown() == 10


def test_wrong_arrays_leave_the_background_before(view):
    view.settings.background.image = "before.png"
    for wrong, message in (
        (np.zeros((4, 4, 5), np.uint8), "5 channels"),
        (np.zeros((4, 4, 3), np.int64), "background image: expected height x width .*, got 4 x 4 x 3 int64"),
        (np.zeros((0, 4, 3), np.uint8), "0"),
    ):
        with pytest.raises(ValueError, match=message):
            view.load_background_image(wrong)
        with pytest.raises(ValueError, match=message):
            easypbr.render(view.scene, size=SIZE, background=wrong)
    assert view.settings.background.image == "before.png" and view.settings.background.mode == "color"


def test_files_that_are_no_images_leave_the_background_before(view, tmp_path):
    view.load_background_image(np.full((4, 4, 3), 200, np.uint8))
    (tmp_path / "text.png").write_text("no image")
    for wrong, kind, message in (
        (tmp_path / "missing.png", easypbr.FileError, "missing.png"),
        (str(tmp_path / "missing.png"), easypbr.FileError, "missing.png"),
        (tmp_path / "text.png", easypbr.FormatError, "text.png"),
        (None, easypbr.ArgumentError, "background image: expected a path or an array, got None"),
    ):
        with pytest.raises(kind, match=message):
            view.load_background_image(wrong)
        assert view.settings.background.image == "" and view.settings.background.mode == "image"
        assert view.render()[0, 0, 0] == 200


def test_settings_say_what_they_do_not_hold(view, tmp_path, caplog):
    view.save_settings(tmp_path / "a.json")
    assert caplog.text == ""
    view.load_background_image(np.zeros((4, 4, 3), np.uint8))
    view.load_environment_map(np.ones((4, 8, 3), np.float32))
    view.save_settings(tmp_path / "a.json")
    assert "a.json does not hold the background image: background.image names no file" in caplog.text
    assert "a.json does not hold the environment map: environment.file names no file" in caplog.text


# A photo by the camera's own lens has the distortion: its codes are those of the picture.
@pytest.mark.parametrize("skew, distortion, model", [
    (0, (-0.2, 0.05, 0, 0), "brown_conrady"),
    (0, (0.05, -0.01, 0.002, 0), "fisheye"),
    (3, None, "brown_conrady"),
])  # fmt: skip
@pytest.mark.parametrize("samples", [1, 4])
def test_lenses_do_not_bend_images(view, skew, distortion, model, samples):
    photo = np.full((SIZE[1], SIZE[0], 3), 120, np.uint8)
    photo[::4, :, 1], photo[:, ::3, 2] = 255, 10
    K = np.array([[30, skew, 11.5], [0, 30, 7.5], [0, 0, 1.0]])
    T = np.eye(4)
    T[2, 3] = -50
    view.camera = Camera.from_opencv(K, T, SIZE, distortion=distortion, model=model)
    view.load_background_image(photo)
    picture = view.render(samples=samples)
    # The box of a thousandth is seen in the middle, if at all.
    picture[6:10, 10:14, :3] = photo[6:10, 10:14]
    np.testing.assert_array_equal(picture[..., :3], photo)
    assert (picture[..., 3] == 255).all()

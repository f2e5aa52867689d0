"""Pages that are turned offline, opened as files without a network."""

import base64
import json
import re

import numpy as np
import pytest
from axe_playwright_python.sync_playwright import Axe

import easypbr

EVIL = '</title><script>window.hacked = 1</script><img src=x onerror="window.hacked = 2">{{orbit}}'


@pytest.fixture
def view():
    scene = easypbr.Scene()
    scene.show(easypbr.shapes.box((3, 0.2, 0.5)), "bar")
    return easypbr.Viewer((160, 120), {"image": {"samples": 1}}, scene=scene)


@pytest.fixture
def open_file(browser):
    contexts, faults = [], []

    def open_file(path, **options):
        contexts.append(browser.new_context(viewport={"width": 480, "height": 420}, **options))
        contexts[-1].set_offline(True)
        page = contexts[-1].new_page()
        page.on("request", lambda request: faults.append(f"asks for {request.url[:80]}")
                if request.url != path.as_uri() and not request.url.startswith("data:") else None)
        page.on("pageerror", lambda error: faults.append(str(error)))
        page.on("console", lambda message: faults.append(message.text) if message.type == "error" else None)
        page.goto(path.as_uri())
        page.wait_for_selector("canvas[data-index]")
        return page

    yield open_file
    for context in contexts:
        context.close()
    assert not faults


def orbit_of(path):
    """What stands in the page's data, and the first picture."""
    text = path.read_text()
    orbit = json.loads(re.search(r'<script type="application/json" id="orbit">(.*?)</script>', text, re.DOTALL)[1])
    orbit["first"] = base64.b64decode(re.search(r'id="start"[^>]* src="data:image/\w+;base64,([^"]*)"', text)[1])
    return orbit


def index(page):
    return int(page.locator("canvas").get_attribute("data-index"))


def until_index(page, wanted):
    page.wait_for_selector(f"canvas[data-index='{wanted}']")


def pixels(page):
    return page.locator("canvas").evaluate(
        "canvas => [...canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data]")


def test_drags_and_keys_turn_it(view, tmp_path, open_file):
    path = view.save_html(tmp_path / "bar.html", (12, 3))
    page = open_file(path)
    canvas = page.locator("canvas")
    assert index(page) == 12
    first = pixels(page)
    box = canvas.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x - 100, y, steps=8)
    page.mouse.up()
    # 200 degrees over the height, 30 for a column, to the right.
    columns = round(100 * 200 / box["height"] / 30)
    until_index(page, 12 + columns)
    assert pixels(page) != first
    canvas.focus()
    page.keyboard.press("Home")
    until_index(page, 12)
    assert pixels(page) == first
    page.keyboard.press("ArrowUp")
    until_index(page, 24)
    page.keyboard.press("ArrowUp")
    page.keyboard.press("ArrowLeft")
    until_index(page, 35)
    page.keyboard.press("ArrowDown")
    page.keyboard.press("ArrowRight")
    until_index(page, 12)
    assert "0 degrees around, 15 degrees up" in page.locator("[role=status]").inner_text()


def test_a_finger_turns_it(view, tmp_path, open_file):
    page = open_file(view.save_html(tmp_path / "bar.html", (12, 1)), has_touch=True, is_mobile=True)
    box = page.locator("canvas").bounding_box()
    session = page.context.new_cdp_session(page)
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    for kind, points in (("touchStart", [x]), ("touchMove", [x + 40]), ("touchMove", [x + 90]), ("touchEnd", [])):
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": at, "y": y} for at in points]})
    page.wait_for_function("document.querySelector('canvas').dataset.index !== '0'")
    assert 6 < index(page) < 12


def test_the_pictures_are_the_rendered_ones(view, tmp_path):
    orbit = orbit_of(view.save_html(tmp_path / "bar.html", (8, 3), quality=100))
    assert [orbit["columns"], orbit["start"], orbit["width"], orbit["height"]] == [8, 1, 160, 120]
    assert orbit["rows"] == pytest.approx([-5, 15, 35])
    assert [len(orbit["pictures"]), orbit["pictures"].count("")] == [24, 1]
    view.camera = view.turntable().camera(0, view.camera)
    first = easypbr._easypbr.decode_image(orbit["first"])
    # The rows above and below need as much room or more.
    assert first.shape[:2] == (120, 160)
    shown = (first[..., :3] != first[0, 0, :3]).any(axis=-1).mean()
    assert 0.02 < shown < 0.5


def test_the_camera_is_afterwards_what_it_was(view, tmp_path):
    before = view.render()
    view.save_html(tmp_path / "bar.html", (3, 1))
    assert np.array_equal(view.render(), before)


@pytest.mark.parametrize("format", ["webp", "jpeg"])
def test_the_limit_is_kept(view, tmp_path, format):
    free = view.save_html(tmp_path / "free.html", (36, 3), format=format, quality=95)
    limit = 0.85 * free.stat().st_size / 1e6
    tight = view.save_html(tmp_path / "tight.html", (36, 3), format=format, quality=95, max_mb=limit)
    assert 0.8 * limit < tight.stat().st_size / 1e6 <= limit
    assert orbit_of(tight)["width"] == 160


def test_where_quality_is_not_enough_the_size_goes_down(tmp_path):
    scene = easypbr.Scene()
    noise = np.random.default_rng(1).random((20000, 3))
    scene.show(easypbr.as_mesh(np.hstack([noise, noise])), "noise")
    view = easypbr.Viewer((400, 300), {"image": {"samples": 1}}, scene=scene)
    path = view.save_html(tmp_path / "noise.html", (4, 1), max_mb=0.03)
    assert path.stat().st_size <= 30000
    assert 16 <= orbit_of(path)["width"] < 400


def test_names_with_html_are_harmless(tmp_path, open_file):
    scene = easypbr.Scene()
    scene.show(easypbr.shapes.box((1, 1, 1)), EVIL)
    view = easypbr.Viewer((80, 60), {"image": {"samples": 1}}, scene=scene)
    page = open_file(view.save_html(tmp_path / "evil.html", (2, 1)))
    assert page.evaluate("window.hacked") is None
    assert page.title() == EVIL
    assert page.locator("h1").inner_text() == EVIL
    titled = open_file(view.save_html(tmp_path / "titled.html", (2, 1), title="A <b>bold</b> & plain"))
    assert titled.title() == "A <b>bold</b> & plain"


def test_without_scripts_the_first_picture_is_seen(view, tmp_path, browser):
    path = view.save_html(tmp_path / "bar.html", (2, 1))
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto(path.as_uri())
    picture = page.locator("#start")
    assert picture.is_visible() and picture.bounding_box()["width"] > 100
    context.close()


def test_it_is_accessible(view, tmp_path, open_file):
    page = open_file(view.save_html(tmp_path / "bar.html", (4, 1)))
    results = Axe().run(page)
    assert results.violations_count == 0, results.generate_report()


def test_transparency_stays(view, tmp_path):
    view.settings.background.mode = "transparent"
    with pytest.raises(easypbr.ArgumentError, match="JPEG has no transparency"):
        view.save_html(tmp_path / "bar.html", (2, 1), format="jpeg")
    assert not list(tmp_path.iterdir())
    first = easypbr._easypbr.decode_image(orbit_of(view.save_html(tmp_path / "bar.html", (2, 1)))["first"])
    assert first[0, 0, 3] == 0 and first[..., 3].max() == 255


@pytest.mark.parametrize("options, message", [
    ({"orbit": (0, 3)}, "1 to 360 columns"), ({"orbit": (36, 100)}, "1 to 60 rows"), ({"row_step": 90}, "within 160"),
    ({"format": "png"}, "webp or jpeg"), ({"quality": 0}, "quality of 1 to 100"), ({"max_mb": 0.02}, "108 pictures need"),
    ({"max_mb": float("nan")}, "108 pictures need"), ({"size": (0, 5)}, "picture size 0x5"), ({"samples": 0}, "samples"),
])
def test_wrong_options_are_told_before_anything_is_drawn(view, tmp_path, options, message):
    with pytest.raises(easypbr.ArgumentError, match=message):
        view.save_html(tmp_path / "bar.html", **options)
    assert not list(tmp_path.iterdir())


def test_a_folder_that_is_not_there_is_told_first(view, tmp_path):
    with pytest.raises(easypbr.FileError, match="no/such"):
        view.save_html(tmp_path / "no/such/bar.html")

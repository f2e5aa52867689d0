"""The page's own panels: lights, materials, the camera's path, recordings and their download."""

import os

import numpy as np
import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import expect


def panel(page, name):
    return page.page.locator(".user-panel").filter(has=page.page.get_by_role("heading", name=name, exact=True))


def look_at(page, name):
    """Keeps a screenshot where one is asked for."""
    if folder := os.environ.get("EASYPBR_SCREENSHOTS"):
        page.page.screenshot(path=f"{folder}/{name}.png")


def accessible(page):
    result = Axe().run(page.page)
    assert result.violations_count == 0, result.generate_report()


def test_a_light_is_added_changed_and_removed(view, open_page):
    page = open_page(width=1100, height=900)
    first, before = page.exact(), page.pixels()
    lights = panel(page, "Lights")
    lights.get_by_role("button", name="Add a light").click()
    second = page.exact(first)
    lit = page.pixels()
    assert not np.array_equal(before, lit)
    lights.get_by_label("color", exact=True).fill("#ff0000")
    third = page.exact(second)
    assert page.pixels()[..., 2].sum() < lit[..., 2].sum()
    look_at(page, "lights")
    accessible(page)
    lights.get_by_role("button", name="Remove light").click()
    page.exact(third)
    page.until_shows(before)
    assert view.scene.light_names() == []


def test_a_material_is_changed(view, open_page):
    page = open_page(width=1100, height=900)
    first = page.exact()
    page.page.mouse.click(*page.centre())
    look = panel(page, "Object")
    look.get_by_label("base color", exact=True).fill("#00ff00")
    page.exact(first)
    page.page.wait_for_timeout(300)
    assert view.scene.get("ball").material.base_color == pytest.approx([0, 1, 0])
    roughness = look.get_by_label("roughness", exact=True).last
    roughness.fill("0.125")
    roughness.press("Enter")
    expect(look.get_by_label("roughness", exact=True).last).to_have_value("0.125")
    for _ in range(100):
        if view.scene.get("ball").material.roughness == 0.125:
            break
        page.page.wait_for_timeout(100)
    assert view.scene.get("ball").material.roughness == 0.125
    look.get_by_role("button", name="Style").click()
    expect(look.get_by_label("point size", exact=False).first).to_be_visible()
    look_at(page, "material")
    accessible(page)


def test_a_path_is_made_by_keyboard_played_and_downloaded(open_page, tmp_path):
    page = open_page(width=1100, height=900)
    first, before = page.exact(), page.pixels()
    keyboard = page.page.keyboard
    page.page.get_by_role("tab", name="Scene").focus()
    keyboard.press("ArrowRight")
    path = panel(page, "Camera path")
    path.get_by_role("button", name="Add key").focus()
    keyboard.press("Enter")
    expect(path.get_by_role("button", name="Key 1")).to_be_visible()
    page.canvas.focus()
    for _ in range(6):
        keyboard.press("ArrowLeft")
    second = page.exact(first)
    path.get_by_role("button", name="Add key").focus()
    keyboard.press("Enter")
    expect(path.get_by_role("button", name="Key 2, at 1.00 s")).to_be_visible()
    path.get_by_role("button", name="Key 1, at 0.00 s").click()
    page.exact(second)
    page.until_shows(before, tolerance=1)  # The path's pose rounds otherwise than the camera's.
    path.get_by_role("button", name="Play").click()
    expect(path.get_by_role("button", name="Pause")).to_be_visible()
    expect(path.get_by_role("button", name="Play")).to_be_visible()
    recording = panel(page, "Recording")
    for name, value in (("width", "64"), ("height", "48"), ("frames per second", "5")):
        field = recording.get_by_label(name, exact=True).last
        field.fill(value)
        field.press("Enter")
        expect(field).to_have_value(value)
    look_at(page, "camera")
    accessible(page)
    with page.page.expect_download() as download:
        recording.get_by_role("button", name="Record the camera path").click()
    assert download.value.suggested_filename == "easypbr.mp4"
    download.value.save_as(tmp_path / "video.mp4")
    assert (tmp_path / "video.mp4").read_bytes()[4:8] == b"ftyp"
    # 1 second, both ends shown: 0, 0.2, ... 1.
    expect(recording.get_by_text("Wrote recording.mp4: 6 frames")).to_be_visible()
    with page.page.expect_download():
        recording.get_by_role("button", name="Download again").click()


def test_who_watches_can_use_no_tool(server, open_page):
    open_page().exact()
    page = open_page(server.watch_url, width=1100)
    expect(panel(page, "Lights").get_by_role("button", name="Add a light")).to_be_disabled()
    page.tab("Camera")
    expect(panel(page, "Recording").get_by_role("button", name="Record what happens")).to_be_disabled()

"""The page in a real browser: pictures, input, settings, pick, links, reconnection, watchers, accessibility."""

import os

import numpy as np
import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import expect

import easypbr


def test_a_view_of_its_own_and_back(view, tmp_path, open_page):
    secret = tmp_path / "token"
    secret.write_text("v" * 40)
    secret.chmod(0o600)
    server = view.serve(token_file=secret)
    shared, page = open_page(server.url, width=1100), open_page(server.url, width=1100)
    before, pixels = shared.exact(), shared.pixels()
    page.until_shows(pixels)
    button = page.page.get_by_role("button", name="Own view")
    button.click()
    expect(button).to_have_attribute("aria-pressed", "true")
    page.tab("Scene")
    # What all see is not changed from it.
    expect(page.page.get_by_role("button", name="Show ball")).to_be_disabled()
    first = page.exact()
    page.drag(80, 30)
    turned = page.exact(first)
    assert not np.array_equal(page.pixels(), pixels)
    # What is shown comes to both.
    view.scene.show(easypbr.shapes.box((0.5, 3, 0.5)), "bar")
    shared.exact(before)
    page.exact(turned)
    # After another server has begun at the same place it is a view of its own again, with the same camera.
    own, common, port = page.pixels(), shared.pixels(), server.port
    server.close()
    for each in (page, shared):
        expect(each.page.get_by_text("Connection lost")).to_be_visible()
    with view.serve(port=port, token_file=secret):
        for each in (page, shared):
            expect(each.page.get_by_text("Connection lost")).to_be_hidden()
            each.exact()  # Before, the canvas holds the last server's picture.
        shared.until_shows(common, 2)
        page.until_shows(own, 2)
        expect(button).to_have_attribute("aria-pressed", "true")
        button.click()
        expect(button).to_have_attribute("aria-pressed", "false")
        shared.exact()
        page.until_shows(shared.pixels(), 2)
        assert not page.page.get_by_role("button", name="Show ball").is_enabled()


def test_the_picture_at_rest_is_the_rendered_one(view, open_page):
    page = open_page()
    page.exact()
    shown = page.pixels()
    assert shown[..., 3].min() == 255
    assert np.array_equal(shown, view.render((shown.shape[1], shown.shape[0])))


def test_the_secret_leaves_the_address_and_survives_a_reload(server, open_page):
    page = open_page()
    page.exact()
    assert "token" not in page.page.url and server.url.split("token=")[1] not in page.page.url
    page.page.reload()
    page.exact()


def test_without_the_secret_it_is_asked_for(server, open_page):
    page = open_page(server.url.split("#")[0])
    page.page.get_by_label("Link or secret").fill("wrong")
    page.page.get_by_role("button", name="Open").click()
    expect(page.page.get_by_text("does not fit")).to_be_visible()
    page.page.get_by_label("Link or secret").fill(server.url)
    page.page.get_by_role("button", name="Open").click()
    page.exact()


@pytest.mark.parametrize("button", ["left", "right"])
def test_drags_move_the_camera(open_page, button):
    page = open_page()
    first = page.exact()
    before = page.pixels()
    page.drag(60, 30, button)
    page.exact(first)
    assert not np.array_equal(before, page.pixels())


def test_the_wheel_zooms(open_page):
    page = open_page()
    first = page.exact()
    before = page.pixels()
    page.page.mouse.move(*page.centre())
    page.page.mouse.wheel(0, -300)
    page.exact(first)
    after = page.pixels()
    background = before[0, 0]
    assert (after != background).any(axis=-1).sum() > 1.1 * (before != background).any(axis=-1).sum()


def test_keys_turn_zoom_and_undo(open_page):
    page = open_page()
    first = page.exact()
    before = page.pixels()
    page.canvas.focus()
    page.page.keyboard.press("ArrowLeft")
    second = page.exact(first)
    assert not np.array_equal(before, page.pixels())
    page.page.keyboard.press("Control+z")
    page.exact(second)
    assert np.array_equal(before, page.pixels())


def test_a_double_click_focuses(open_page):
    page = open_page()
    first = page.exact()
    x, y = page.centre()
    page.page.mouse.click(x + 40, y)
    read_out = page.page.get_by_label("Picked").locator("dd")
    expect(read_out.first).to_be_visible()
    aimed = read_out.all_inner_texts()
    page.page.wait_for_timeout(600)  # No third click of a double one.
    newest, before = page.exact(), page.pixels()
    page.page.mouse.dblclick(x + 40, y)
    while np.array_equal(before, page.pixels()):  # The clicks alone may bring pictures, of the view as it was.
        newest = page.exact(newest)
    page.exact(newest - 1)
    page.page.wait_for_timeout(600)
    page.page.mouse.click(x - 60, y)
    expect(read_out.nth(1)).not_to_have_text(aimed[1])
    other = read_out.nth(1).inner_text()
    page.page.wait_for_timeout(600)
    page.page.mouse.click(x, y)
    expect(read_out.nth(1)).not_to_have_text(other)
    position = [float(number) for number in read_out.nth(1).inner_text().split(",")]
    assert position == pytest.approx([float(number) for number in aimed[1].split(",")], abs=0.1)


def test_fingers_turn_and_pinch(view, open_page):
    view.settings["ground.mode"] = "none"
    page = open_page(width=420, height=700, has_touch=True, is_mobile=True)
    first = page.exact()
    before = page.pixels()
    session = page.page.context.new_cdp_session(page.page)

    def touch(kind, *points):
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [
            {"x": x, "y": y, "id": number} for number, (x, y) in enumerate(points)]})
        page.page.wait_for_timeout(30)

    x, y = page.centre()
    touch("touchStart", (x, y))
    touch("touchMove", (x + 30, y))
    touch("touchMove", (x + 60, y))
    touch("touchEnd")
    second = page.exact(first)
    turned = page.pixels()
    assert not np.array_equal(before, turned)
    touch("touchStart", (x - 20, y), (x + 20, y))
    touch("touchMove", (x - 35, y), (x + 35, y))
    touch("touchMove", (x - 60, y), (x + 60, y))
    touch("touchEnd")
    page.exact(second)
    background = turned[0, 0]
    assert (page.pixels() != background).any(axis=-1).sum() > 1.1 * (turned != background).any(axis=-1).sum()


def test_every_setting_has_a_control_and_changes_the_picture(view, open_page):
    page = open_page(width=1100, height=700)
    first = page.exact()
    page.tab("Settings")
    search = page.page.get_by_label("Search settings")
    search.fill("background.color")
    page.page.locator('input[type="color"]').first.fill("#00ff00")
    second = page.exact(first)
    assert tuple(page.pixels()[0, 0]) == (0, 255, 0, 255)
    search.fill("projection")
    page.page.locator("#field-camera\\.projection").select_option("orthographic")
    third = page.exact(second)
    search.fill("tonemap.exposure")
    exposure = page.page.locator("#field-tonemap\\.exposure")
    before = page.pixels()
    exposure.fill("0.1")
    exposure.press("Enter")
    page.exact(third)
    assert page.pixels()[..., 0].sum() < before[..., 0].sum()
    search.fill("")
    page.page.evaluate("""() => document.querySelectorAll('.group button[aria-expanded="false"]').forEach(b => b.click())""")
    shown = {row.get_attribute("for").removeprefix("field-") for row in page.page.locator(".row label").all()}
    hidden = {"environment.file", "background.image", "image.size", "load.crease_deg", "load.variant", "limits.memory"}
    names = {name for name, _ in view.settings if not name.startswith("material.") or not name.endswith(("_texture", "shader"))}
    assert shown == names - hidden


def test_a_wrong_value_is_told_and_taken_back(open_page):
    page = open_page(width=1100)
    page.exact()
    page.tab("Settings")
    page.page.get_by_label("Search settings").fill("tonemap.exposure ")
    exposure = page.page.locator("#field-tonemap\\.exposure")
    expect(exposure).not_to_have_value("")
    before = exposure.input_value()
    exposure.fill("much")
    exposure.press("Enter")
    expect(page.page.locator(".notice.error")).to_contain_text("exposure")
    expect(exposure).to_have_value(before)


def test_objects_are_hidden_in_the_tree(view, open_page):
    page = open_page(width=1100)
    first = page.exact()
    page.page.get_by_role("button", name="Show ball").click()
    page.exact(first)
    assert view.scene.get("ball").style.visible is False
    expect(page.page.get_by_role("button", name="Show ball")).to_have_attribute("aria-pressed", "false")


def test_a_click_says_what_is_there(open_page):
    page = open_page()
    page.exact()
    page.page.mouse.click(*page.centre())
    read_out = page.page.get_by_label("Picked")
    expect(read_out).to_contain_text("position")
    expect(read_out.locator("strong")).to_have_text("ball")


def test_names_are_texts(view, open_page):
    name = "<img src=x onerror=alert(1)>"
    view.scene.show(easypbr.shapes.sphere(1.2, 8), name)
    page = open_page(width=1100)
    page.exact()
    expect(page.page.get_by_role("button", name=name, exact=True)).to_be_visible()
    assert page.page.locator(".tree img").count() == 0


def test_a_screenshot_is_downloaded(view, open_page, tmp_path):
    page = open_page()
    page.exact()
    size = page.pixels().shape
    view.render((size[1], size[0]))
    page.page.get_by_role("button", name="Screenshot").click()
    page.page.get_by_label("Width").fill("333")
    page.page.get_by_label("Height").fill("222")
    with page.page.expect_download() as download:
        page.page.get_by_role("button", name="Download PNG").click()
    download.value.save_as(tmp_path / "shot.png")
    shot = np.asarray(easypbr.load_image(tmp_path / "shot.png"))
    assert np.array_equal(shot, view.render((333, 222)))


def test_a_link_holds_camera_and_settings(server, open_page):
    page = open_page(width=1100)
    first = page.exact()
    page.drag(50, 20)
    second = page.exact(first)
    page.tab("Settings")
    page.page.get_by_label("Search settings").fill("background.color")
    page.page.locator('input[type="color"]').first.fill("#0000ff")
    page.exact(second)
    page.page.wait_for_timeout(500)
    kept = page.pixels()
    page.page.get_by_role("button", name="Link to this view").click()
    page.page.get_by_label("With the secret").check()
    link = page.page.get_by_label("Link", exact=True).input_value()
    assert "camera.pose" in link and "background.color" in link and "token=" in link
    page.page.get_by_role("button", name="Close", exact=True).click()
    page.page.get_by_role("button", name="Reset", exact=True).click()
    page.page.wait_for_function("value => document.querySelector('input[type=color]').value !== value", arg="#0000ff")
    page.page.context.close()
    again = open_page(link, width=1100)
    # A link has a camera's numbers as text, and its near plane is not inferred: single values round the other way.
    again.until_shows(kept, tolerance=1)


def test_it_comes_back_by_itself(view, open_page, tmp_path):
    secret = tmp_path / "token"
    secret.write_text("s" * 40)
    secret.chmod(0o600)
    server = view.serve(token_file=secret)
    page = open_page(server.url)
    first = page.exact()
    page.drag(50, 20)
    page.exact(first)
    page.page.wait_for_timeout(500)
    kept = page.pixels()
    server.close()
    expect(page.page.get_by_text("Connection lost")).to_be_visible()
    assert np.array_equal(kept, page.pixels())  # It stays, dimmed.
    with view.serve(port=server.port or int(server.url.split(":")[2].split("/")[0]), token_file=secret):
        expect(page.page.get_by_text("Connection lost")).to_be_hidden()
        page.page.wait_for_function("() => document.querySelector('canvas.picture').dataset.frame < 10")
        page.until_shows(kept, tolerance=1)  # The camera goes by its text, as in a link.


def test_a_second_page_sees_the_same_and_does_not_control(open_page):
    first = open_page()
    number = first.exact()
    second = open_page()
    second.page.wait_for_function("() => document.querySelector('canvas.picture').dataset.exact === 'true'")
    assert np.array_equal(first.pixels(), second.pixels())
    expect(second.page.get_by_role("button", name="Ask for control")).to_be_visible()
    second.drag(60, 30)
    second.page.wait_for_timeout(500)
    assert int(first.data("frame")) == number
    first.drag(60, 30)
    first.exact(number)
    second.page.wait_for_function("frame => Number(document.querySelector('canvas.picture').dataset.frame) >= frame",
                                  arg=int(first.data("frame")))
    assert np.array_equal(first.pixels(), second.pixels())


def test_a_watcher_cannot_do_anything(server, open_page):
    open_page().exact()
    page = open_page(server.watch_url, width=1100)
    expect(page.page.get_by_text("Watching", exact=True)).to_be_visible()
    page.tab("Settings")
    for control in page.page.locator(".row input, .row select, .row button").all():
        expect(control).to_be_disabled()


@pytest.mark.parametrize("theme", ["dark", "light"])
def test_axe_finds_nothing(open_page, theme):
    page = open_page(width=1100, height=700, color_scheme=theme)
    page.exact()
    page.page.mouse.click(*page.centre())
    expect(page.page.get_by_label("Picked")).to_be_visible()
    for tab in ("Scene", "Camera", "Settings", "Statistics"):
        page.tab(tab)
        if tab == "Settings":
            page.page.get_by_role("button", name="environment", exact=True).click()
        result = Axe().run(page.page)
        assert result.violations_count == 0, result.generate_report()
    page.page.get_by_role("button", name="Screenshot").click()
    result = Axe().run(page.page)
    assert result.violations_count == 0, result.generate_report()


@pytest.mark.parametrize("width, height", [(1440, 900), (1024, 768), (390, 844)])
def test_everything_fits_the_screen(open_page, width, height):
    page = open_page(width=width, height=height)
    page.exact()
    for button in page.page.locator(".tools button").all():
        box = button.bounding_box()
        assert box["x"] >= 0 and box["x"] + box["width"] <= width
    assert page.page.evaluate("document.documentElement.scrollWidth") <= width


def test_panels_of_the_program_are_shown_and_used(view, open_page):
    seen = {}
    losses = [1 / (k + 1) for k in range(50)]

    @view.add_panel("Training")
    def panel(ui):
        ui.text("Runs for a while")
        seen["rate"] = ui.slider("rate", 0.1, 0, 1)
        seen["mode"] = ui.combo("mode", "fast", ["fast", "exact"])
        seen["live"] = ui.checkbox("live", True)
        seen["color"] = ui.color("tint", (1, 0, 0))
        if ui.button("Pause"):
            seen["paused"] = True
        ui.same_line()
        if ui.button("Reset all"):
            seen["reset"] = True
        ui.progress(0.4, "epoch 2 of 5")
        ui.plot("loss", losses)
        if ui.section("More", open=False):
            seen["note"] = ui.text_field("note", "")

    page = open_page(width=1100, height=800)
    page.exact()
    panel = page.page.locator(".user-panel").filter(has=page.page.get_by_role("heading", name="Training"))
    expect(panel.get_by_role("heading", name="Training")).to_be_visible()

    def until(name, value):
        for _ in range(100):
            if seen.get(name) == value:
                return
            page.page.wait_for_timeout(100)
        raise AssertionError(f"{name} is {seen.get(name)}")

    number = panel.get_by_label("rate").last
    number.fill("0.75")
    number.press("Enter")
    until("rate", 0.75)
    panel.get_by_label("mode").select_option("exact")
    until("mode", "exact")
    panel.get_by_label("live").click()
    until("live", False)
    panel.locator('input[type="color"]').fill("#0000ff")
    until("color", (0.0, 0.0, 1.0))
    panel.get_by_role("button", name="Pause").click()
    until("paused", True)
    assert "reset" not in seen
    assert panel.get_by_label("note").count() == 0
    panel.get_by_role("button", name="More").click()
    panel.get_by_label("note").fill("hello")
    panel.get_by_label("note").press("Enter")
    until("note", "hello")
    expect(panel.locator("svg polyline")).to_have_count(1)
    results = Axe().run(page.page)
    assert not results.response["violations"], results.generate_report()
    if folder := os.environ.get("EASYPBR_SCREENSHOTS"):
        page.page.screenshot(path=f"{folder}/panels.png")
    view.remove_panel("Training")
    expect(panel).to_have_count(0)
    expect(page.page.get_by_role("tab", name="Scene")).to_have_attribute("aria-selected", "true")

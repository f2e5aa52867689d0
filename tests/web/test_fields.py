"""Fields of settings and panels: what is shown, and what is set."""

import pytest
from playwright.sync_api import expect

import easypbr


@pytest.fixture
def panel(view, open_page):
    """A page that shows a panel of the program's, drawn by `draw(ui)`."""

    def panel(draw, name="P"):
        view.add_panel(name, draw)
        page = open_page(width=1100)
        page.exact()
        return page

    return panel


def sockets(page):
    """Of the page, those that begin from now on: none does while the connection stays."""
    begun = []
    page.page.on("websocket", lambda socket: begun.append(socket))
    return begun


def wait_until(page, condition):
    for _ in range(200):
        if condition():
            return
        page.page.wait_for_timeout(50)
    raise AssertionError("it does not come")


def test_a_slider_that_was_clicked_shows_what_the_program_sets(panel):
    state = {"value": 0.5}
    page = panel(lambda ui: ui.slider("rate", state["value"], 0.0, 1.0))
    slider = page.page.get_by_role("slider", name="rate")
    slider.click()  # The middle, where the knob is.
    for value in (0.9, 0.2):
        state["value"] = value
        expect(slider).to_have_value(str(value))
        expect(page.page.get_by_role("textbox", name="rate")).to_have_value(str(value))


def test_a_field_that_was_only_looked_at_sets_nothing(view, server, open_page):
    page = open_page(width=1100)
    page.exact()
    page.tab("Settings")
    search = page.page.get_by_label("Search settings")
    search.fill("tonemap.exposure ")
    exposure = page.page.locator("#field-tonemap\\.exposure")
    automatic = page.page.get_by_role("button", name="exposure: automatic")
    exposure.click()
    search.click()
    page.page.wait_for_timeout(500)
    expect(automatic).to_have_attribute("aria-pressed", "true")
    exposure.click()
    view.settings["tonemap.exposure"] = 2.5
    expect(automatic).to_have_attribute("aria-pressed", "false")
    search.click()
    page.page.wait_for_timeout(500)
    expect(exposure).to_have_value("2.5")


def test_numbers_keep_their_digits(panel):
    def draw(ui):
        ui.number("step", 1234567)
        ui.number("share", 1234567.25)
        seen["frame"] = ui.slider("frame", 123456, 0, 1000000)
        seen["time"] = ui.slider("time", 100000.5, 100000.0, 100001.0)

    seen = {}
    page = panel(draw)
    for name, text in (("step", "1234567"), ("share", "1234567.25"), ("frame", "123456"), ("time", "100000.5")):
        expect(page.page.get_by_role("textbox", name=name, exact=True)).to_have_value(text)
    for name, value in (("frame", 123457), ("time", pytest.approx(100000.501, abs=1e-6))):
        page.page.get_by_role("slider", name=name).focus()
        page.page.keyboard.press("ArrowRight")
        expect(page.page.get_by_role("textbox", name=name)).to_have_value("123457" if name == "frame" else "100000.501")
        wait_until(page, lambda: seen[name] == value)


def test_a_long_text_leaves_the_connection(panel):
    seen = {}

    def draw(ui):
        seen["note"] = ui.text_field("note", "hi")

    page = panel(draw)
    begun = sockets(page)
    note = page.page.get_by_label("note")
    note.fill("\u20ac" * 8000)  # 24000 bytes.
    note.press("Enter")
    expect(page.page.locator(".notice.error")).to_contain_text("at most 8192 bytes")
    note.fill("a" * 8192)
    note.press("Enter")
    wait_until(page, lambda: len(seen["note"]) == 8192)
    assert not begun


def test_long_names_leave_the_connection(view, panel):
    pushed = []
    name = "x" * 6000
    view.scene.show(easypbr.shapes.box((0.5, 0.5, 0.5)), name)
    page = panel(lambda ui: ui.button("Go") and pushed.append(True), "Long " * 80)
    begun = sockets(page)
    page.page.get_by_role("button", name="Go").click()
    wait_until(page, lambda: pushed)
    page.tab("Scene")
    page.page.get_by_role("button", name=f"Show {name}").click()
    wait_until(page, lambda: view.scene.get(name).style.visible is False)
    assert not begun

"""What moves comes as video, or as JPEGs where a browser decodes none."""

import time

import numpy as np
import pytest
from playwright.sync_api import expect

from conftest import Page


def moved(page, dx=60):
    """Drags, with pictures on the way; returns what the last one that moved came as."""
    x, y = page.centre()
    mouse = page.page.mouse
    mouse.move(x, y)
    mouse.down()
    for step in range(12):
        mouse.move(x + dx * step / 11, y)
        page.page.wait_for_timeout(30)
    mouse.up()
    page.page.wait_for_function("() => document.querySelector('canvas.picture').dataset.moving")
    return page.data("moving")


def test_a_drag_is_seen_as_video(view, open_page):
    page = open_page(width=1100)
    first = page.exact()
    assert moved(page) == "H.264"
    page.exact(first)
    page.tab("Statistics")
    expect(page.page.locator(".items .item", has_text="Moving")).to_contain_text("H.264")


def test_the_video_shows_what_is_drawn(view, open_page):
    """Its picture and the exact one of the same camera differ by what is lossy: a stretched one or another matrix would
    be off by more."""
    view.settings["ground.mode"] = "none"
    page = open_page()
    first = page.exact()
    still = page.pixels()[..., :3].astype(float)
    page.page.evaluate("""() => {
        const canvas = document.querySelector("canvas.picture");
        window.seen = null;
        new MutationObserver(() => {
            if (canvas.dataset.moving !== "H.264" || canvas.dataset.exact === "true") return;
            window.seen = [canvas.width, canvas.height, canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data];
        }).observe(canvas, { attributes: true, attributeFilter: ["data-frame"] });
    }""")
    x, y = page.centre()
    page.page.mouse.move(x, y)
    page.page.mouse.down()
    deadline = time.monotonic() + 30  # A busy machine decodes nothing before a short drag has ended.
    while time.monotonic() < deadline and not page.page.evaluate("() => seen !== null"):
        for step in (1, 2, 3, 4, 3, 2, 1, 0, 1, 0, 1, 0):
            page.page.mouse.move(x + step, y)
            page.page.wait_for_timeout(40)
    page.page.mouse.up()
    page.exact(first)
    width, height, data = page.page.evaluate("() => [seen[0], seen[1], Array.from(seen[2])]")
    video = np.array(data, float).reshape(height, width, 4)[..., :3]
    assert video.shape == still.shape
    assert 10 * np.log10(255 ** 2 / np.mean((video - still) ** 2)) > 24
    assert abs((video - still).mean()) < 3


def test_without_webcodecs_there_are_jpegs(browser, server):
    context = browser.new_context(viewport={"width": 700, "height": 420})
    context.add_init_script("delete window.VideoDecoder")
    faults = []
    page = Page(context, server.url, faults)
    first = page.exact()
    assert moved(page) == "JPEG"
    page.exact(first)
    context.close()
    assert not faults


@pytest.mark.parametrize("fault", ["throws", "keeps"])
def test_a_decoder_that_fails_gives_way_to_jpegs(browser, server, fault):
    """`throws`: each picture is an error; `keeps`: nothing ever comes out."""
    context = browser.new_context(viewport={"width": 700, "height": 420})
    decode = "throw new Error('broken')" if fault == "throws" else "return"
    context.add_init_script(f"VideoDecoder.prototype.decode = function () {{ {decode} }}")
    page = Page(context, server.url, [])
    page.exact()
    for _ in range(40):
        if moved(page) == "JPEG":
            break
    else:
        raise AssertionError("it stays with H.264")
    page.exact()
    context.close()


def test_the_video_goes_on_after_a_reconnection(view, tmp_path, open_page):
    secret = tmp_path / "token"
    secret.write_text("v" * 40)
    secret.chmod(0o600)
    server = view.serve(token_file=secret)
    page = open_page(server.url)
    page.exact()
    assert moved(page) == "H.264"
    port = server.port
    server.close()
    expect(page.page.get_by_text("Connection lost")).to_be_visible()
    page.canvas.evaluate("canvas => { delete canvas.dataset.moving; }")
    with view.serve(port=port, token_file=secret):
        expect(page.page.get_by_text("Connection lost")).to_be_hidden()
        page.page.wait_for_function("() => document.querySelector('canvas.picture').dataset.exact === 'true'")
        assert moved(page, -50) == "H.264"

"""The page behind a reverse proxy, and at the end of a slow line."""

import statistics

import numpy as np
from playwright.sync_api import expect

from lines import SlowLine, reverse_proxy


def fragment(server):
    return "#" + server.url.split("#")[1]


def test_it_works_below_a_prefix_of_a_reverse_proxy(view, server, open_page, tmp_path):
    with reverse_proxy(server.port, tmp_path) as address:
        page = open_page(address + fragment(server), width=1100)
        first = page.exact()
        shown = page.pixels()
        assert np.array_equal(shown, view.render((shown.shape[1], shown.shape[0])))
        page.drag(60, 30)
        page.exact(first)
        assert not np.array_equal(shown, page.pixels())
        with page.page.expect_download() as download:
            page.page.get_by_role("button", name="Screenshot").click()
            page.page.get_by_role("button", name="Download PNG").click()
        assert download.value.suggested_filename == "easypbr.png"
        page.page.get_by_role("button", name="Link to this view").click()
        link = page.page.get_by_label("Link", exact=True).input_value()
        assert link.startswith(address + "#")


def test_a_proxy_that_ends_is_noticed(server, open_page, tmp_path):
    port = server.port
    with reverse_proxy(port, tmp_path) as address:
        page = open_page(address + fragment(server))
        page.exact()
    expect(page.page.get_by_text("Connection lost")).to_be_visible()


WATCH = """() => {
    const canvas = document.querySelector("canvas.picture");
    window.seen = [];
    new MutationObserver(() => {
        if (canvas.dataset.exact === "true") return;
        const wire = Number((canvas.dataset.latency ?? "").split(" ")[1]);
        window.seen.push([performance.now(), wire]);
    }).observe(canvas, { attributes: true, attributeFilter: ["data-frame"] });
}"""


def test_a_slow_line_has_no_queue_that_grows(view, server, open_page):
    """5 Mbit/s and 100 ms: what an input takes beside the drawing stays what it was. How many pictures a second there are
    is the machine's part too: bench/remote_line.py measures it."""
    view.settings["ground.mode"] = "none"
    with SlowLine(server.port, 5, 0.1) as line:
        page = open_page(server.url.replace(f":{server.port}/", f":{line.port}/"), width=700, height=500)
        page.exact()
        page.page.evaluate(WATCH)
        x, y = page.centre()
        mouse = page.page.mouse
        mouse.move(x, y)
        mouse.down()
        for step in range(600):
            mouse.move(x + 100 * np.sin(step / 20), y)
            page.page.wait_for_timeout(20)
        mouse.up()
        seen = [wire for _, wire in page.page.evaluate("window.seen") if wire is not None and np.isfinite(wire)]
    assert len(seen) > 40
    half = len(seen) // 2
    before, after = statistics.median(seen[:half]), statistics.median(seen[half:])
    print(f"{len(seen)} pictures, median {before:.0f} then {after:.0f} ms beside the drawing")
    # A round trip is in each; a queue of a second's pictures, or one that grows, would be beyond a quarter of a second.
    assert before >= 100
    assert after <= max(250, 1.2 * before)


def test_the_exact_picture_comes_through_a_slow_line(view, server, open_page):
    with SlowLine(server.port, 1, 0.1) as line:
        page = open_page(server.url.replace(f":{server.port}/", f":{line.port}/"))
        page.exact()
        shown = page.pixels()
    assert np.array_equal(shown, view.render((shown.shape[1], shown.shape[0])))

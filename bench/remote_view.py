"""Latencies of the browser view in Debian's Chromium over loopback: from the end of drawing to drawn in the page, and from an
input to a picture that shows it; and what moves over the wire. Needs `scripts/setup.sh tests`.

usage: remote_view.py [MESH] [--size WxH] [--seconds S] [--line MEGABITS,MILLISECONDS]

`--line`: through a relay of this rate and round trip, see tests/web/lines.py.
"""
import argparse
import contextlib
import shutil
import statistics
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from playwright.sync_api import sync_playwright

import easypbr

sys.path.insert(0, str(Path(__file__).parents[1] / "tests/web"))
from lines import SlowLine  # noqa: E402

# Runs in the page: what it measured of each picture that names an input.
WATCH = """() => {
    const canvas = document.querySelector("canvas.picture");
    window.measured = [];
    new MutationObserver(() => window.measured.push(canvas.dataset.latency.split(" ").map(Number)))
        .observe(canvas, { attributes: true, attributeFilter: ["data-latency"] });
}"""


def quantiles(values: Sequence[float]) -> str:
    ordered = sorted(values)
    return f"median {statistics.median(ordered):6.1f}   p95 {ordered[int(0.95 * (len(ordered) - 1))]:6.1f}   of {len(ordered)}"


def measure(mesh: str | None, size: tuple[int, int], seconds: float, line: tuple[float, float] | None) -> None:
    scene = easypbr.Scene()
    scene.show(easypbr.shapes.teapot() if mesh is None else mesh, "model")
    view = easypbr.Viewer(size, {"image": {"samples": 8}}, scene=scene)
    with contextlib.ExitStack() as ends:
        server = ends.enter_context(view.serve())
        url = server.url
        if line:
            relay = ends.enter_context(SlowLine(server.port, line[0], line[1] / 1000))
            url = url.replace(f":{server.port}/", f":{relay.port}/")
        playwright = ends.enter_context(sync_playwright())
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": size[0], "height": size[1] + 47})
        received = [0, 0]
        page.on("websocket", lambda socket: socket.on("framereceived", lambda data: count(received, data)))
        begun = time.monotonic()
        page.goto(url)
        page.get_by_role("button", name="Controls", exact=True).click()
        page.wait_for_selector("canvas[data-frame]", timeout=120000)
        print(f"first picture after {time.monotonic() - begun:.2f} s")
        page.wait_for_selector('canvas[data-exact="true"]', timeout=300000)
        page.evaluate(WATCH)
        begun, steps = time.monotonic(), 0
        page.mouse.move(size[0] / 2, size[1] / 2)
        page.mouse.down()
        received[:] = [0, 0]
        while time.monotonic() - begun < seconds:
            steps += 1
            page.mouse.move(size[0] / 2 + steps % 200, size[1] / 2)
            page.wait_for_timeout(16)
        took = time.monotonic() - begun
        page.mouse.up()
        moving = list(received)
        page.get_by_role("button", name="Controls", exact=True).click()
        page.get_by_role("tab", name="Statistics").click()
        shown = page.locator(".items .item").all_inner_texts()
        print(f"{size[0]}x{size[1]}, {moving[1] / took:.1f} pictures/s, {moving[0] * 8e-6 / took:.1f} Mbit/s, "
              f"{moving[0] / max(1, moving[1]) / 1000:.0f} kB each")
        whole, wire, encode = zip(*page.evaluate("window.measured"))
        print("input to drawn in the page, ms:         ", quantiles(whole))
        print("end of drawing to drawn in the page, ms:", quantiles(wire))
        print("of which encoding, ms:                  ", quantiles(encode))
        print("in the page:", "; ".join(text.replace("\n", " ") for text in shown))
        browser.close()


def count(received: list[int], data: bytes | str) -> None:
    if isinstance(data, bytes):
        received[0] += len(data)
        received[1] += 1


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", nargs="?")
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--line", help="MEGABITS,MILLISECONDS: rate and round trip of a slow line")
    options = parser.parse_args()
    width, height = map(int, options.size.split("x"))
    line = tuple(map(float, options.line.split(","))) if options.line else None
    measure(options.mesh, (width, height), options.seconds, line)

"""Latencies of the browser view in Debian's Chromium over loopback: from the end of drawing to drawn in the page, and from an
input to a picture that shows it; and what moves over the wire. Needs `scripts/setup.sh tests`.

usage: remote_view.py [MESH] [--size WxH] [--seconds S] [--codec NAME] [--line MEGABITS,MILLISECONDS]

Latencies of the first and the second half show whether a queue grows. `--line`: through a relay of this rate and round trip, see tests/web/lines.py.
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

# Of the header of a picture (remote/frame_header.h): where its kind is, and that of a picture at rest.
KIND_AT, STILL = 0, 2

# Runs in the page: what it measured of each picture that names an input.
WATCH = """() => {
    const canvas = document.querySelector("canvas.picture");
    window.measured = [];
    new MutationObserver(() => window.measured.push(canvas.dataset.latency.split(" ").map(Number)))
        .observe(canvas, { attributes: true, attributeFilter: ["data-latency"] });
}"""


def quantiles(values: Sequence[float]) -> str:
    ordered = sorted(values)
    middle = len(values) // 2
    halves = " ".join(f"{statistics.median(half):.1f}" for half in (values[:middle], values[middle:])) if middle else "-"
    return (f"median {statistics.median(ordered):6.1f}   p95 {ordered[int(0.95 * (len(ordered) - 1))]:6.1f}   "
            f"max {ordered[-1]:6.1f}   halves {halves}   of {len(ordered)}")


def measure(mesh: str | None, size: tuple[int, int], seconds: float, codec: str, line: tuple[float, float] | None) -> None:
    scene = easypbr.Scene()
    scene.show(easypbr.shapes.teapot() if mesh is None else mesh, "model")
    view = easypbr.Viewer(size, {"image": {"samples": 8}}, scene=scene)
    with contextlib.ExitStack() as ends:
        server = ends.enter_context(view.serve(codec=codec))
        url = server.url
        if line:
            relay = ends.enter_context(SlowLine(server.port, line[0], line[1] / 1000))
            url = url.replace(f":{server.port}/", f":{relay.port}/")
        playwright = ends.enter_context(sync_playwright())
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": size[0], "height": size[1] + 47})
        received: list[tuple[float, bytes]] = []
        page.on("websocket", lambda socket: socket.on("framereceived", lambda data: note(received, data)))
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
        received.clear()
        while time.monotonic() - begun < seconds:
            steps += 1
            page.mouse.move(size[0] / 2 + steps % 200, size[1] / 2)
            page.wait_for_timeout(16)
        last = time.monotonic()
        moving = [data for _, data in received]
        took = last - begun
        page.mouse.up()
        page.wait_for_timeout(2000)
        stills = [(at, data) for at, data in received if at > last and data[KIND_AT] == STILL]
        page.get_by_role("button", name="Controls", exact=True).click()
        page.get_by_role("tab", name="Statistics").click()
        shown = page.locator(".items .item").all_inner_texts()
        count, kilobytes = len(moving), sum(map(len, moving)) / 1000
        print(f"{size[0]}x{size[1]}, {count / took:.1f} pictures/s, {kilobytes * 8e-3 / took:.1f} Mbit/s, "
              f"{kilobytes / max(1, count):.0f} kB each, at 30/s {kilobytes / max(1, count) * 0.24:.1f} Mbit/s")
        if stills:
            print(f"first full picture {1000 * (stills[0][0] - last):.0f} ms after the last input")
        whole, wire, encode = zip(*page.evaluate("window.measured"))
        print("input to drawn in the page, ms:         ", quantiles(whole))
        print("end of drawing to drawn in the page, ms:", quantiles(wire))
        print("of which encoding, ms:                  ", quantiles(encode))
        print("in the page:", "; ".join(text.replace("\n", " ") for text in shown))
        browser.close()


def note(received: list[tuple[float, bytes]], data: bytes | str) -> None:
    if isinstance(data, bytes):
        received.append((time.monotonic(), data))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", nargs="?")
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--codec", default="auto")
    parser.add_argument("--line", help="MEGABITS,MILLISECONDS: rate and round trip of a slow line")
    options = parser.parse_args()
    width, height = map(int, options.size.split("x"))
    line = tuple(map(float, options.line.split(","))) if options.line else None
    measure(options.mesh, (width, height), options.seconds, options.codec, line)

"""Latencies of browser views, ours beside trame with VTK's remote view and viser with pictures of VTK, in Debian's Chromium over
loopback: same machine, same mesh, same size, in turns. The mesh is dragged by one move of the pointer, again and again from rest; the page looks in each of its frames whether the picture has changed.

usage: remote_peers.py MESH.ply --peers PYTHON [--size WxH] [--steps N] [--rounds N]
python3 -m venv peers && peers/bin/pip install trame==4.0.0 trame-vtk==2.11.17 vtk==9.7.2 viser==1.1.1     # PYTHON is peers/bin/python
"""
import argparse
import bisect
import contextlib
import shutil
import socket
import statistics
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

from playwright.sync_api import Browser, sync_playwright

import easypbr

# Pictures of WebGL are kept until they are read, and each frame of the page looks at what is shown. Times are milliseconds since the epoch.
WATCH = """() => {
    const make = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, options) {
        return make.call(this, kind, kind.startsWith("webgl") ? { ...options, preserveDrawingBuffer: true } : options);
    };
    const now = () => performance.timeOrigin + performance.now();
    const small = new OffscreenCanvas(64, 36).getContext("2d", { willReadFrequently: true });
    const area = (element) => element.clientWidth * element.clientHeight;
    let before = "";
    window.changes = [];
    window.inputs = [];
    const look = () => {
        // Some lie over one another.
        const all = [...document.querySelectorAll("canvas, img")].filter(
            (each) => 2 * area(each) > innerWidth * innerHeight && each.width > 0 && each.height > 0);
        if (all.length > 0 && all.every((each) => each.tagName === "CANVAS" || (each.complete && each.naturalWidth > 0))) {
            small.clearRect(0, 0, 64, 36);
            for (const each of all) small.drawImage(each, 0, 0, 64, 36);
            const text = small.getImageData(0, 0, 64, 36).data.join();
            if (text !== before) window.changes.push(now());
            before = text;
        }
        requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
    window.addEventListener("pointermove", () => window.inputs.push(now()), true);
}"""
REST_S = 0.6
PATIENCE_S = 10


@contextlib.contextmanager
def ours(mesh: str, size: tuple[int, int]) -> Iterator[tuple[str, list[float]]]:
    """Each picture is drawn once: nothing is refined that would be taken for an answer."""
    scene = easypbr.Scene()
    scene.show(mesh, "model")
    view = easypbr.Viewer(size, {"image": {"samples": 1}, "path": {"enabled": False}}, scene=scene)
    with view.serve() as server:
        yield server.url, []


@contextlib.contextmanager
def peer(name: str, python: str, mesh: str, size: tuple[int, int]) -> Iterator[tuple[str, list[float]]]:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    script = Path(__file__).with_name("remote_peer.py")
    process = subprocess.Popen([python, script, name, mesh, str(port), f"{size[0]}x{size[1]}"], stdout=subprocess.PIPE,
                               stderr=subprocess.DEVNULL, text=True)
    ends: list[float] = []
    address = threading.Event()
    url = ""

    def listen() -> None:
        nonlocal url
        for line in process.stdout or ():
            if line.startswith("drawn "):
                ends.append(1000 * float(line.split()[1]))
            elif line.startswith("http"):
                url = line.strip()
                address.set()

    threading.Thread(target=listen, daemon=True).start()
    try:
        if not address.wait(60):
            raise RuntimeError(f"{name} does not begin")
        for _ in range(300):
            with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), 1):
                break
            time.sleep(0.1)
        yield url, ends
    finally:
        process.terminate()
        process.wait()


def measure(browser: Browser, url: str, ends: list[float], size: tuple[int, int], steps: int) -> tuple[list[float], list[float]]:
    """Milliseconds from an input to the page's frame that shows it, and from the end of the drawing to that."""
    bar = 47 if "token" in url else 0
    page = browser.new_page(viewport={"width": size[0], "height": size[1] + bar})
    page.add_init_script(f"({WATCH})()")
    page.goto(url)
    if bar:
        page.get_by_role("button", name="Controls", exact=True).click()
    page.wait_for_function("() => window.changes.length > 0", timeout=60000)
    page.wait_for_timeout(4000)
    x, y = size[0] / 2, size[1] / 2 + bar
    whole, wire = [], []
    for step in range(steps + 3):
        page.mouse.move(x, y)
        page.mouse.down()
        page.wait_for_timeout(1000 * REST_S)
        page.evaluate("() => { window.changes.length = window.inputs.length = 0; }")
        page.mouse.move(x + 30, y)
        end = time.monotonic() + PATIENCE_S
        while not page.evaluate("window.changes.length") and time.monotonic() < end:
            page.wait_for_timeout(20)
        inputs, changes = page.evaluate("[window.inputs, window.changes]")
        page.mouse.up()
        page.wait_for_timeout(1000 * REST_S)
        # The first ones warm up.
        if step < 3 or not inputs or not changes:
            continue
        whole.append(changes[0] - inputs[0])
        latency = None if ends else page.evaluate("document.querySelector('canvas.picture')?.dataset.latency")
        if latency:
            wire.append(float(latency.split()[1]))
        elif at := bisect.bisect(ends, changes[0]):
            wire.append(changes[0] - ends[at - 1])
    page.close()
    return whole, wire


def row(name: str, values: list[float]) -> str:
    if len(values) < 2:
        return f"{name}: too few measurements, {len(values)}"
    ordered = sorted(values)
    return f"{name:7} median {statistics.median(ordered):6.1f} ms   p95 {ordered[int(0.95 * (len(ordered) - 1))]:6.1f} ms   of {len(ordered)}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh")
    parser.add_argument("--peers", required=True, help="PYTHON of the environment with trame and viser")
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--steps", type=int, default=20, help="inputs of each in each round")
    parser.add_argument("--rounds", type=int, default=2)
    options = parser.parse_args()
    width, height = map(int, options.size.split("x"))
    size = (width, height)
    found: dict[str, tuple[list[float], list[float]]] = {}
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        for _ in range(options.rounds):
            for name in ("easypbr", "trame", "viser"):
                server = ours(options.mesh, size) if name == "easypbr" else peer(name, options.peers, options.mesh, size)
                with server as (url, ends):
                    whole, wire = measure(browser, url, ends, size, options.steps)
                for known, new in zip(found.setdefault(name, ([], [])), (whole, wire)):
                    known += new
                print(f"# {name}: {len(whole)} inputs", file=sys.stderr, flush=True)
        browser.close()
    print("from an input to the page's frame that shows it")
    for name, (whole, _) in found.items():
        print(row(name, whole))
    print("from the end of the drawing to that frame (easypbr: with the input's way to the server)")
    for name, (_, wire) in found.items():
        print(row(name, wire))


if __name__ == "__main__":
    main()

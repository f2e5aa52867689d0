"""Served views in Debian's Chromium, driven as a person drives them."""

import base64
import os
import shutil
import tempfile

import numpy as np
import pytest
from playwright.sync_api import expect, sync_playwright

_cache = tempfile.TemporaryDirectory(prefix="easypbr-test-cache-")
os.environ["EASYPBR_CACHE_DIR"] = _cache.name
os.environ["EASYPBR_LEAK_WARNINGS"] = "1"  # of this process and of those that tests start

import easypbr  # noqa: E402

PATIENCE_MS = 60000


@pytest.fixture(scope="session")
def browser():
    path = shutil.which("chromium")
    assert path, "chromium is not installed (`scripts/setup.sh tests` installs it)"
    expect.set_options(timeout=PATIENCE_MS)
    with sync_playwright() as playwright:
        # Chromium's own sandbox does not work for root.
        browser = playwright.chromium.launch(executable_path=path, args=["--no-sandbox"])
        yield browser
        browser.close()


@pytest.fixture
def view():
    scene = easypbr.Scene()
    scene.show(easypbr.shapes.sphere(1, 24), "ball")
    scene.show(easypbr.shapes.box((3, 0.2, 0.5)), "bar")
    return easypbr.Viewer((320, 240), {"image": {"samples": 4}}, scene=scene)


@pytest.fixture
def server(view):
    with view.serve() as server:
        yield server


class Page:
    """A page of the view, with what a test asks of it. Whatever it asks of other machines, and every error, fails."""

    def __init__(self, context, url, faults):
        self.page = context.new_page()
        self.page.set_default_timeout(PATIENCE_MS)
        host = url.split("/")[2]
        self.page.on("request", lambda request: faults.append(f"asks for {request.url}")
                     if request.url.split("/")[2] != host and not request.url.startswith("blob:") else None)
        self.page.on("pageerror", lambda error: faults.append(str(error)))
        self.page.on("console", lambda message: faults.append(message.text)
                     if message.type == "error" and "WebSocket" not in message.text
                     and "ERR_CONNECTION_REFUSED" not in message.text else None)
        self.canvas = self.page.locator("canvas.picture")
        self.page.goto(url)

    def data(self, name):
        return self.canvas.evaluate(f"canvas => canvas.dataset.{name}")

    def exact(self, newer_than=0):
        """Waits for the picture at rest; returns its number."""
        self.page.wait_for_function(
            """newest => {
                const canvas = document.querySelector("canvas.picture");
                const fits = Math.abs(canvas.width - canvas.clientWidth * Math.min(2, devicePixelRatio)) < 2;
                return canvas.dataset.exact === "true" && Number(canvas.dataset.frame) > newest && fits;
            }""", arg=newer_than)
        return int(self.data("frame"))

    def pixels(self):
        """Of the canvas: height x width x 4."""
        width, height, data = self.canvas.evaluate(
            """canvas => {
                const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
                let text = "";
                for (let i = 0; i < pixels.length; i += 8192) text += String.fromCharCode(...pixels.subarray(i, i + 8192));
                return [canvas.width, canvas.height, btoa(text)];
            }""")
        return np.frombuffer(base64.b64decode(data), np.uint8).reshape(height, width, 4)

    def until_shows(self, pixels, tolerance=0):
        """Waits until the canvas holds these; channels may differ by the tolerance."""
        for _ in range(PATIENCE_MS // 200):
            shown = self.pixels()
            if shown.shape == pixels.shape and np.abs(shown.astype(int) - pixels).max() <= tolerance:
                return
            self.page.wait_for_timeout(200)
        if shown.shape != pixels.shape:
            raise AssertionError(f"another picture stays: {shown.shape}, expected {pixels.shape}")
        apart = np.abs(shown.astype(int) - pixels).max(-1)
        raise AssertionError(f"another picture stays: {(apart > tolerance).sum()} pixels differ, by up to {apart.max()}")

    def centre(self):
        box = self.canvas.bounding_box()
        return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

    def drag(self, dx, dy, button="left"):
        x, y = self.centre()
        mouse = self.page.mouse
        mouse.move(x, y)
        mouse.down(button=button)
        mouse.move(x + dx, y + dy, steps=6)
        mouse.up(button=button)

    def tab(self, name):
        self.page.get_by_role("tab", name=name).click()


@pytest.fixture
def open_page(browser, server):
    contexts, faults = [], []

    def open_page(url=None, width=700, height=420, **options):
        contexts.append(browser.new_context(viewport={"width": width, "height": height}, **options))
        return Page(contexts[-1], url or server.url, faults)

    yield open_page
    for context in contexts:
        context.close()
    assert not faults

"""A JupyterLab with Debian's Chromium. `make check-notebook` installs what it needs into an environment of its own."""

import json
import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request

import nbformat
import pytest
from playwright.sync_api import expect, sync_playwright

PATIENCE_MS = 90000
TOKEN = "notebook-test"

_cache = tempfile.TemporaryDirectory(prefix="easypbr-test-cache-")
os.environ["EASYPBR_CACHE_DIR"] = _cache.name

SCENE = """import easypbr
scene = easypbr.Scene()
scene.show(easypbr.shapes.box((3, 0.2, 0.5)), "bar")
view = easypbr.Viewer((320, 240), {"image": {"samples": 4}}, scene=scene)"""


def notebook(*cells):
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in cells])
    book.metadata["kernelspec"] = {"name": "python3", "display_name": "Python 3", "language": "python"}
    return book


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


def _free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@pytest.fixture(scope="session")
def lab(tmp_path_factory):
    """The folder of a JupyterLab that runs, and its address."""
    root = tmp_path_factory.mktemp("lab")
    port = _free_port()
    settings = {"@jupyterlab/apputils-extension:notification": {"checkForUpdates": False, "fetchNews": "false"}}
    home = tmp_path_factory.mktemp("home")
    overrides = home / "settings"
    overrides.mkdir()
    (overrides / "overrides.json").write_text(json.dumps(settings))
    command = [sys.executable, "-m", "jupyterlab", "--no-browser", "--allow-root", f"--port={port}", f"--IdentityProvider.token={TOKEN}",
               "--LabApp.expose_app_in_browser=True", f"--ServerApp.root_dir={root}", f"--LabApp.app_settings_dir={overrides}"]
    environment = os.environ | {"HOME": str(home), "JUPYTER_CONFIG_DIR": str(home / "config"), "JUPYTER_DATA_DIR": str(home / "data"),
                                "JUPYTER_RUNTIME_DIR": str(home / "runtime"), "IPYTHONDIR": str(home / "ipython")}
    with open(home / "log", "w") as log:
        process = subprocess.Popen(command, stdout=log, stderr=log, env=environment)
        try:
            address = f"http://127.0.0.1:{port}"
            _wait_for(f"{address}/api/status?token={TOKEN}", process, home / "log")
            yield pathlib.Path(root), address
        finally:
            process.terminate()
            process.wait(30)


def _wait_for(url, process, log):
    for _ in range(PATIENCE_MS // 200):
        assert process.poll() is None, log.read_text()
        try:
            with urllib.request.urlopen(url, timeout=5) as answer:
                if answer.status == 200:
                    return
        except OSError:
            time.sleep(0.2)
    raise AssertionError(log.read_text())


class Lab:
    """A notebook that is open in JupyterLab, and what a test asks of it."""

    def __init__(self, page, folder, address, name, cells):
        self.page, self.path = page, folder / name
        nbformat.write(notebook(*cells), self.path)
        page.set_default_timeout(PATIENCE_MS)
        page.goto(f"{address}/lab/tree/{name}?token={TOKEN}&reset")
        page.wait_for_selector(".jp-Notebook .jp-Cell")
        page.wait_for_selector(".jp-Notebook-ExecutionIndicator[data-status='idle']")

    def run(self, number):
        """Runs a cell by its place in the notebook, from 0: the command of Ctrl+Enter, for JupyterLab loses keys while it
        loads its extensions."""
        cell = self.page.locator(".jp-Notebook .jp-CodeCell").nth(number)
        cell.locator(".jp-InputArea-editor").click()
        expect(cell).to_have_class(re.compile("jp-mod-active"))
        self.page.evaluate("() => { window.jupyterapp.commands.execute('notebook:run-cell'); }")
        expect(cell.locator(".jp-InputArea-prompt")).not_to_have_text("[ ]:")

    def canvas(self, number=0):
        return self.page.locator(".jp-OutputArea canvas.picture").nth(number)

    def exact(self, number=0, newer_than=0):
        """Waits for the picture at rest; returns its number."""
        self.canvas(number).wait_for()
        self.page.wait_for_function(
            """([number, newest]) => {
                const hosts = [...document.querySelectorAll(".jp-OutputArea [data-lm-suppress-shortcuts]")];
                const canvas = hosts.filter((host) => host.shadowRoot)[number]?.shadowRoot.querySelector("canvas.picture");
                return canvas?.dataset.exact === "true" && Number(canvas.dataset.frame) > newest;
            }""", arg=[number, newer_than])
        return int(self.canvas(number).get_attribute("data-frame"))

    def pixels(self, number=0):
        return self.canvas(number).evaluate("canvas => canvas.toDataURL()")

    def drag(self, dx, dy, number=0):
        canvas = self.canvas(number)
        canvas.scroll_into_view_if_needed()
        box = canvas.bounding_box()
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        mouse = self.page.mouse
        mouse.move(x, y)
        mouse.down()
        mouse.move(x + dx, y + dy, steps=8)
        mouse.up()

    def text_of(self, number):
        """What a cell has printed, once there is something."""
        output = self.page.locator(".jp-Notebook .jp-CodeCell").nth(number).locator(".jp-OutputArea-output pre").last
        output.wait_for()
        return output.inner_text().strip()

    def save(self):
        self.page.keyboard.press("Control+s")
        self.page.wait_for_function("!document.querySelector('.jp-mod-current .jp-mod-dirty, .jp-mod-current.jp-mod-dirty')")
        return nbformat.read(self.path, 4)


@pytest.fixture
def open_lab(browser, lab):
    contexts, faults = [], []

    def open_lab(name, *cells, width=1000, height=900):
        contexts.append(browser.new_context(viewport={"width": width, "height": height}))
        page = contexts[-1].new_page()
        page.on("pageerror", lambda error: faults.append(str(error)))
        return Lab(page, *lab, name, cells)

    yield open_lab
    for context in contexts:
        context.close()
    assert not faults

#!/usr/bin/env python3
"""Screenshots of the browser view for docs/remote.md, at three sizes. Needs `scripts/setup.sh tests` and the demo's data.

usage: remote_screenshots.py MESH [FOLDER]      FOLDER: docs/screenshots by default
"""
import pathlib
import shutil
import sys

from playwright.sync_api import Browser, Page, sync_playwright

import easypbr

ROOT = pathlib.Path(__file__).parents[1]


def settled(page: Page) -> None:
    page.wait_for_selector('canvas[data-exact="true"]', timeout=300000)
    page.wait_for_timeout(1500)


def open_page(browser: Browser, url: str, width: int, height: int, **options: object) -> Page:
    page = browser.new_context(viewport={"width": width, "height": height}, **options).new_page()
    page.goto(url)
    settled(page)
    return page


def keep(page: Page, path: pathlib.Path) -> None:
    settled(page)
    page.screenshot(path=path, type="jpeg", quality=80)
    page.context.close()


def main(mesh: str, folder: pathlib.Path) -> None:
    scene = easypbr.Scene()
    scene.show(mesh, pathlib.Path(mesh).stem)
    view = easypbr.Viewer((1280, 720), {"image": {"samples": 8}}, scene=scene)
    with view.serve() as server, sync_playwright() as playwright:
        # Chromium's own sandbox does not work for root.
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        page = open_page(browser, server.url, 1440, 900, color_scheme="dark")
        box = page.locator("canvas.picture").bounding_box()
        assert box
        page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
        page.get_by_label("Picked").wait_for()
        keep(page, folder / "remote_desktop.jpg")
        page = open_page(browser, server.url, 1024, 768, color_scheme="light")
        page.get_by_role("tab", name="Camera").click()
        page.get_by_role("button", name="Turntable").click()
        keep(page, folder / "remote_small.jpg")
        page = open_page(browser, server.url, 390, 844, color_scheme="dark", has_touch=True, is_mobile=True)
        page.get_by_role("button", name="Show everything").click()
        page.wait_for_timeout(1000)
        keep(page, folder / "remote_phone.jpg")
        with easypbr.Viewer((1280, 720), scene=easypbr.Scene()).serve(files=pathlib.Path(mesh).parent) as files:
            page = browser.new_page(viewport={"width": 1024, "height": 768}, color_scheme="light")
            page.goto(files.url)
            page.get_by_role("button", name=pathlib.Path(mesh).name, exact=True).click()
            keep(page, folder / "remote_files.jpg")
        browser.close()


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    main(sys.argv[1], pathlib.Path(sys.argv[2]) if len(sys.argv) == 3 else ROOT / "docs/screenshots")

"""Files beneath a folder that is served, opened in the page."""

import easypbr
import pytest
from playwright.sync_api import expect
from test_tools import accessible, look_at, panel


@pytest.fixture
def view():
    return easypbr.Viewer((320, 240), {"image": {"samples": 4}}, scene=easypbr.Scene())


@pytest.fixture
def server(view, tmp_path):
    (tmp_path / "parts").mkdir()
    easypbr.shapes.box(1).save(tmp_path / "box.ply")
    easypbr.shapes.torus(1, 0.3).save(tmp_path / "parts" / "torus <b>.ply")
    with view.serve(files=tmp_path) as server:
        yield server


def test_a_file_is_opened_then_another(view, open_page):
    page = open_page(width=1100, height=900)
    files = panel(page, "Files")
    files.get_by_role("button", name="box.ply").click()
    box = page.exact()
    assert view.scene.names() == ["box"]
    files.get_by_role("button", name="parts/").click()
    torus = files.get_by_role("button", name="torus <b>.ply")
    torus.click()
    page.exact(box)
    expect(page.page.locator(".toolbar")).to_contain_text("torus <b>")
    assert view.scene.names() == ["torus <b>"]
    look_at(page, "files")
    accessible(page)
    files.get_by_role("button", name="..", exact=True).click()
    files.get_by_label("Find").fill("none such")
    files.get_by_label("Find").press("Enter")
    expect(files).to_contain_text("nothing here that can be opened")


def test_a_watcher_sees_no_files(view, server, open_page):
    page = open_page(server.watch_url, width=1100, height=900)
    expect(panel(page, "Lights")).to_be_visible()
    expect(panel(page, "Files")).to_have_count(0)

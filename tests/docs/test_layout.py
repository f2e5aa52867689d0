"""The site in a browser, every page at two widths: nothing is cut, every picture is there, the search finds."""

import json
import shutil
import subprocess
import sys
import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer

import pytest
from playwright.sync_api import sync_playwright

from snippets import ROOT

sys.path.insert(0, str(ROOT / "scripts"))
import write_reference  # noqa: E402

WIDTHS = (1200, 1920)
#: How far the page, its tables and its blocks reach beyond what is shown, in pixels; the narrowest last column of a table that
#: explains names; pictures that are missing; blocks that should stand side by side and do not.
MEASURE = """() => {
  const shown = document.querySelector(".wy-nav-content").getBoundingClientRect();
  const all = (selector) => [...document.querySelectorAll(".wy-nav-content " + selector)];
  const beyond = (element) => Math.max(element.getBoundingClientRect().right - shown.right,
                                       element.parentElement.scrollWidth - element.parentElement.clientWidth);
  return {
    page: document.documentElement.scrollWidth - window.innerWidth,
    cut: Math.max(0, ...all("table, pre, img, .beside").map(beyond),
                  ...all(".beside pre code").map((code) => code.scrollWidth - code.clientWidth)),
    last: Math.min(1e9, ...all("table td:last-child").map((cell) => cell.getBoundingClientRect().width)),
    missing: all("img").filter((image) => !image.complete || image.naturalWidth === 0).map((image) => image.src),
    below: all(".beside").filter((pair) => pair.children.length === 2 &&
        Math.abs(pair.children[0].getBoundingClientRect().top - pair.children[1].getBoundingClientRect().top) > 60).length,
    pairs: all(".beside").length,
  };
}"""


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    folder = tmp_path_factory.mktemp("site")
    shutil.copytree(ROOT / "docs", folder / "docs", ignore=shutil.ignore_patterns("reference"))
    write_reference.write_reference(folder / "docs/reference")
    shutil.copy(ROOT / "mkdocs.yml", folder)
    subprocess.run([sys.executable, "-m", "mkdocs", "build", "--quiet"], cwd=folder, check=True, timeout=300)
    return folder / "site"


@pytest.fixture(scope="module")
def address(site):
    """Served, for the search loads its index by a request."""

    class Quiet(SimpleHTTPRequestHandler):
        def log_message(self, *_):
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=site))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}"
    server.shutdown()


@pytest.fixture(scope="module")
def page():
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        page = browser.new_page()
        page.set_default_timeout(60000)
        yield page
        browser.close()


def measured(page, site, address):
    """What was measured of each page at each width, by (page, width)."""
    found = {}
    for width in WIDTHS:
        page.set_viewport_size({"width": width, "height": 900})
        for path in sorted(site.rglob("index.html")):
            name = path.parent.relative_to(site).as_posix()
            page.goto(f"{address}/{name}/", wait_until="load")
            found[name, width] = page.evaluate(MEASURE)
    return found


def test_every_page_is_whole_at_both_widths(page, site, address):
    found = measured(page, site, address)
    assert len(found) >= 2 * 50
    faults = []
    for (name, width), m in found.items():
        if m["page"] > 1 or m["cut"] > 1:
            faults.append(f"{name} at {width}: {max(m['page'], m['cut']):.0f} pixels are cut")
        if m["missing"]:
            faults.append(f"{name}: {m['missing']}")
        if m["below"]:
            faults.append(f"{name} at {width}: {m['below']} of {m['pairs']} pairs are not side by side")
    assert not faults, "\n".join(faults)
    # A sentence needs room; settings have the longest ones.
    assert min(found["reference/settings", width]["last"] for width in WIDTHS) >= 160
    assert found["reference/gallery", 1200]["pairs"] > 40 and found["from_pyvista", 1200]["pairs"] >= 5


@pytest.mark.parametrize("word, name", [("surfel", "data_kinds"), ("apply_preset", "reference/cpp"), ("DLPack", "glossary")])
def test_the_search_finds(page, address, word, name):
    page.goto(f"{address}/search.html?q={word}")
    page.wait_for_selector("#mkdocs-search-results article")
    found = page.eval_on_selector_all("#mkdocs-search-results article a", "links => links.map(link => link.pathname)")
    assert any(path.startswith(f"/{name}/") for path in found), found


def test_the_root_has_what_assistants_read(site):
    assert (site / "llms.txt").read_text().startswith("# EasyPBR\n")
    index = json.loads((site / "search/search_index.json").read_text())
    assert len(index["docs"]) > 300

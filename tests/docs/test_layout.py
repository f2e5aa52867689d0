"""The pages in a browser, at two widths: no table is cut."""
import re
import shutil
import subprocess
import sys

import pytest

from snippets import ROOT

sys.path.insert(0, str(ROOT / "scripts"))
import write_reference  # noqa: E402

#: Writes how far the widest table reaches beyond what is shown, and how wide its last column is, into the page's title.
MEASURE = """<script>
window.addEventListener("load", () => {
  const shown = document.querySelector(".wy-nav-content").getBoundingClientRect().right;
  const tables = [...document.querySelectorAll("table")];
  const beyond = Math.max(...tables.map(t => Math.max(t.getBoundingClientRect().right - shown, t.parentElement.scrollWidth - t.parentElement.clientWidth)));
  const last = Math.min(...tables.map(t => t.querySelector("td:last-child").getBoundingClientRect().width));
  document.title = `beyond=${beyond} last=${last} page=${document.documentElement.scrollWidth - window.innerWidth}`;
});
</script>"""


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    folder = tmp_path_factory.mktemp("site")
    shutil.copytree(ROOT / "docs", folder / "docs", ignore=shutil.ignore_patterns("reference"))
    write_reference.write_reference(folder / "docs/reference")
    shutil.copy(ROOT / "mkdocs.yml", folder)
    subprocess.run([sys.executable, "-m", "mkdocs", "build", "--quiet"], cwd=folder, check=True, timeout=300)
    return folder / "site"


@pytest.mark.parametrize("width", [1200, 1920])
@pytest.mark.parametrize("name", ["reference/settings", "command_line", "python", "pyrender"])
def test_tables_are_whole(site, name, width, tmp_path):
    page = site / name / "index.html"
    measured = page.with_name(f"measured-{width}.html")
    measured.write_text(page.read_text().replace("</body>", MEASURE + "</body>"))
    command = ["chromium", "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path}", f"--window-size={width},900",
               "--virtual-time-budget=5000", "--dump-dom", measured.as_uri()]  # fmt: skip
    dom = subprocess.run(command, capture_output=True, text=True, check=True, timeout=120).stdout
    found = re.search(r"<title>beyond=([-\d.]+) last=([-\d.]+) page=([-\d.]+)</title>", dom)
    assert found, dom[:400]
    beyond, last, whole = map(float, found.groups())
    assert beyond <= 1 and whole <= 1, "a table is cut"
    assert last >= 160, "its last column has no room for a sentence"

"""What the library embeds is what the sources make, and is small."""

import gzip
import pathlib
import shutil
import subprocess

import pytest

WEB = pathlib.Path(__file__).parents[2] / "web"
DIST = WEB / "dist"


def files_of(folder):
    return sorted(path for path in folder.rglob("*") if path.is_file())


@pytest.mark.parametrize("paths, most, most_packed", [
    ([path for path in files_of(DIST) if path.parent == DIST], 100_000, 35_000),
    ([DIST / "offline/widget.js"], 100_000, 35_000),
    ([DIST / "offline/orbit.html"], 10_000, 5_000),
], ids=["page", "widget", "orbit"])
def test_it_is_small(paths, most, most_packed):
    files = [path.read_bytes() for path in paths]
    assert 0 < sum(map(len, files)) <= most
    assert sum(len(gzip.compress(data)) for data in files) <= most_packed


def test_nothing_is_asked_of_other_machines():
    for path in files_of(DIST):
        text = path.read_text().replace("http://www.w3.org/2000/svg", "").replace("http://www.w3.org/1999/xlink", "")
        text = text.replace("http://www.w3.org/1998/Math/MathML", "").replace("http://www.w3.org/1999/xhtml", "")
        assert "http://" not in text and "https://" not in text, path.name


def test_the_sources_make_these_files(tmp_path):
    npm = shutil.which("npm")
    if not npm:
        pytest.skip("npm is not installed")
    work = tmp_path / "web"
    shutil.copytree(WEB, work, ignore=shutil.ignore_patterns("node_modules", "dist"))
    for command in (["ci", "--no-audit", "--no-fund"], ["run", "build"]):
        done = subprocess.run([npm, *command], cwd=work, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
    made = {path.relative_to(work / "dist"): path.read_bytes() for path in files_of(work / "dist")}
    assert made == {path.relative_to(DIST): path.read_bytes() for path in files_of(DIST)}

"""What the library embeds is what the sources make, and is small."""

import gzip
import pathlib
import shutil
import subprocess

import pytest

WEB = pathlib.Path(__file__).parents[2] / "web"
DIST = WEB / "dist"


def test_the_page_is_small():
    files = [path.read_bytes() for path in DIST.iterdir()]
    assert sum(map(len, files)) <= 100_000
    assert sum(len(gzip.compress(data)) for data in files) <= 35_000


def test_nothing_is_asked_of_other_machines():
    for path in DIST.iterdir():
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
    made = {path.name: path.read_bytes() for path in (work / "dist").iterdir()}
    assert made == {path.name: path.read_bytes() for path in DIST.iterdir()}

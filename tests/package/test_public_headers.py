"""The installed headers: few, without what the library is made of, and each can be included alone."""
import platform
import re
import shutil
import subprocess

import pytest

from test_package import ROOT, run

FLAGS = ["-std=c++20", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Wsign-conversion", "-Werror",
         "-fsyntax-only"]
COMPILER = shutil.which("g++") or shutil.which("c++")


@pytest.fixture(scope="module")
def include(tmp_path_factory):
    prefix = tmp_path_factory.mktemp("prefix")
    run("cmake", "--install", ROOT / "build", "--prefix", prefix, cwd=prefix)
    return prefix / "include"


def eigen():
    """Eigen's folder, as the build found it."""
    cache = (ROOT / "build/CMakeCache.txt").read_text()
    cmake = re.search(r"^Eigen3_DIR:PATH=(.*)$", cache, re.M)[1]
    return re.search(r"^(.*)/(?:share|lib)", cmake)[1] + "/include/eigen3"


def compile_text(include, folder, *more):
    return run(COMPILER, *FLAGS, "-isystem", eigen(), "-I", include, *more, cwd=folder).stdout


def headers(include):
    return sorted(str(path.relative_to(include)) for path in include.rglob("*.*"))


def test_installed_headers_are_few_and_those_of_the_tree(include):
    assert headers(include) == headers(ROOT / "include")
    of_effects = [name for name in headers(include) if "/effects/" in name]
    assert len(headers(include)) - len(of_effects) <= 49


def test_the_face_reads_nothing_but_public_headers_eigen_and_the_standard_library(include, tmp_path):
    (tmp_path / "face.cpp").write_text("".join(f"#include <{name}>\n" for name in headers(include)))
    read = run(COMPILER, "-std=c++20", "-M", "-isystem", eigen(), "-I", include, "face.cpp", cwd=tmp_path).stdout
    found = set(re.findall(r"\S+/(epoxy|fmt|nlohmann|tbb|oneapi|imgui|CLI|GL|GLFW)/\S+", read))
    assert not found
    assert len(re.findall(re.escape(str(include)) + r"\S+\.h", read)) == len(headers(include))


@pytest.mark.parametrize("backwards", [False, True])
def test_headers_need_no_other_before_them(include, tmp_path, backwards):
    """Each header in one file, in both orders: one of them lacks what a header takes for granted."""
    names = sorted(headers(include), reverse=backwards)
    (tmp_path / "all.cpp").write_text("".join(f"#include <{name}>\n" for name in names))
    compile_text(include, tmp_path, "all.cpp")


def test_templates_of_headers_compile_without_warnings(include, tmp_path):
    """Warnings of a template show only where a program uses it."""
    (tmp_path / "uses.cpp").write_text("""
#include <easypbr/easypbr.h>
using namespace easypbr;

float use(Image& image, const Image& other, const Eigen::MatrixXd& V, const Eigen::MatrixXi& F) {
    image.pixels<float>()[0] = other.pixels<float>()[0];
    *image.at<float>(1, 2) = *other.at<float>(2, 1);
    const Array3i faces(F);
    Mesh mesh(V, F), same(V, faces);
    mesh.set_V(V);
    mesh.set_V(Array3f(V));
    mesh.set_positions(V);
    mesh.add_scalar("height", Eigen::VectorXd(V.col(2)));
    return *image.at<float>(0, 0);
}
""")
    compile_text(include, tmp_path, "uses.cpp")


@pytest.mark.parametrize("flag", ["-march=x86-64-v3", "-DEIGEN_DONT_VECTORIZE"])
def test_another_layout_of_eigen_is_an_error_that_names_the_way_out(include, tmp_path, flag):
    """Such a program would crash: its vectors, and types that have them, are not aligned as the library's."""
    if flag.startswith("-march") and platform.machine() != "x86_64":
        pytest.skip("an instruction set of x86-64")
    (tmp_path / "array.cpp").write_text("#include <easypbr/scene/array.h>\n")
    command = [COMPILER, *FLAGS, "-isystem", eigen(), "-I", include, flag, "array.cpp"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode != 0
    advice = re.search(r"EasyPBR: compile all of the program with (-D\w+=\d+)", done.stderr)[1]
    run(*command, advice, cwd=tmp_path)


@pytest.mark.parametrize("flag, message", [
    ("-DEIGEN_DEFAULT_TO_ROW_MAJOR", "compile without EIGEN_DEFAULT_TO_ROW_MAJOR"),
    ("-DEIGEN_DEFAULT_DENSE_INDEX_TYPE=int", "compile without EIGEN_DEFAULT_DENSE_INDEX_TYPE"),
    ("-D_GLIBCXX_DEBUG", "compile without _GLIBCXX_DEBUG"),
])  # fmt: skip
def test_other_layouts_are_errors_that_name_the_way_out(include, tmp_path, flag, message):
    """Mat3, Mat4 and poses would be transposed; arrays, and types with a std::vector, would have other sizes."""
    (tmp_path / "array.cpp").write_text("#include <easypbr/scene/array.h>\n")
    command = [COMPILER, *FLAGS, "-isystem", eigen(), "-I", include, "-DEIGEN_MAX_STATIC_ALIGN_BYTES=16", "array.cpp"]
    run(*command, cwd=tmp_path)
    done = subprocess.run([*command, flag], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode != 0
    assert f"EasyPBR: {message}" in done.stderr


def test_every_header_with_a_vector_refuses_the_debug_mode_of_the_standard_library(include, tmp_path):
    for name in headers(include):
        if "std::vector" not in (include / name).read_text():
            continue
        (tmp_path / "one.cpp").write_text(f"#include <{name}>\n")
        command = [COMPILER, "-std=c++20", "-E", "-isystem", eigen(), "-I", include, "-DEIGEN_MAX_STATIC_ALIGN_BYTES=16",
                   "-D_GLIBCXX_DEBUG", "one.cpp"]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
        assert "EasyPBR: compile without _GLIBCXX_DEBUG" in done.stderr, name


def test_a_library_in_the_debug_mode_of_the_standard_library_asks_programs_for_it(include, tmp_path):
    """Both are defined by the CMake target then: the headers take them."""
    (tmp_path / "array.cpp").write_text("#include <easypbr/scene/array.h>\n")
    flags = ["-DEIGEN_MAX_STATIC_ALIGN_BYTES=16", "-D_GLIBCXX_DEBUG", "-DEASYPBR_GLIBCXX_DEBUG"]
    compile_text(include, tmp_path, *flags, "array.cpp")


def test_comments_name_no_header_that_is_not_installed(include):
    for name in headers(include):
        for found in re.findall(r"\b\w+(?:/\w+)+\.h\b", (include / name).read_text()):
            assert any((include / folder / found).is_file() for folder in ("", "easypbr")), f"{name}: {found}"


def test_one_header_includes_the_others_as_the_documentation_says(include):
    """docs/cpp.md: all but dataset/ground_truth.h."""
    command = [COMPILER, "-std=c++20", "-M", "-isystem", eigen(), "-I", include, include / "easypbr/easypbr.h"]
    read = run(*command, cwd=include).stdout
    missing = [name for name in headers(include) if f"{include / name}" not in read.replace("\\\n", " ").split()]
    assert missing == ["easypbr/dataset/ground_truth.h"]


def test_a_private_header_is_refused(tmp_path):
    """check_includes.py says so when a public header includes one of the library's own, or of others."""
    tree = tmp_path / "tree"
    for folder in ("include", "src", "python"):
        shutil.copytree(ROOT / folder, tree / folder, ignore=shutil.ignore_patterns("__pycache__"))
    log = tree / "include/easypbr/core/log.h"
    plain = log.read_text()
    for line in ('#include "easypbr/core/file.h"', "#include <epoxy/gl.h>", "#include <fmt/format.h>"):
        log.write_text(plain.replace("#pragma once", "#pragma once\n" + line))
        done = subprocess.run(["python3", ROOT / "scripts/check_includes.py", tree], capture_output=True, text=True)
        assert done.returncode == 1
        assert "include/easypbr/core/log.h:" in done.stdout and "public header" in done.stdout

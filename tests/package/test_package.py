"""The installed library: an outside program finds it, builds and runs after the source tree is out of reach, and makes
the same picture as the Python program of the same five lines."""
import os
import pathlib
import platform
import shlex
import shutil
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
OUTSIDE = pathlib.Path(__file__).parent / "outside"

SCRIPT = """
from easypbr import *
view  = Viewer()
view.load_environment_map("./map.hdr")
drone = Mesh("./drone.ply")
Scene.show(drone, "drone")
view.recorder.record("img.png")
"""


def run(*command, cwd):
    result = subprocess.run([str(c) for c in command], cwd=cwd, capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr
    return result


def write_inputs(folder):
    """A small environment and a tetrahedron, written by hand."""
    width, height = 32, 16
    rows = b"".join(bytes([2, 2, 0, width]) + b"".join(bytes([128 + width % 128, value]) * (width // 32)
                    for value in (100 + y * 8, 120, 140, 129)) for y in range(height))
    (folder / "map.hdr").write_bytes(
        f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode() + rows)
    (folder / "drone.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n")


def test_outside_program_matches_python(tmp_path):
    prefix, source, build = tmp_path / "prefix", tmp_path / "source", tmp_path / "build"
    run("cmake", "--install", ROOT / "build", "--prefix", prefix, cwd=tmp_path)
    shutil.copytree(OUTSIDE, source)
    for path in prefix.rglob("*.cmake"):
        assert str(ROOT) not in path.read_text(), f"{path.name} points into the source tree"
    run("cmake", "-S", source, "-B", build, f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Release", cwd=tmp_path)
    run("cmake", "--build", build, cwd=tmp_path)

    work = tmp_path / "work"
    work.mkdir()
    write_inputs(work)
    # The program must not find anything in the tree: it runs with the tree's shared library out of its search path.
    libraries = run("ldd", build / "outside", cwd=work).stdout
    assert str(prefix) in libraries and str(ROOT) not in libraries
    run(build / "outside", "drone.ply", "map.hdr", "cpp.png", cwd=work)

    run(sys.executable, "-c", SCRIPT, cwd=work)
    comparison = run(ROOT / "build/easypbr", "compare", "cpp.png", "img.png", cwd=work)
    assert (work / "cpp.png").read_bytes() == (work / "img.png").read_bytes(), comparison.stdout


def test_pkg_config_serves_builds_without_cmake(tmp_path):
    """The flags suffice to build and run the program, from a prefix that was moved after the installation."""
    run("cmake", "--install", ROOT / "build", "--prefix", tmp_path / "first", cwd=tmp_path)
    prefix = (tmp_path / "first").rename(tmp_path / "moved")
    (found,) = prefix.rglob("easypbr.pc")
    environment = {**os.environ, "PKG_CONFIG_PATH": str(found.parent)}
    ask = ["pkg-config", "--cflags", "--libs", "easypbr >= 0.1"]
    flags = shlex.split(subprocess.run(ask, env=environment, capture_output=True, text=True, check=True).stdout)
    run("c++", "-std=c++20", OUTSIDE / "main.cpp", *flags, f"-Wl,-rpath,{found.parent.parent}", "-o", "outside",
        cwd=tmp_path)
    write_inputs(tmp_path)
    run(tmp_path / "outside", "drone.ply", "map.hdr", "cpp.png", cwd=tmp_path)
    assert (tmp_path / "cpp.png").stat().st_size > 1000
    missing = subprocess.run(["pkg-config", "--exists", "easypbr >= 99"], env=environment, check=False)
    assert missing.returncode != 0


@pytest.fixture(scope="module")
def package_flags(tmp_path_factory):
    """What pkg-config says of an installed library, and where the library is."""
    prefix = tmp_path_factory.mktemp("prefix")
    run("cmake", "--install", ROOT / "build", "--prefix", prefix, cwd=prefix)
    (found,) = prefix.rglob("easypbr.pc")
    ask = ["pkg-config", "--cflags", "--libs", "easypbr"]
    environment = {**os.environ, "PKG_CONFIG_PATH": str(found.parent)}
    flags = shlex.split(subprocess.run(ask, env=environment, capture_output=True, text=True, check=True).stdout)
    return [*flags, f"-Wl,-rpath,{found.parent.parent}"]


@pytest.mark.parametrize("flags", [["-O1", "-march=x86-64-v3"], ["-O1", "-fsanitize=address"], ["-O0", "-DEIGEN_DONT_VECTORIZE"]],
                         ids=lambda flags: flags[1])
def test_programs_with_other_flags_share_arrays_with_the_library(package_flags, tmp_path, flags):
    """Eigen aligns and allocates matrices in another way with them: each side has to free what it has allocated."""
    if "-march=x86-64-v3" in flags and platform.machine() != "x86_64":
        pytest.skip("an instruction set of x86-64")
    run("c++", "-std=c++20", *flags, OUTSIDE / "arrays.cpp", *package_flags, "-o", "arrays", cwd=tmp_path)
    if "-march=x86-64-v3" in flags and not {"avx2", "fma", "bmi2"} <= set(pathlib.Path("/proc/cpuinfo").read_text().split()):
        pytest.skip("the processor has no AVX2")
    # Leaks are not what is looked for, and cannot be under a debugger.
    environment = {**os.environ, "ASAN_OPTIONS": "detect_leaks=0"}
    done = subprocess.run([tmp_path / "arrays"], env=environment, capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (0, "4.5\n"), done.stderr


def test_a_part_of_another_project_is_the_library_alone(tmp_path):
    """By FetchContent; `make check-long` builds it."""
    run("cmake", "-G", "Ninja", "-S", ROOT / "tests/package/fetched", "-B", tmp_path, f"-DEASYPBR_SOURCE={ROOT}", cwd=tmp_path)
    plan = run("ninja", "-t", "commands", "fetched", cwd=tmp_path).stdout
    assert "libeasypbr.so" in plan and "outside/main.cpp" in plan
    assert "-Werror" not in plan and "_test.cpp" not in plan and "/bench/" not in plan
    assert "nanobind" not in run("ninja", "-t", "commands", "all", cwd=tmp_path).stdout
    # It installs nothing among what the other project does.
    run("cmake", "--install", tmp_path, "--prefix", tmp_path / "prefix", cwd=tmp_path)
    assert not (tmp_path / "prefix").exists() or not [path for path in (tmp_path / "prefix").rglob("*") if path.is_file()]

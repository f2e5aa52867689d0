"""What a newcomer's first build costs: `make demo` compiles the product and no test, a program of five lines is light."""

import re
import resource
import subprocess

import pytest

from test_package import ROOT
from test_public_headers import COMPILER, eigen

#: As README shows it.
PROGRAM = """#include <easypbr/easypbr.h>

int main() {
    easypbr::Viewer view;
    view.load_environment_map("map.hdr");
    easypbr::show(easypbr::Mesh("drone.ply"), "drone");
    view.recorder.record("img.png");
}
"""


def targets_of_library() -> list[str]:
    """What `make demo` builds, as the Makefile says."""
    return re.search(r"^library:.*?--target ([\w ]+)$", (ROOT / "Makefile").read_text(), re.M | re.S)[1].split()


def compilations(*targets: str) -> list[str]:
    said = subprocess.run(["ninja", "-C", "build", "-t", "commands", *targets], cwd=ROOT, capture_output=True, text=True, check=True)
    return [re.search(r" -c (\S+)", line)[1] for line in said.stdout.splitlines() if " -c " in line]


@pytest.mark.skipif(not (ROOT / "build/build.ninja").exists(), reason="there is no build of ninja's here")
def test_make_demo_compiles_the_product_alone():
    assert re.search(r"^demo: library$", (ROOT / "Makefile").read_text(), re.M)
    compiled, everything = compilations(*targets_of_library()), compilations("all")
    assert not [source for source in compiled if "/tests/" in source or "/bench/" in source or "test_" in source]
    # 57 units, of 110; precompiled headers and the three instruction sets of the kernels count too.
    assert 30 < len(compiled) <= 60
    assert set(compiled) < set(everything)


def test_five_lines_of_cpp_compile_in_little_memory(tmp_path):
    """Memory, for it does not depend on how busy the machine is. It was 315 MB, and 476 MB before the headers were thinned."""
    (tmp_path / "five.cpp").write_text(PROGRAM)
    command = [COMPILER, "-std=c++20", "-O2", "-isystem", eigen(), "-I", str(ROOT / "include"), "-c", "five.cpp", "-o", "five.o"]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, cwd=tmp_path, check=True, timeout=120)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    # The largest of all children so far: one that was larger before hides this one's.
    if after.ru_maxrss == before.ru_maxrss:
        pytest.skip("an earlier program took more, this one's memory is not known")
    assert after.ru_maxrss <= 380_000, "KiB"
    assert after.ru_utime - before.ru_utime < 6, "seconds of the processor"

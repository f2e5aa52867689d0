"""What was built has the protections of cmake/hardening.cmake, as readelf sees them."""
import pathlib
import platform
import re
import shutil
import subprocess

import pytest

from test_package import ROOT

BUILD = ROOT / "build"
PROGRAMS = ["easypbr", "easypbr_read_assimp"]
LIBRARIES = ["libeasypbr.so", "libeasypbr_ffmpeg.so", "libeasypbr_draco.so", "python/easypbr/_easypbr.*.so"]


def built(pattern) -> pathlib.Path:
    found = sorted(BUILD.glob(pattern))
    if not found:
        pytest.skip(f"{pattern} is not built")
    return found[0]


def readelf(option, path) -> str:
    if shutil.which("readelf") is None:
        pytest.skip("readelf is missing (binutils)")
    return subprocess.run(["readelf", "-W", option, path], capture_output=True, text=True, check=True).stdout


@pytest.mark.parametrize("name", PROGRAMS + LIBRARIES)
def test_memory_that_is_written_once_is_read_only(name):
    """Relocations are done at start and sealed then; nothing is writable and executable."""
    path = built(name)
    segments = re.findall(r"^ +(\w+) +0x.* ([RWE ]{3}) 0x", readelf("-l", path), re.MULTILINE)
    assert "GNU_RELRO" in dict(segments)
    assert {flags.replace(" ", "") for kind, flags in segments if kind == "GNU_STACK"} == {"RW"}
    assert not [kind for kind, flags in segments if "W" in flags and "E" in flags]
    assert re.search(r"\(FLAGS\).*BIND_NOW|\(FLAGS_1\).*\bNOW\b", readelf("-d", path))


@pytest.mark.parametrize("name", LIBRARIES)
def test_variables_of_threads_leave_room_on_small_stacks(name):
    """glibc takes them from the stack of every thread, also of those that the library does not start. 2 KiB are a few pointers of each
    room, and a fiftieth of a stack of 100 KiB."""
    sizes = re.findall(r"^ +TLS +0x\w+ 0x\w+ 0x\w+ 0x\w+ 0x(\w+)", readelf("-l", built(name)), re.MULTILINE)
    assert all(int(size, 16) <= 2048 for size in sizes), sizes


@pytest.mark.parametrize("name", PROGRAMS)
def test_programs_are_placed_at_random(name):
    path = built(name)
    assert re.search(r"Type: +DYN", readelf("-h", path)) and re.search(r"\(FLAGS_1\).*\bPIE\b", readelf("-d", path))


@pytest.mark.parametrize("name", PROGRAMS + LIBRARIES)
def test_stacks_and_copies_are_checked(name):
    path = built(name)
    imported = set(re.findall(r"UND (\w+)@GLIBC", readelf("--dyn-syms", path)))
    assert "__stack_chk_fail" in imported
    if path.name.startswith("libeasypbr.so"):
        assert {"__memcpy_chk", "__memset_chk"} <= imported, "-D_FORTIFY_SOURCE"


@pytest.mark.skipif(platform.machine() != "x86_64", reason="an instruction of x86")
def test_indirect_jumps_land_at_marked_places():
    """endbr64, f3 0f 1e fa, begins the functions that others may call."""
    library = built("libeasypbr.so")
    functions = re.findall(r" ([0-9a-f]{16}) +\d+ FUNC +GLOBAL DEFAULT +\d+ _ZN7easypbr", readelf("--dyn-syms", library))
    addresses = [int(address, 16) for address in functions]
    assert len(addresses) > 1000
    text = re.search(r" \.text +PROGBITS +([0-9a-f]+) ([0-9a-f]+) ([0-9a-f]+)", readelf("-S", library))
    address, offset, size = (int(number, 16) for number in text.groups())
    content = library.read_bytes()[offset : offset + size]
    # Virtual functions and exported ones are marked; GCC leaves out none that another library may call.
    marked = sum(content[at - address : at - address + 4] == b"\xf3\x0f\x1e\xfa" for at in addresses)
    assert marked / len(addresses) > 0.95

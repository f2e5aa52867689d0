"""What the library exports is its own: a program may have another version of the libraries that it is made of."""
import re
import shutil
import subprocess

import pytest

from test_package import ROOT

# Of the Itanium C++ ABI: a nested name that begins with the namespace; before it what a table, a type, a thunk, a guard
# or a static variable of a function has.
OWN = re.compile(r"_Z(T[VTISWH]|T[hv]n?\d+_(n?\d+_)?|GV|Z|GVZ)?N[KRO]*7easypbr")


@pytest.fixture(scope="module")
def exported() -> set[str]:
    library = ROOT / "build/libeasypbr.so"
    if not library.exists():
        pytest.skip("the library is not built")
    if shutil.which("nm") is None:
        pytest.skip("nm is missing (binutils)")
    listed = subprocess.run(["nm", "-D", "--defined-only", library], capture_output=True, text=True, check=True).stdout
    return {line.split()[-1].split("@")[0] for line in listed.splitlines()}


def test_nothing_of_other_libraries_is_exported(exported):
    """Dear ImGui's GImGui is the plainest case: a program with its own Dear ImGui would share that variable."""
    assert not sorted(name for name in exported if not OWN.match(name))


def test_what_programs_share_with_the_library_is_exported(exported):
    """Functions, types of exceptions, and the table and the type of a class that programs derive from."""
    needed = {"_ZN7easypbr11make_teapotEfi", "_ZTIN7easypbr13ArgumentErrorE", "_ZTSN7easypbr13ArgumentErrorE",
              "_ZTVN7easypbr3app10ShaderPassE", "_ZTIN7easypbr3app10ShaderPassE"}
    assert needed <= exported

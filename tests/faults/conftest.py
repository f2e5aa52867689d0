"""Programs in a folder of their own, with a cache of their own."""

import pathlib
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/cli"))

from binary import BINARY  # noqa: E402
from own_environment import environment  # noqa: E402, F401


@pytest.fixture
def easypbr(environment, tmp_path):
    """Runs the command line; `before` is called in the process that becomes it."""

    def run(*arguments, before=None, **more):
        # Signals stay as Python has them: what is too large is an error then, as on a full disk, and no signal.
        return subprocess.run([str(BINARY), *map(str, arguments)], capture_output=True, text=True, cwd=tmp_path, timeout=120,
                              env={**environment, **more}, preexec_fn=before, restore_signals=False)

    return run


@pytest.fixture(scope="session")
def box(tmp_path_factory):
    """A cube of six squares."""
    path = tmp_path_factory.mktemp("meshes") / "box.obj"
    corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    faces = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]
    path.write_text("".join("v {} {} {}\n".format(*c) for c in corners) + "".join("f {} {} {} {}\n".format(*f) for f in faces))
    return path

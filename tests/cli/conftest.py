"""The command line is tested as a user runs it: the built executable in a process of its own."""
import subprocess

import pytest

import shapes
from binary import BINARY
from own_environment import environment  # noqa: F401


@pytest.fixture
def easypbr(environment, tmp_path):
    """Runs the command line in an empty folder and checks its exit code; returns the finished process."""

    def run(*arguments, code=0, text=True):
        command = [str(BINARY), *map(str, arguments)]
        done = subprocess.run(command, capture_output=True, text=text, env=environment, cwd=tmp_path, timeout=300)
        assert done.returncode == code, f"{command}\n{done.stdout!r}\n{done.stderr!r}"
        return done

    return run


@pytest.fixture
def render(easypbr):
    """Renders small and quick unless the arguments say otherwise."""

    def run(*arguments, code=0, **options):
        chosen = [] if "--size" in arguments else ["--size", "64x48"]
        chosen += [] if "--samples" in arguments else ["--samples", "1"]
        return easypbr("render", *chosen, *arguments, code=code, **options)

    return run


@pytest.fixture(scope="session")
def meshes(tmp_path_factory):
    return tmp_path_factory.mktemp("meshes")


@pytest.fixture(scope="session")
def sphere(meshes):
    return shapes.write_sphere(meshes / "sphere.obj")


@pytest.fixture(scope="session")
def box(meshes):
    return shapes.write_box(meshes / "box.obj")

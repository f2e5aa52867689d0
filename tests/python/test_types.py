"""What editors and type checkers read: the package and its generated stubs are clean under mypy and pyright."""

import json
import os
import shutil
import subprocess
import sys
import venv
from pathlib import Path

import pytest

import easypbr

ROOT = Path(__file__).parents[2]
PACKAGE = Path(easypbr.__file__).parent

#: A user's program; each line marked WRONG is a mistake that the checker must find.
PROGRAM = """\
from typing import Any
import numpy as np
from numpy.typing import NDArray
import easypbr
from easypbr import Mesh, Scene, Viewer
from easypbr.dataset import DatasetSpec, ObjectSpec, generate

view = Viewer((64, 48), {"camera.fov_y_deg": 30}, scene=Scene())
picture: NDArray[Any] = view.render(samples=4)
depth: NDArray[Any] = view.layers("depth")["depth"]
mesh: Mesh = Scene.show("drone.ply", "drone")
fov: float = view.settings.camera.fov_y_deg
names: list[str] = view.scene.names()
statistics: dict[str, Any] = generate(DatasetSpec(objects=[ObjectSpec("drone.ply")]), "out", workers=2)
version: str = easypbr.__version__
cloud: Mesh = easypbr.as_mesh(np.zeros((3, 3)), strict=True)
image: NDArray[Any] = easypbr.render([mesh, np.zeros((3, 3))], camera="front", roughness=0.3, color="red", tonemap="agx")
shared: NDArray[Any] = mesh.V
mesh.scalars["heat"] = [1.0, 2.0]
mesh.scalars.update(heat=[1.0, 2.0])
mesh.scalars = {"heat": [1.0, 2.0]}
heat: NDArray[Any] = mesh.scalars["heat"]
easypbr.render(mesh, roughnes=0.3)  # WRONG
easypbr.render(mesh, roughness="rough")  # WRONG
easypbr.render(mesh, samples="4")  # WRONG
easypbr.render(mesh, tonemap="filmic")  # WRONG
linear: str = easypbr.render(mesh, hdr=True)  # WRONG
view.render(samples="many")  # WRONG
view.focus_at(1)  # WRONG
mesh.scalars["heat"] = object()  # WRONG
view.settings.camera.fov = 3  # WRONG
view.add_panel("Mine", lambda: None)  # WRONG
view.on_event(lambda: True)  # WRONG
text: str = view.render()  # WRONG
generate("spec.toml", "out")  # WRONG
"""


def run(*command, cwd):
    return subprocess.run([sys.executable, "-m", *map(str, command)], cwd=cwd, capture_output=True, text=True, timeout=600)


def wrong_lines() -> list[int]:
    return [number for number, line in enumerate(PROGRAM.splitlines(), 1) if "WRONG" in line]


def test_mypy(tmp_path):
    pytest.importorskip("mypy")
    options = ["--config-file", ROOT / "pyproject.toml", "--cache-dir", tmp_path / "cache"]
    done = run("mypy", *options, "-p", "easypbr", cwd=PACKAGE.parent)
    assert done.returncode == 0, done.stdout + done.stderr
    (tmp_path / "program.py").write_text(PROGRAM)
    found = run("mypy", *options, tmp_path / "program.py", cwd=PACKAGE.parent).stdout
    assert sorted({int(line.split(":")[1]) for line in found.splitlines() if ": error:" in line}) == wrong_lines(), found


def test_programs_of_users_are_clean_under_mypy_strict(tmp_path):
    pytest.importorskip("mypy")
    programs = sorted((ROOT / "examples").rglob("*.py"))
    assert len(programs) >= 27
    foreign = tmp_path / "mypy.ini"  # igl has no types, which is not ours to mend.
    foreign.write_text("[mypy]\nstrict = true\n[mypy-igl.*,torch.*]\nignore_missing_imports = true\n")
    done = run("mypy", "--config-file", foreign, "--cache-dir", tmp_path / "cache", *programs, cwd=ROOT / "examples/figures")
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_public_interface_is_typed(tmp_path):
    """Of an installed copy: an environment of its own, since pyright looks for py.typed where packages lie."""
    pytest.importorskip("pyright")
    venv.create(tmp_path / "venv")
    python = tmp_path / "venv/bin/python"
    query = "import sysconfig; print(sysconfig.get_path('purelib'))"
    packages = Path(subprocess.run([python, "-c", query], check=True, capture_output=True, text=True).stdout.strip())
    shutil.copytree(PACKAGE, packages / "easypbr", ignore=shutil.ignore_patterns("*.so*", "__pycache__", "easypbr_read_assimp"))
    (packages / "others.pth").write_text("\n".join(path for path in sys.path if path.endswith("-packages")))
    environment = {**os.environ, "VIRTUAL_ENV": str(tmp_path / "venv"), "PATH": f"{python.parent}:{os.environ['PATH']}"}
    done = subprocess.run([sys.executable, "-m", "pyright", "--verifytypes", "easypbr", "--ignoreexternal", "--outputjson"],
                          cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=600)
    if not done.stdout.startswith("{"):
        pytest.skip(f"pyright does not run here: {done.stderr or done.stdout}")
    report = json.loads(done.stdout)["typeCompleteness"]
    unknown = [symbol["name"] for symbol in report["symbols"] if symbol["isExported"] and not symbol["isTypeKnown"]]
    assert report["exportedSymbolCounts"]["withKnownType"] > 1000 and not unknown, unknown


def pyright(folder: Path, include: list[str], **settings):
    """Its complaints about files, as (file name, line from 1 on, text), and the number of files."""
    config = {"include": include, "pythonVersion": "3.11", "typeCheckingMode": "basic", "extraPaths": [str(PACKAGE.parent)],
              "reportMissingImports": "none", **settings}
    (folder / "pyrightconfig.json").write_text(json.dumps(config))
    done = run("pyright", "--outputjson", "--pythonpath", sys.executable, "--project", folder, cwd=folder)
    if done.returncode not in (0, 1):  # It needs Node.js: of the machine, or of PyPI's pyright[nodejs].
        pytest.skip(f"pyright does not run here: {done.stderr or done.stdout}")
    report = json.loads(done.stdout)
    files = report["summary"]["filesAnalyzed"]
    assert files > 0
    return [(Path(entry["file"]).name, entry["range"]["start"]["line"] + 1, entry["message"])
            for entry in report["generalDiagnostics"] if entry["severity"] == "error"], files


def test_pyright(tmp_path):
    pytest.importorskip("pyright")
    # It looks at what lies below its project alone, and not behind links to folders, as the sub-packages are when built.
    shutil.copytree(PACKAGE, tmp_path / "easypbr", ignore=shutil.ignore_patterns("*.so*", "__pycache__", "easypbr_read_assimp"))
    found, files = pyright(tmp_path, ["easypbr"])
    assert not found, "\n".join(map(str, found))
    assert files >= len(list((tmp_path / "easypbr").rglob("*.py")))
    program = tmp_path / "program"
    program.mkdir()
    (program / "program.py").write_text(PROGRAM)
    found, _ = pyright(program, ["program.py"])
    assert sorted({line for _, line, _ in found}) == wrong_lines(), found

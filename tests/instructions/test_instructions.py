"""Instructions that small pictures take, counted by Valgrind's Callgrind: the same on any machine that has AVX2.

One that takes more than a tenth more than counts.json says fails: what made it slower is found, or the new count is kept with a
reason in the commit (EASYPBR_KEEP_COUNTS=1 writes the file). One thread, the shaders of AVX2, no OpenGL, caches that are filled."""
import json
import os
import pathlib
import re
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "tests/cli"))
import shapes  # noqa: E402
from binary import BINARY  # noqa: E402
from own_environment import environment  # noqa: E402, F401

COUNTS = pathlib.Path(__file__).with_name("counts.json")
# Compilers of one kind differ by a few hundredths; what is worth a look is more.
MOST = 1.1

EFFECTS = ("--set", "bloom.enabled=true", "--set", "ssao.enabled=true", "--set", "shadows.enabled=true")
SCENES = {
    "mesh, defaults": ("sphere.obj", "--mode", "raster", "--samples", "1"),
    "mesh, effects": ("sphere.obj", "--mode", "raster", "--samples", "1", *EFFECTS),
    "mesh, half transparent": ("sphere.obj", "--mode", "raster", "--samples", "1", "--set", "material.opacity=0.5"),
    "cloud": ("cloud.xyz", "--mode", "raster", "--samples", "1"),
    "mesh, path traced": ("sphere.obj", "--mode", "path", "--samples", "2"),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("scenes")
    shapes.write_sphere(folder / "sphere.obj", 64)
    side = range(100)
    (folder / "cloud.xyz").write_text("".join(f"{x / 50 - 1} {((x * 7 + y * 3) % 11) / 50} {y / 50 - 1}\n" for x in side for y in side))
    return folder


def has_avx2():
    return "avx2" in re.findall(r"\w+", pathlib.Path("/proc/cpuinfo").read_text())


def instructions(folder, environment, arguments):
    """Of a process from its start to its end."""
    command = [str(BINARY), "render", *arguments, "-o", "out.png", "--size", "320x240"]
    plain = {**environment, "EASYPBR_THREADS": "1", "EASYPBR_ISA": "avx2", "EASYPBR_DEVICE": "cpu"}
    subprocess.run(command, cwd=folder, env=plain, check=True, timeout=120)  # fills the caches
    counted = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", *command]
    done = subprocess.run(counted, cwd=folder, env=plain, capture_output=True, text=True, timeout=590)
    assert done.returncode == 0, done.stderr
    return int(re.search(r"Collected : (\d+)", done.stderr).group(1))


@pytest.mark.skipif(not has_avx2(), reason="the counts are those of AVX2, which this processor lacks")
@pytest.mark.parametrize("scene", SCENES)
def test_a_picture_takes_no_more_instructions(scene, folder, environment):  # noqa: F811
    counts = json.loads(COUNTS.read_text()) if COUNTS.exists() else {}
    count = instructions(folder, environment, SCENES[scene])
    print(f"{scene}: {count / 1e6:.1f} million instructions")
    if os.environ.get("EASYPBR_KEEP_COUNTS"):
        COUNTS.write_text(json.dumps({**counts, scene: count}, indent=1) + "\n")
        return
    assert scene in counts, f"{COUNTS} has no count of '{scene}': EASYPBR_KEEP_COUNTS=1 writes it"
    assert count <= MOST * counts[scene], f"{scene}: {count} instructions, {count / counts[scene]:.2f} times what they were"

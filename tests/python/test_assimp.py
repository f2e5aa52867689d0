"""Files that assimp does not survive: they end its own process, and are errors here."""
import os
import pathlib
import signal
import subprocess
import sys
import time

import pytest

from easypbr import FormatError, Mesh, MeshLoader, shapes

#: A limit of a second, and what a busy machine may add; the limit on a file's time is 60 s.
SOON_S = 20

#: assimp reads its vertex 77777777: SIGSEGV.
CRASHING_ASE = """*3DSMAX_ASCIIEXPORT 200
*GEOMOBJECT {
*MESH {
*MESH_NUMVERTEX 3
*MESH_NUMFACES 1
*MESH_VERTEX_LIST {
*MESH_VERTEX 0 0 0 0
*MESH_VERTEX 1 1 0 0
*MESH_VERTEX 2 0 1 0
}
*MESH_FACE_LIST {
*MESH_FACE 0: A: 77777777 B: 1 C: 2 AB: 1 BC: 1 CA: 1 *MESH_SMOOTHING 0 *MESH_MTLID 0
}
}
}
"""

#: assimp waits at the end of the file for a name.
ENDLESS_SMD = "version 1\nnodes\n0\n"


@pytest.fixture
def crashing(tmp_path):
    path = tmp_path / "crash.ase"
    path.write_text(CRASHING_ASE)
    try:
        Mesh(path)
    except FormatError as error:
        if "crashed" not in str(error):
            pytest.skip("left out: built without the assimp reader")
    return path


def children(process: int) -> list[int]:
    tasks = pathlib.Path(f"/proc/{process}/task")
    return [int(child) for task in tasks.iterdir() for child in (task / "children").read_text().split()]


def is_running(process: int) -> bool:
    try:
        return pathlib.Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


def test_a_crash_is_an_error_with_the_file_s_name(crashing):
    with pytest.raises(FormatError, match=r"crash\.ase: the assimp reader crashed \(signal 11\)"):
        Mesh(crashing)


def test_the_loader_skips_a_file_that_crashes(crashing, tmp_path):
    good = tmp_path / "good.ply"
    shapes.sphere().save(good)
    count = len(Mesh(good).V)
    loader = MeshLoader([good, crashing, good, crashing, good], transform=lambda mesh: len(mesh.V), on_error="skip")
    assert list(loader) == [count] * 3


def test_the_reader_does_not_outlive_its_parent(crashing, tmp_path):
    path = tmp_path / "endless.smd"
    path.write_text(ENDLESS_SMD)
    parent = subprocess.Popen([sys.executable, "-c", f"import easypbr; easypbr.Mesh({str(path)!r})"], env=os.environ)
    end = time.monotonic() + SOON_S
    readers: list[int] = []
    while not readers and time.monotonic() < end:
        time.sleep(0.2)
        readers = children(parent.pid)
    parent.send_signal(signal.SIGKILL)
    parent.wait()
    assert readers
    while any(map(is_running, readers)) and time.monotonic() < end:
        time.sleep(0.05)
    assert not any(map(is_running, readers))

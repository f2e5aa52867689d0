"""Whole programs, as users start them."""

import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import easypbr
from easypbr import shapes

FIVE_LINES = """\
from easypbr import *
view  = Viewer()
view.load_environment_map("./map.hdr")
drone = Mesh("./drone.ply")
Scene.show(drone, "drone")
view.recorder.record("img.png")
"""


def run(arguments, folder, **variables):
    environment = {**os.environ, **variables}
    return subprocess.run(
        [sys.executable, *arguments], cwd=folder, env=environment, capture_output=True, text=True, timeout=300
    )


def test_the_program_of_the_readme(tmp_path):
    shapes.sphere(1, 16).save(tmp_path / "drone.ply")
    easypbr.save_image(np.full((8, 16, 3), 0.7, dtype=np.float32), tmp_path / "map.hdr")
    (tmp_path / "program.py").write_text(FIVE_LINES)
    result = run(["program.py"], tmp_path)
    assert result.returncode == 0, result.stderr
    assert result.stdout == "" and result.stderr == ""
    picture = easypbr.load_image(tmp_path / "img.png")
    assert picture.shape == (600, 800, 4) and picture.dtype == np.uint8
    # The sphere is in the middle, the background in the corner.
    assert not np.array_equal(picture[300, 400], picture[0, 0])


def test_import_touches_no_gl(tmp_path):
    code = (
        "import easypbr\n"
        "maps = open('/proc/self/maps').read()\n"
        "found = [name for name in ('libEGL', 'libGL.', 'libGLX', 'libOpenGL') if name in maps]\n"
        "assert not found, found\n"
        "easypbr.Viewer(); easypbr.Mesh()\n"
        "maps = open('/proc/self/maps').read()\n"
        "assert 'libEGL' not in maps\n"
    )
    result = run(["-c", code], tmp_path)
    assert result.returncode == 0, result.stderr


def test_star_import_hides_no_builtin():
    import builtins

    hidden = set(easypbr.__all__) & set(dir(builtins))
    assert not hidden


def test_command_line(tmp_path):
    result = run(["-m", "easypbr", "info", "none.ply"], tmp_path)
    assert result.returncode == 1
    assert "none.ply" in result.stderr and result.stdout == ""
    assert len(result.stderr.splitlines()) == 1
    assert run(["-m", "easypbr", "rendr"], tmp_path).returncode == 2


def test_command_line_picture_equals_the_one_from_python(tmp_path):
    mesh = shapes.sphere(1, 16)
    mesh.save(tmp_path / "sphere.ply")
    arguments = ["render", "sphere.ply", "-o", "a.png", "--size", "64x48", "--samples", "4", "--quiet"]
    result = run(["-m", "easypbr", *arguments], tmp_path)
    assert result.returncode == 0, result.stderr
    picture = easypbr.render(tmp_path / "sphere.ply", size=(64, 48), samples=4)
    np.testing.assert_array_equal(easypbr.load_image(tmp_path / "a.png"), picture)


def test_warnings_reach_logging(tmp_path, caplog):
    (tmp_path / "a.obj").write_text("mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    with caplog.at_level("WARNING", logger="easypbr"):
        easypbr.Mesh(tmp_path / "a.obj")
    assert any(r.name == "easypbr" and "none.mtl" in r.getMessage() for r in caplog.records)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork on this system")
def test_a_fork_is_told_to_spawn(tmp_path):
    code = (
        "import os, easypbr\n"
        "view = easypbr.Viewer()\n"
        "child = os.fork()\n"
        "if child == 0:\n"
        "    try: view.render()\n"
        "    except easypbr.ContextError as error: os._exit(7 if 'spawn' in str(error) else 1)\n"
        "    os._exit(2)\n"
        "assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7\n"
    )
    result = run(["-c", code], tmp_path)
    assert result.returncode == 0, result.stderr


#: Threads are behind all of these: a recording's, the cluster maker's, the server's, the files' readers.
WITH_THREADS = """
import gc, os, signal, sys, time
import easypbr
from easypbr import MeshLoader, Scene, Viewer, shapes

scene = Scene()
scene.show(shapes.icosphere(1, 7), "large")
view = Viewer((64, 48), scene=scene)
for _ in range(2):
    view.render(samples=1)
view.recorder.start("frame_%03d.png")
view.recorder.add_frame()
server = view.serve()
shapes.box().save("box.ply")
meshes = iter(MeshLoader(["box.ply"] * 20, transform=lambda mesh: mesh.F.shape))
next(meshes)
time.sleep(0.5)
sys.stdout.flush()
child = os.fork()
if child == 0:
    signal.alarm(20)
    if sys.argv[1] == "drop":
        server.close()
        del view, server, meshes
        gc.collect()
    elif sys.argv[1] == "use":
        try:
            next(meshes)
            os._exit(3)
        except easypbr.Error as error:
            assert "anew" in str(error), error
    sys.exit(0)
assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
assert next(meshes) == (12, 3) and len(server.clients) == 0 and server.is_open
view.recorder.add_frame()
view.recorder.stop()
assert os.path.exists("frame_001.png")
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork on this system")
@pytest.mark.parametrize("child", ["end", "drop", "use"])
def test_a_forked_child_ends_beside_its_parent_s_threads(tmp_path, child):
    result = run(["-c", WITH_THREADS, child], tmp_path)
    assert result.returncode == 0, result.stderr
    assert result.stderr == ""


@pytest.mark.parametrize("warnings", ["", "0", "1"])
def test_objects_that_outlive_the_interpreter_are_told_only_when_asked_for(tmp_path, warnings):
    # As a class that torch keeps: one more reference than there are owners.
    code = "import ctypes, easypbr; box = easypbr.shapes.box(); ctypes.pythonapi.Py_IncRef(ctypes.py_object(box))"
    result = run(["-c", code], tmp_path, EASYPBR_LEAK_WARNINGS=warnings)
    assert result.returncode == 0, result.stderr
    assert ("leaked" in result.stderr) == (warnings == "1") and (result.stderr == "") == (warnings != "1")


def test_the_command_line_can_be_interrupted(tmp_path):
    shapes.sphere(1, 16).save(tmp_path / "sphere.ply")
    # In software such a picture takes minutes.
    arguments = ["render", "sphere.ply", "-o", "a.png", "--size", "4000x4000", "--samples", "1024", "--quiet"]
    process = subprocess.Popen([sys.executable, "-m", "easypbr", *arguments], cwd=tmp_path)
    try:
        time.sleep(1.5)
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=5) == -signal.SIGINT
    finally:
        process.kill()
    assert not (tmp_path / "a.png").exists()


@pytest.mark.parametrize("before, after", [("SIG_IGN", "SIG_IGN"), ("default_int_handler", "SIG_DFL")])
def test_the_command_line_ignores_ctrl_c_where_it_was_ignored(tmp_path, before, after):
    """In the background of a script."""
    code = f"import signal, easypbr.__main__; signal.signal(signal.SIGINT, signal.{before}); assert easypbr.__main__.main() == 0; "
    result = run(["-c", code + f"assert signal.getsignal(signal.SIGINT) is signal.{after}", "--version"], tmp_path)
    assert result.returncode == 0, result.stderr


def test_one_of_a_list_is_taken_in_any_case():
    square = ([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    lines = easypbr.as_mesh({"V": square[0], "E": "LOOP"})
    assert len(lines.E) == 4
    np.testing.assert_array_equal(lines.to_tubes(0.1, ends="FLAT").V, lines.to_tubes(0.1, ends="flat").V)
    images = [easypbr.render(square, size=(32, 24), mode=mode, samples=1) for mode in ("raster", "RASTER")]
    np.testing.assert_array_equal(*images)
    material = easypbr.Material()
    material.alpha_mode = "Blend"
    assert material.alpha_mode == "blend"
    camera = easypbr.Camera()
    camera.projection = "Orthographic"
    assert camera.projection == "orthographic"
    assert easypbr.MeshLoader([], on_error="SKIP").on_error == "skip"
    with pytest.raises(easypbr.ArgumentError, match="mode: expected 'raster' or 'path', got 'RASTERS'"):
        easypbr.render(square, mode="RASTERS")
    with pytest.raises(easypbr.ArgumentError, match="mode: expected 'raster' or 'path', got 3"):
        easypbr.render(square, mode=3)

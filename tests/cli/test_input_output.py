"""Standard input as a mesh, standard output that is full, and what is no regular file."""
import json
import os
import subprocess

import numpy as np
import pytest

import png
import shapes
from binary import BINARY


@pytest.fixture
def piped(environment, tmp_path):
    """Runs the command line with bytes as its standard input; returns the finished process."""

    def run(*arguments, data, code=0):
        command = [str(BINARY), *map(str, arguments)]
        done = subprocess.run(command, input=data, capture_output=True, env=environment, cwd=tmp_path, timeout=300)
        assert done.returncode == code, f"{command}\n{done.stderr!r}"
        return done

    return run


@pytest.mark.parametrize("extension", ["ply", "obj", "glb"])
def test_a_mesh_from_standard_input_gives_the_same_picture(easypbr, render, piped, box, tmp_path, extension):
    easypbr("convert", box, f"box.{extension}")
    render(f"box.{extension}", "-o", "file.png")
    data = (tmp_path / f"box.{extension}").read_bytes()
    piped("render", "-", "-o", "piped.png", "--size", "64x48", "--samples", "1", data=data)
    assert np.array_equal(png.read(tmp_path / "piped.png"), png.read(tmp_path / "file.png"))


def test_other_commands_read_standard_input(piped, box, tmp_path):
    data = box.read_bytes()
    assert json.loads(piped("info", "-", "--json", data=data).stdout)["faces"] == 12
    piped("convert", "-", "out.ply", data=data)
    assert (tmp_path / "out.ply").read_bytes().startswith(b"ply")


def test_a_format_that_cannot_be_told_is_named(piped):
    points = np.arange(8, dtype="<f4").tobytes()
    error = piped("info", "-", data=points, code=1).stderr.decode()
    assert "standard input: its format cannot be told" in error and "--format" in error
    assert json.loads(piped("info", "-", "--json", "--format", "bin", data=points).stdout)["vertices"] == 2
    assert "did you mean 'ply'" in piped("info", "-", "--format", "plyy", data=points, code=1).stderr.decode()
    assert "standard input: there is nothing to read" in piped("info", "-", data=b"", code=1).stderr.decode()


def test_standard_input_is_read_once(piped, box):
    assert b"once" in piped("render", "-", "-", "-o", "a.png", data=box.read_bytes(), code=2).stderr


def test_a_file_may_have_another_format_than_its_extension(easypbr, box, tmp_path):
    (tmp_path / "box.dat").write_bytes(box.read_bytes())
    assert "box.dat" in easypbr("info", "box.dat", code=1).stderr
    assert "faces       12\n" in easypbr("info", "box.dat", "--format", "obj").stdout


@pytest.mark.parametrize("arguments", [("info", "{box}"), ("info", "--json", "{box}"), ("doctor",), ("--help",),
                                       ("--version",), ("render", "--help"), ("compare", "a.png", "a.png")])
def test_full_standard_output_is_an_error(easypbr, environment, box, tmp_path, arguments):
    if "compare" in arguments:
        easypbr("render", box, "-o", "a.png", "--size", "16x16", "--samples", "1")
    command = [str(BINARY), *(a.format(box=box) for a in arguments)]
    with open("/dev/full", "w") as full:
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, env=environment, cwd=tmp_path)
    assert done.returncode == 1
    assert "easypbr: error: cannot write" in done.stderr and "No space left" in done.stderr


@pytest.mark.parametrize("option", ["--env", "--settings", "--camera-path", "--label-map", "--shader", "--pass",
                                    "--camera-pose", "--background"])
def test_a_pipe_is_no_file(render, box, tmp_path, option):
    # Extensions that the options take; a pipe without a writer would block whoever opens it as a file.
    pipe = tmp_path / ("pipe.png" if option == "--background" else "pipe.exr" if option == "--env" else "pipe.json")
    os.mkfifo(pipe)
    output = "out_%02d.png" if option == "--camera-path" else "out.png"
    error = render(box, "-o", output, option, pipe, code=1).stderr
    assert f"cannot read {pipe}: it is a pipe, not a regular file" in error
    assert "it is a pipe" in render(pipe, "-o", "out.png", code=1).stderr


def write_zeros(path, rows):
    """A glTF file of points on an accessor without data: 12 bytes each that nothing in the file bears out."""
    path.write_text(json.dumps({
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"mode": 0, "attributes": {"POSITION": 0}}]}],
        "accessors": [{"count": rows, "componentType": 5126, "type": "VEC3"}]}))
    return path


@pytest.mark.parametrize("command, limit", [(["render", "-o", "a.png"], ["--set", "limits.memory=0.01"]),
                                            (["convert"], ["a.ply", "--memory", "0.01"])])
def test_a_file_that_asks_for_too_much_memory(easypbr, tmp_path, command, limit):
    path = write_zeros(tmp_path / "zeros.gltf", 1_000_000)
    failed = easypbr(command[0], path, *command[1:], *limit, code=1)
    assert "zeros.gltf: accessors[0] would take 12 MB, and of the 10 MB that reading may take 10 MB are left" in failed.stderr
    assert not list(tmp_path.glob("a.*"))


def run_with_errors(environment, folder, arguments, *, closed):
    """The exit code of a command whose standard error is full, or closed."""
    command = [str(BINARY), *map(str, arguments)]
    if closed:
        return subprocess.run(command, env=environment, cwd=folder, timeout=300, preexec_fn=lambda: os.close(2)).returncode
    with open("/dev/full", "w") as full:
        return subprocess.run(command, stderr=full, env=environment, cwd=folder, timeout=300).returncode


@pytest.mark.parametrize("closed", [False, True])
def test_errors_that_cannot_be_written_change_no_exit_code(environment, box, tmp_path, closed):
    (tmp_path / "warn.obj").write_text("mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n")
    small = ("--size", "32x24", "--samples", "1")
    expected = [(("render", "warn.obj", "-o", "warned.png", *small), 0), (("render", box, "-o", "timed.png", "--timing", *small), 0),
                (("nonsense",), 2), (("info", "missing.ply"), 1)]
    for arguments, code in expected:
        assert run_with_errors(environment, tmp_path, arguments, closed=closed) == code, arguments
    assert png.read(tmp_path / "warned.png").shape == png.read(tmp_path / "timed.png").shape == (24, 32, 4)


def test_no_file_takes_the_place_of_a_closed_stream(environment, box, tmp_path):
    """Else the first file that is opened would get what is printed."""
    def close_all():
        for stream in (0, 1, 2):
            os.close(stream)

    command = [str(BINARY), "convert", str(box), "out.ply"]
    assert subprocess.run(command, env=environment, cwd=tmp_path, timeout=300, preexec_fn=close_all).returncode == 0
    assert (tmp_path / "out.ply").read_bytes().startswith(b"ply\n")
    # Results that cannot be written stay an error.
    done = subprocess.run([str(BINARY), "info", str(box)], env=environment, timeout=300, preexec_fn=lambda: os.close(1),
                          stderr=subprocess.PIPE, text=True)
    assert done.returncode == 1 and done.stderr.startswith("easypbr: error: ")


@pytest.mark.parametrize("command", ["render", "convert"])
def test_names_that_the_file_system_does_not_take(easypbr, box, tmp_path, command):
    """A file's name has 255 bytes at most, on all file systems of Linux that hold the tests. The messages are strerror()'s."""
    output = ["-o"] if command == "render" else []
    extension = ".png" if command == "render" else ".ply"
    long, loop = "a" * 252 + extension, "loop" + extension
    (tmp_path / loop).symlink_to(loop)
    for name, reason in ((long, "File name too long"), (loop, "Too many levels of symbolic links")):
        for path in (name, f"{name}/in{extension}"):
            done = easypbr(command, box, *output, path, code=1)
            assert f"easypbr: error: cannot write {path}: {reason}" in done.stderr


def test_an_unknown_command_of_a_long_name(easypbr):
    assert "easypbr: error: unknown command 'aaa" in easypbr("a" * 256, code=2).stderr

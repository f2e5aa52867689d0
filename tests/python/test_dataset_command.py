"""easypbr dataset: what the command takes, says and returns."""
import contextlib
import os
import pty
import shlex
import subprocess
import sys
import threading

import pytest

import easypbr.dataset.__main__


def test_command_line(tmp_path):
    command = [sys.executable, "-m", "easypbr", "dataset"]
    done = subprocess.run([*command, "--demo", "-o", "out", "--count", "1", "--writers", "yolo", "--workers", "1"],
                          cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stderr == "" and "1 pictures with" in done.stdout  # Progress is for terminals.
    assert (tmp_path / "out/images/000000.png").exists() and (tmp_path / "out/contact_sheet.png").exists()
    assert subprocess.run([*command, "nothing.toml", "-o", "x"], cwd=tmp_path, capture_output=True).returncode == 1
    assert subprocess.run([*command, "-o", "x"], cwd=tmp_path, capture_output=True).returncode == 2


@pytest.mark.parametrize("arguments, code, message", [
    ("--demo -o out --count abc", 2, "dataset: --count: expected a whole number, got 'abc'"),
    ("--demo -o out --count 0", 2, "dataset: count: expected 1 to 1000000, got 0"),
    ("--demo -o out --workers 0", 2, "dataset: workers: expected 1 or more, got 0"),
    ("--demo -o out --writers foo", 2, "dataset: writers (foo): expected coco"),
    ("--demo -o out --writers ''", 2, "dataset: writers (): expected coco"),
    ("--demo -o out --engine foo", 2, "dataset: --engine: expected local or ray, got 'foo'"),
    ("--demo", 2, "dataset: expected -o FOLDER"),
    ("-o out", 2, "dataset: expected a SPEC or --demo"),
    ("nothing.toml -o out", 1, "cannot read nothing.toml"),
    ("wrong.toml -o out", 1, "wrong.toml: there is no 'cuont' (did you mean 'count'?)"),
])  # fmt: skip
def test_command_line_errors_are_one_line(tmp_path, arguments, code, message):
    (tmp_path / "wrong.toml").write_text("cuont = 3\n")
    command = [sys.executable, "-m", "easypbr", "dataset", *shlex.split(arguments)]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    (line,) = done.stderr.splitlines()
    assert done.returncode == code and line.startswith(f"easypbr: error: {message}"), line
    assert [path.name for path in tmp_path.iterdir()] == ["wrong.toml"] and done.stdout == ""


def refused_thread(_):
    raise RuntimeError("can't start new thread")


def out_of_memory(*_, **__):
    raise MemoryError


@pytest.mark.parametrize("owner, name, what, message", [
    (easypbr.dataset.__main__, "generate", out_of_memory, "out of memory: try fewer workers or a smaller image"),
    (threading.Thread, "start", refused_thread, "dataset: cannot start a thread (see the limits of processes: ulimit -u"),
])  # fmt: skip
def test_what_the_system_has_not_is_one_line(tmp_path, monkeypatch, capsys, owner, name, what, message):
    monkeypatch.setattr(owner, name, what)
    arguments = ["--demo", "-o", str(tmp_path / "out"), "--count", "1", "--writers", "yolo", "--workers", "1"]
    assert easypbr.dataset.__main__.main(arguments) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"easypbr: error: {message}")


def said_on_a_terminal(command, folder):
    master, terminal = pty.openpty()
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=terminal)
    os.close(terminal)
    said = b""
    with contextlib.suppress(OSError):  # Linux reports the end of a terminal as an error.
        while piece := os.read(master, 4096):
            said += piece
    os.close(master)
    assert process.wait(timeout=60) == 0, said
    return said.decode()


def test_progress_is_for_terminals(tmp_path):
    command = [sys.executable, "-m", "easypbr", "dataset", "--demo", "--count", "1", "--writers", "yolo", "--workers", "1"]
    assert "1/1" in said_on_a_terminal([*command, "-o", "shown"], tmp_path)
    assert said_on_a_terminal([*command, "-o", "quiet", "--quiet"], tmp_path) == ""


def test_a_full_standard_output_is_named(tmp_path):
    options = "--demo -o out --count 1 --writers yolo --workers 1"
    command = [sys.executable, "-m", "easypbr", "dataset", *options.split()]
    with open("/dev/full", "w") as full:
        done = subprocess.run(command, cwd=tmp_path, stdout=full, stderr=subprocess.PIPE, text=True)
    expected = "easypbr: error: cannot write to standard output: No space left on device\n"
    assert (done.returncode, done.stderr) == (1, expected)


def test_quiet_command_line_prints_nothing(tmp_path):
    """Of a spec that begins with a byte order mark, and whose name with a dash."""
    (tmp_path / "-spec.toml").write_text('\ufeff[[objects]]\nsource = "builtin:drone"\nclass = "drone"\n', encoding="utf-8")
    options = "-o out --count 1 --workers 1 --writers yolo --quiet -- -spec.toml"
    command = [sys.executable, "-m", "easypbr", "dataset", *options.split()]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert (tmp_path / "out/images/000000.png").exists()

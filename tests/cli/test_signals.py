"""What signals do to a command that runs until it is told to end."""
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time

import pytest

from binary import BINARY

ENDS = (signal.SIGHUP, signal.SIGINT, signal.SIGTERM)


def ignored(pid):
    """The set of signals, the lowest bit is number 1."""
    status = pathlib.Path(f"/proc/{pid}/status").read_text()
    return int(re.search(r"^SigIgn:\s*(\w+)$", status, re.MULTILINE)[1], 16)


@pytest.mark.parametrize("number", ENDS)
def test_a_server_ignores_what_was_ignored_at_its_start(environment, box, tmp_path, number):
    """As nohup does with SIGHUP, and a script with SIGINT in its background."""

    def before():
        for each in ENDS:
            signal.signal(each, signal.SIG_IGN if each == number else signal.SIG_DFL)

    with subprocess.Popen([BINARY, "serve", box], stdout=subprocess.PIPE, text=True, env=environment, cwd=tmp_path,
                          preexec_fn=before) as served:
        try:
            assert any("Ctrl-C ends" in line for line in served.stdout)  # Its handlers are in place.
            assert [bool(ignored(served.pid) >> each - 1 & 1) for each in ENDS] == [each == number for each in ENDS]
            served.send_signal(next(each for each in ENDS if each != number))
            assert served.wait(timeout=20) == 0
        finally:
            served.kill()


def interrupted(environment, folder, delay=None, **variables):
    """How a data set of many frames ends: its exit code and errors. Ctrl-C after a delay, if one is given."""

    def before():
        signal.signal(signal.SIGINT, signal.SIG_DFL)

    command = [BINARY, "dataset", "--demo", "-o", "out", "--count", "2000", "--workers", "1", "--writers", "yolo", "--quiet"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env={**environment, **variables}, cwd=folder,
                          preexec_fn=before) as process:
        try:
            if delay is not None:
                time.sleep(delay)
                process.send_signal(signal.SIGINT)
            error = process.communicate(timeout=60)[1]
        finally:
            process.kill()
    return process.returncode, error


INTERRUPTED = (130, "easypbr: interrupted: started again it goes on\n")


@pytest.mark.parametrize("delay", [0, 0.03, 0.06, 0.1, 0.15, 0.2, 0.3, 0.5])
def test_ctrl_c_ends_a_data_set_without_a_traceback(environment, tmp_path, delay):
    """Whatever has started by then; the command itself, before it hands over to Python, ends as the system has it."""
    assert interrupted(environment, tmp_path, delay) in (INTERRUPTED, (-signal.SIGINT, ""))


def test_ctrl_c_while_python_starts_is_not_lost(environment, tmp_path):
    """Sent before Python runs."""
    python = tmp_path / "python"
    own = environment.get("EASYPBR_PYTHON") or sys.executable
    python.write_text(f'#!/bin/sh\nkill -INT $$\nexec {shutil.which(own)} "$@"\n')
    python.chmod(0o755)
    assert interrupted(environment, tmp_path, EASYPBR_PYTHON=str(python)) == INTERRUPTED


def test_ctrl_c_while_modules_are_imported_is_no_error_of_theirs(environment, tmp_path):
    """Sent by a module in numpy's place."""
    modules = tmp_path / "modules"
    modules.mkdir()
    (modules / "numpy.py").write_text("import os, signal, time\nos.kill(os.getpid(), signal.SIGINT)\ntime.sleep(60)\n")
    path = ":".join(filter(None, (str(modules), environment.get("PYTHONPATH"))))
    assert interrupted(environment, tmp_path, PYTHONPATH=path) == INTERRUPTED

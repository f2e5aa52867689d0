"""What signals do to a command that runs until it is told to end."""
import pathlib
import re
import signal
import subprocess

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

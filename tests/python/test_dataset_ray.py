"""Data sets made by tasks of Ray: the same bytes, whoever dies; no network is needed; errors say what is missing."""

import os
import pathlib
import shutil
import signal
import subprocess
import sys
import threading
import time

import pytest
from test_dataset import hashes, small

import easypbr
from easypbr import ArgumentError, ContextError
from easypbr.dataset import generate


def descendants(pid: int) -> dict[int, str]:
    """Processes that this one has started, directly or not, by their command lines."""
    parents, lines = {}, {}
    for folder in pathlib.Path("/proc").iterdir():
        if folder.name.isdigit():
            try:
                parents[int(folder.name)] = int((folder / "stat").read_text().rpartition(")")[2].split()[1])
                lines[int(folder.name)] = (folder / "cmdline").read_text()
            except OSError:
                continue  # It has ended meanwhile.
    found = {pid}
    while more := {child for child, parent in parents.items() if parent in found} - found:
        found |= more
    return {child: lines[child] for child in found - {pid}}


def test_a_worker_that_dies_changes_nothing(tmp_path):
    spec = small(count=12)
    generate(spec, tmp_path / "local", workers=1)
    killed = []

    def kill_one():
        """A worker in the middle of its work: some frames are there, most are not."""
        while not killed and not (tmp_path / "ray/annotations.json").exists():
            busy = [pid for pid, line in descendants(os.getpid()).items() if line.startswith("ray::make_range")]
            if busy and len(list((tmp_path / "ray/records").glob("*.json"))) >= 2:
                os.kill(busy[0], signal.SIGKILL)
                killed.append(busy[0])
            time.sleep(0.005)

    killer = threading.Thread(target=kill_one, daemon=True)
    killer.start()
    statistics = generate(spec, tmp_path / "ray", workers=2, engine="ray")
    killer.join()
    assert killed, "all frames were made before a worker could be killed"
    assert statistics["images"] == 12
    assert hashes(tmp_path / "ray") == hashes(tmp_path / "local")


def test_the_command_needs_no_network(tmp_path):
    """In a network of its own there is no machine but this one, so nothing can be sent anywhere either."""
    alone = [shutil.which("unshare") or "unshare", "-rn", "sh", "-c", 'ip link set lo up && exec "$@"', "sh"]
    if not shutil.which("ip") or subprocess.run([*alone, "true"], capture_output=True).returncode != 0:
        pytest.skip("this machine gives no process a network of its own (unshare -rn, ip)")
    command = [*alone, sys.executable, "-m", "easypbr", "dataset", "--demo", "-o", "out", "--count", "2", "--engine", "ray",
               "--workers", "1", "--writers", "yolo"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert "2 pictures with" in done.stdout
    assert len(list((tmp_path / "out/images").iterdir())) == 2


def test_errors_of_a_task_are_those_of_the_library(tmp_path):
    (tmp_path / "broken.ply").write_text("ply\nnonsense")
    spec = small()
    spec.objects[0].source = str(tmp_path / "broken.ply")
    with pytest.raises(easypbr.FormatError, match="broken.ply"):
        generate(spec, tmp_path / "out", workers=1, engine="ray")


def test_without_ray_the_extra_is_named(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "ray", None)  # as if it were not installed
    with pytest.raises(ImportError, match=r"easypbr\[ray\]"):
        generate(small(), tmp_path / "out", engine="ray")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("options, message", [
    ({"engine": "slurm"}, "local or ray.*'slurm'"),
    ({"address": "auto"}, "engine ray"),
    ({"engine": "ray", "address": "auto", "workers": 2}, "workers.*cluster"),
    ({"threads": 0}, "threads: expected 1 or more"),
])
def test_options_that_contradict_each_other(tmp_path, options, message):
    with pytest.raises(ArgumentError, match=message):
        generate(small(), tmp_path / "out", **options)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("address", ["auto", "127.0.0.1:1"])
def test_no_cluster_at_the_address(tmp_path, address):
    with pytest.raises(ContextError, match=f"no cluster.*'{address}'"):
        generate(small(), tmp_path / "out", engine="ray", address=address)

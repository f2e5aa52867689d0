"""What only shows after long: kills at random moments lose nothing, memory stays flat. `make check-long` runs these.

EASYPBR_LONG_KILLS (1000) and EASYPBR_LONG_FRAMES (5000) say how much."""

import hashlib
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time

from easypbr.dataset import DatasetSpec, ImageSpec
from easypbr.dataset.folder import FolderWriter, keep_memory
from easypbr.dataset.frames import FrameMaker

KILLS = int(os.environ.get("EASYPBR_LONG_KILLS", "1000"))
FRAMES = int(os.environ.get("EASYPBR_LONG_FRAMES", "5000"))

SPEC = """
count = 60
writers = ["coco", "yolo", "kitti", "bop", "webdataset", "raw", "png"]
[image]
size = [96, 72]
samples = 1
[camera]
elevation_deg = 0
[background]
skies = 1
[[objects]]
count = [1, 3]
"""


def hashes(folder: pathlib.Path) -> dict[str, str]:
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in folder.rglob("*") if path.is_file()}


def test_kills_at_random_moments_lose_nothing(tmp_path):
    (tmp_path / "spec.toml").write_text(SPEC)

    def job(folder):
        command = [sys.executable, "-m", "easypbr", "dataset", "spec.toml", "-o", folder, "--workers", "2", "--quiet"]
        return subprocess.Popen(command, cwd=tmp_path, start_new_session=True, stdout=subprocess.DEVNULL)

    start = time.monotonic()
    assert job("undisturbed").wait() == 0
    # Until when a job may be killed: from before its first frame to after its last.
    longest = time.monotonic() - start
    wanted = hashes(tmp_path / "undisturbed")
    number = random.Random(0)
    kills = finished = 0
    folder = tmp_path / "killed"
    while kills < KILLS:
        process = job("killed")
        try:
            process.wait(number.uniform(0, longest))
        except subprocess.TimeoutExpired:
            kills += 1
            # All at once as when a machine is switched off, or the one that was started alone: its workers end with it.
            if number.random() < 0.5:
                os.killpg(process.pid, signal.SIGKILL)
            else:
                process.kill()
            process.wait()
        for name, digest in hashes(folder).items() if folder.exists() else ():
            # Whatever is seen is whole: the bytes of the undisturbed run. A lock ends with its process, its file stays.
            assert name.startswith("unfinished/") or name == "generating.lock" or digest == wanted[name], name
        for record in folder.glob("records/*.json"):
            assert (folder / f"images/{json.loads(record.read_text())['index']:06d}.png").exists()
        if process.returncode == 0:
            finished += 1
            assert hashes(folder) == wanted
            shutil.rmtree(folder)
    assert job("killed").wait() == 0
    assert hashes(folder) == wanted
    print(f"{kills} kills, {finished + 1} sets of the same bytes")


def resident_megabytes() -> float:
    pages = int(pathlib.Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def test_memory_stays_flat(tmp_path):
    spec = DatasetSpec.demo()
    spec.count, spec.image = FRAMES, ImageSpec((160, 120), 1)
    spec.writers = ("coco", "bop", "raw")
    maker = FrameMaker(spec)
    writer = FolderWriter(spec, tmp_path, maker.classes)
    keep_memory()
    warm = max(50, FRAMES // 10)  # all skies, all variants of shaders
    most = 0.0
    for index in range(FRAMES):
        writer.write_frame(maker.make(index))
        if index == warm:
            first = resident_megabytes()
        if index > warm:
            most = max(most, resident_megabytes())
        if index % 100 == 99:
            shutil.rmtree(tmp_path)
            tmp_path.mkdir()
    print(f"{FRAMES} frames: {first:.0f} MB after {warm}, at most {most:.0f} MB since")
    assert most - first < 30

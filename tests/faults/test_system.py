"""Programs whose disk fills up, whose memory ends, whose workers are killed: an exit status with a message, nothing half-written.

EASYPBR_FAULTS, by default 4, says how many sizes of disks each command is tried with.
"""

import hashlib
import os
import resource
import signal
import subprocess
import sys
import time

import pytest

import easypbr as package

SIZES = {"all": 40}.get(os.environ.get("EASYPBR_FAULTS", ""), 0) or int(os.environ.get("EASYPBR_FAULTS", "4"))
SMALL = ("--size", "48x32", "--samples", "1")


def contents(folder) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def limited(kind, most):
    """A function that limits what a process may take."""
    return lambda: resource.setrlimit(kind, (most, most))


def explained(done) -> bool:
    """Whether a program that failed ended by itself, and said why in lines of its own."""
    return done.returncode == 1 and done.stderr.startswith("easypbr: ") and "Traceback" not in done.stderr


WRITING = {
    "png": ("render", "{box}", "-o", "out.png", *SMALL),
    "exr": ("render", "{box}", "-o", "out.exr", *SMALL),
    "jpg": ("render", "{box}", "-o", "out.jpg", *SMALL),
    "settings": ("render", "{box}", "-o", "out.png", "--save-settings", "out.json", *SMALL),
    "video": ("render", "{box}", "-o", "out.mp4", "--turntable", "4", *SMALL),
    "gif": ("render", "{box}", "-o", "out.gif", "--turntable", "4", *SMALL),
    "ply": ("convert", "{box}", "out.ply"),
    "obj": ("convert", "{box}", "out.obj"),
    "glb": ("convert", "{box}", "out.glb"),
    "npz": ("convert", "{box}", "out.npz"),
    "thumbnail": ("thumbnail", "{box}", "-o", "out.png"),
    "demo": ("demo", "-o", "out.png", *SMALL),
}


@pytest.mark.parametrize("name", WRITING)
def test_a_disk_that_fills_up(easypbr, box, tmp_path, name):
    arguments = [word.format(box=box) for word in WRITING[name]]
    done = easypbr(*arguments)
    assert done.returncode == 0, done.stderr
    wanted = contents(tmp_path)
    largest = max(map(len, wanted.values()))
    for path in wanted:
        (tmp_path / path).write_bytes(b"old")
    for step in range(SIZES):
        done = easypbr(*arguments, before=limited(resource.RLIMIT_FSIZE, step * (largest - 1) // max(SIZES - 1, 1)))
        assert explained(done), (step, done)
        assert "out." in done.stderr
        found = contents(tmp_path)
        assert found.keys() <= wanted.keys(), "something is left behind"
        # Each is what it was or what it was to become; of a video what was encoded so far is whole as well.
        for path, data in found.items():
            assert data == b"old" or data == wanted[path] or name in ("video", "gif"), path


def test_a_disk_that_fills_up_under_a_data_set(tmp_path):
    (tmp_path / "spec.toml").write_text("count = 6\nwriters = ['coco', 'yolo', 'bop', 'raw']\n[image]\nsize = [48, 32]\nsamples = 1\n"
                                        "[background]\nskies = 1\n[[objects]]\nsource = 'builtin:drone'\nclass = 'drone'\n")

    def generate(most=None):
        command = [sys.executable, "-P", "-m", "easypbr", "dataset", "spec.toml", "-o", "set", "--quiet", "--workers", "1"]
        return subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=300, restore_signals=False,
                              preexec_fn=limited(resource.RLIMIT_FSIZE, most) if most is not None else None)

    assert generate().returncode == 0
    wanted = contents(tmp_path / "set")
    (tmp_path / "set").rename(tmp_path / "whole")
    for most in (100, 600, 3000)[:SIZES]:
        done = generate(most)
        assert done.returncode != 0 and "Traceback" not in done.stderr, done.stderr
        assert "File too large" in done.stderr or "cannot write" in done.stderr, done.stderr
        for path, data in contents(tmp_path / "set").items():
            assert path.startswith("unfinished") or path.endswith(".lock") or data == wanted[path], path
    done = generate()
    assert done.returncode == 0, done.stderr
    assert contents(tmp_path / "set") == wanted


@pytest.mark.parametrize("arguments", [("info", "{mesh}"), ("convert", "{mesh}", "out.ply"),
                                       ("render", "{mesh}", "-o", "out.png", *SMALL)])
def test_memory_that_ends(easypbr, tmp_path, arguments):
    """A cloud of 100 MB where the program may have little beyond what it begins with."""
    cloud = tmp_path / "cloud.ply"
    count = 8_000_000
    with open(cloud, "wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {count}\n".encode()
                   + b"property float x\nproperty float y\nproperty float z\nend_header\n")
        file.write(b"\0\0\x80?" * (3 * count))
    begins = next(most for most in range(50_000_000, 2_000_000_000, 10_000_000)
                  if easypbr("--version", before=limited(resource.RLIMIT_AS, most)).returncode == 0)
    failures = 0
    for step in range(SIZES):
        most = begins + 5_000_000 + step * 240_000_000 // SIZES
        done = easypbr(*(word.format(mesh=cloud) for word in arguments), before=limited(resource.RLIMIT_AS, most),
                       EASYPBR_THREADS="1")
        assert done.returncode == 0 or explained(done), (most, done)
        failures += done.returncode
    assert failures > 0, "the memory was enough each time"
    cloud.unlink()


def test_a_cache_full_of_pipes(easypbr, box, environment, tmp_path):
    """Whatever lies in place of the cache's entries, pictures are drawn."""
    cache = tmp_path / "cache"
    arguments = ("render", box, "-o", "out.png", *SMALL)
    assert easypbr(*arguments, EASYPBR_CACHE_DIR=str(cache)).returncode == 0
    wanted = (tmp_path / "out.png").read_bytes()
    entries = [path for path in cache.rglob("*") if path.is_file()]
    assert entries
    for make in (os.mkfifo, os.mkdir, lambda path: os.symlink("/dev/zero", path)):
        for path in entries:
            if path.is_dir() and not path.is_symlink():
                path.rmdir()
            else:
                path.unlink()
            make(path)
        done = easypbr(*arguments, EASYPBR_CACHE_DIR=str(cache))
        assert done.returncode == 0, done.stderr
        assert (tmp_path / "out.png").read_bytes() == wanted
        entries = [path for path in cache.rglob("*") if path.name in {entry.name for entry in entries}]


def test_pipes_as_sources_of_a_data_set(tmp_path):
    os.mkfifo(tmp_path / "model.ply")
    (tmp_path / "spec.toml").write_text("count = 1\n[image]\nsize = [32, 24]\nsamples = 1\n[[objects]]\nclass = 'a'\nsource = 'model.ply'\n")
    done = subprocess.run([sys.executable, "-P", "-m", "easypbr", "dataset", "spec.toml", "-o", "set", "--quiet"], cwd=tmp_path,
                          capture_output=True, text=True, timeout=60)
    assert done.returncode != 0 and "model.ply" in done.stderr and "Traceback" not in done.stderr, done.stderr


def children(process) -> list[int]:
    found = subprocess.run(["pgrep", "-P", str(process)], capture_output=True, text=True).stdout.split()
    return [int(child) for child in found]


def test_killed_workers_lose_nothing(tmp_path):
    (tmp_path / "spec.toml").write_text("count = 60\nwriters = ['coco', 'yolo']\n[image]\nsize = [64, 48]\nsamples = 2\n"
                                        "[background]\nskies = 1\n[[objects]]\nsource = 'builtin:drone'\nclass = 'drone'\n")
    command = [sys.executable, "-P", "-m", "easypbr", "dataset", "spec.toml", "--quiet", "--workers", "2"]
    assert subprocess.run([*command, "-o", "whole"], cwd=tmp_path, timeout=300).returncode == 0
    process = subprocess.Popen([*command, "-o", "set"], cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    records = tmp_path / "set/records"
    kills = 0
    while process.poll() is None and kills < 2:
        made = len(list(records.glob("*.json"))) if records.exists() else 0
        # Those that make frames, and not the one that keeps account of what all share.
        workers = [child for child in children(process.pid)
                   if b"spawn_main" in (open(f"/proc/{child}/cmdline", "rb").read() if os.path.exists(f"/proc/{child}") else b"")]
        if made > 5 * (kills + 1) and workers:
            os.kill(workers[0], signal.SIGKILL)
            kills += 1
        time.sleep(0.01)
    _, error = process.communicate(timeout=300)
    assert kills > 0, "the set was done too soon"
    assert process.returncode == 0, error
    hashed = [{name: hashlib.sha256(data).hexdigest() for name, data in contents(tmp_path / folder).items()} for folder in ("whole", "set")]
    assert hashed[0] == hashed[1]


def write_npy(path, kind):
    header = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': (2, 3), }}".encode()
    header += b" " * (63 - (len(header) + 10) % 64) + b"\n"
    path.write_bytes(b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header + bytes(48))


@pytest.mark.parametrize("kind", ["<U18446744073709551616", "|V18446744073709551615", "<f18446744073709551616", "<f-8"])
def test_types_of_endless_length_are_refused(tmp_path, kind):
    write_npy(tmp_path / "a.npy", kind)
    with pytest.raises(package.FormatError, match="its type .* is (not understood|too long)"):
        package.Mesh(tmp_path / "a.npy")


def test_many_properties_take_time_in_proportion(tmp_path):
    def seconds(count):
        names = "".join(f"property float p{i}\n" for i in range(count))
        (tmp_path / "a.ply").write_text("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                                        f"{names}end_header\n0 0 0{' 1' * count}\n")
        begin = time.process_time()
        assert len(package.Mesh(tmp_path / "a.ply").scalars) == count
        return time.process_time() - begin

    seconds(100)
    few, many = min(seconds(2000) for _ in range(3)), min(seconds(20000) for _ in range(2))
    # Ten times as many: ten times the time, and a hundred times if it grew as the square. Between them in the geometric sense.
    assert many < 10 * 10**0.5 * max(few, 0.005)


def test_lights_cost_what_they_light():
    """2000 lamps without shadows, and 50 with: CPU seconds at 64 x 48, which were 4.6 for 50 when maps were drawn for all."""
    def seconds(count, shadows):
        view = package.Viewer((64, 48), scene=package.Scene())
        view.scene.show(package.shapes.sphere(1.0, 32))
        for i in range(count):
            view.add_light(f"lamp {i}", position=(3 * (i % 7) - 9, 2 + i % 5, 3 * (i % 11) - 15), intensity=1.0)
            view.lights[f"lamp {i}"].casts_shadows = shadows
        begin = time.process_time()
        view.render(samples=1)
        return time.process_time() - begin

    seconds(1, True)
    assert seconds(2000, False) < 2
    assert seconds(50, True) < 2


def test_an_interpreter_without_memory_for_a_mesh():
    """Python's own exception, and all goes on after it."""
    code = ("import resource, numpy as np, easypbr\nfrom easypbr import Mesh, Scene, Viewer, shapes\n"
            "view = Viewer((32, 24), scene=Scene())\nview.scene.show(shapes.box(), 'box')\nbefore = view.render(samples=1)\n"
            "now = int(open('/proc/self/statm').read().split()[0]) * 4096\n"
            "resource.setrlimit(resource.RLIMIT_AS, (now + 50_000_000, -1))\n"
            "try:\n    shapes.sphere(1.0, 8000)\nexcept MemoryError as error:\n    print('refused')\n"
            "assert (view.render(samples=1) == before).all()\nprint('drawn')\n")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120,
                          env={**os.environ, "EASYPBR_THREADS": "1"})
    assert done.stdout.split() == ["refused", "drawn"], done

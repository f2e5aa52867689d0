"""The installed package, seen from outside: run by scripts/test_wheel.sh with the Python that has it, and with nothing
but the standard library and numpy beside it; by a user without root, whose HOME cannot be written."""
import importlib.metadata
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import urllib.request

import numpy as np

PROGRAM = pathlib.Path(sys.executable).parent / "easypbr"

LISTING = """
from easypbr import *
view  = Viewer()
view.load_environment_map("./map.hdr")
drone = Mesh("./drone.ply")
Scene.show(drone, "drone")
view.recorder.record("img.png")
"""


def write_environment(path: pathlib.Path) -> None:
    """A small map in Radiance's format, without compression."""
    width, height = 16, 8
    rows = b"".join(bytes((100 + 8 * y, 120, 140, 129)) * width for y in range(height))
    path.write_bytes(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode() + rows)


def write_mesh(path: pathlib.Path) -> None:
    """Red: before the bright backdrop, under an even sky, a white one would have little contrast."""
    path.write_text("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                    "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
                    "0 0 0 200 20 20\n1 0 0 200 20 20\n0 1 0 200 20 20\n0 0 1 200 20 20\n"
                    "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n")


def picture(path: pathlib.Path) -> np.ndarray:
    import easypbr

    return easypbr.load_image(path)


class Installed(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        write_environment(self.folder / "map.hdr")
        write_mesh(self.folder / "drone.ply")

    def run_(self, *command: object, code: int = 0, **more: str) -> subprocess.CompletedProcess:
        done = subprocess.run([str(word) for word in command], cwd=self.folder, env={**os.environ, **more},
                              capture_output=True, text=True, timeout=300, check=False)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def fetched(self, address: str) -> bytes:
        with urllib.request.urlopen(address, timeout=60) as answer:
            return answer.read()

    def assert_drawn(self, name: str) -> None:
        self.assertGreater(np.ptp(picture(self.folder / name)[:, :, :3]), 50, name)

    def test_it_says_what_it_contains(self) -> None:
        files = importlib.metadata.files("easypbr") or []
        lists = [file for file in files if file.name == "easypbr.spdx.json"]
        self.assertEqual([file.parent.name for file in lists], ["sboms"])
        names = {package["name"] for package in json.loads(lists[0].read_text())["packages"]}
        bundled = [file.name for file in files if file.parent.name == "easypbr.libs"]
        self.assertTrue(bundled)
        for start, package in (("libfmt-", "libfmt9"), ("libtbb-", "libtbb12"), ("libembree3-", "libembree3-3")):
            self.assertTrue(any(name.startswith(start) for name in bundled), start)
            self.assertIn(package, names)

    def test_user(self) -> None:
        """What the other tests are worth: no root, and nothing can be written at home."""
        self.assertNotEqual(os.geteuid(), 0)
        self.assertFalse(os.access(os.path.expanduser("~"), os.W_OK))

    def test_libraries_are_those_of_the_wheel(self) -> None:
        maps = self.run_(sys.executable, "-c", "import easypbr; easypbr.render(easypbr.shapes.teapot(), size=(64, 64));"
                         "print(open('/proc/self/maps').read())").stdout
        loaded = {pathlib.Path(line.split()[-1]).resolve() for line in maps.splitlines() if ".so" in line}
        for name in ("libeasypbr", "libembree3", "libtbb", "libfmt", "libyaml-cpp", "libtinyexr", "libspng"):
            found = [path for path in loaded if path.name.startswith(name)]
            self.assertTrue(found, name)
            for path in found:
                self.assertIn(pathlib.Path(sys.prefix).resolve(), path.parents)

    def test_doctor(self) -> None:
        said = self.run_(PROGRAM, "doctor").stdout
        for part in ("easypbr", "cache", "formats", "assimp      reader found", "Draco       module found", "CPU"):
            self.assertIn(part, said)

    def test_listing_of_the_paper(self) -> None:
        self.run_(sys.executable, "-c", LISTING)
        self.assert_drawn("img.png")

    def test_render(self) -> None:
        self.run_(PROGRAM, "render", "drone.ply", "--env", "map.hdr", "--size", "160x120", "-o", "out.png")
        self.assertEqual(picture(self.folder / "out.png").shape[:2], (120, 160))
        self.assert_drawn("out.png")

    def test_turntable(self) -> None:
        self.run_(PROGRAM, "render", "drone.ply", "--turntable", "4", "--size", "96x64", "--samples", "1", "-o",
                  "f_%d.png")
        pictures = [picture(self.folder / f"f_{i}.png").astype(int) for i in range(4)]
        for i in range(4):
            self.assertGreater(np.abs(pictures[i] - pictures[i - 1]).max(), 50)

    def test_line_drawing(self) -> None:
        self.run_(PROGRAM, "render", "drone.ply", "--size", "160x120", "-o", "a.svg")
        text = (self.folder / "a.svg").read_text()
        self.assertIn('viewBox="0 0 160 120"', text)
        self.assertIn("<path", text)

    def test_splats(self) -> None:
        """Written by the package, drawn by the program."""
        self.run_(sys.executable, "-c", "import easypbr; easypbr.splats([[0, 0, 0], [1, 0, 0], [0, 1, 0]], 0.2, opacities=0.9, "
                  "colors=[[1, 0, 0], [0, 1, 0], [0, 0, 1]]).save('room.ply')")
        self.run_(PROGRAM, "render", "room.ply", "--size", "96x64", "-o", "room.png")
        self.assert_drawn("room.png")

    def test_serve(self) -> None:
        """The page and its program come from the library; nothing is fetched from elsewhere."""
        with subprocess.Popen([PROGRAM, "serve", "drone.ply"], cwd=self.folder, stdout=subprocess.PIPE, text=True) as server:
            try:
                said = server.stdout.readline()
                link = re.search(r"http://127\.0\.0\.1:\d+/\S*", said)
                self.assertTrue(link, said)
                address = link[0].split("#")[0]
                page = self.fetched(address).decode()
                self.assertIn("<title>EasyPBR</title>", page)
                names = re.findall(r'(?:src|href)="([^"]+)"', page)
                self.assertEqual(sorted(names), ["app.css", "app.js", "icon.svg"])
                for name in names:
                    self.assertTrue(self.fetched(address + name), name)
            finally:
                server.terminate()

    def test_widget(self) -> None:
        """What it needs beside the package is named."""
        said = self.run_(sys.executable, "-c", "import easypbr; easypbr.Viewer((64, 48)).widget()", code=1).stderr
        self.assertIn("easypbr[jupyter]", said)

    def test_video(self) -> None:
        """Written where FFmpeg is; elsewhere an error names what has it."""
        has_ffmpeg = shutil.which("ffmpeg") is not None
        done = self.run_(PROGRAM, "render", "drone.ply", "--turntable", "4", "--size", "96x64", "--samples", "1", "-o",
                         "a.mp4", code=0 if has_ffmpeg else 1)
        if has_ffmpeg:
            self.assertGreater((self.folder / "a.mp4").stat().st_size, 500)
            return
        self.assertIn("apt install ffmpeg", done.stderr)
        self.assertIn("imageio-ffmpeg", done.stderr)
        # One that imageio-ffmpeg knows is asked: this one says nothing.
        (self.folder / "imageio_ffmpeg.py").write_text("def get_ffmpeg_exe(): return '/bin/true'\n")
        done = self.run_(PROGRAM, "render", "drone.ply", "--turntable", "4", "--samples", "1", "-o", "a.mp4", code=1,
                         PYTHONPATH=str(self.folder))
        self.assertIn("/bin/true does not work", done.stderr)
        self.assertFalse((self.folder / "a.mp4").exists())

    def test_dataset(self) -> None:
        self.run_(PROGRAM, "dataset", "--demo", "-o", "drones", "--count", "2", "--workers", "1", "-q")
        self.assertGreaterEqual(len(list((self.folder / "drones").rglob("*.png"))), 2)
        for path in (self.folder / "drones").rglob("*.json"):
            json.loads(path.read_text())

    def test_rarer_formats(self) -> None:
        """assimp's program runs from where it was installed."""
        (self.folder / "a.dae").write_text("no such thing")
        said = self.run_(PROGRAM, "render", "a.dae", "-o", "a.png", code=1).stderr
        self.assertIn("a.dae", said)
        self.assertNotIn("cannot be started", said)

    def test_opengl_is_not_needed_until_it_is_asked_for(self) -> None:
        done = self.run_(sys.executable, "-c", "import easypbr; easypbr.render(easypbr.shapes.teapot(), size=(64, 64));"
                         "print([l for l in open('/proc/self/maps') if 'libGL' in l or 'libEGL' in l])",
                         EASYPBR_DEVICE="cpu")
        self.assertEqual(done.stdout.strip(), "[]")

    def test_opengl_of_the_system(self) -> None:
        """EASYPBR_TEST_GL says whether there is one."""
        has_gl = os.environ["EASYPBR_TEST_GL"] == "yes"
        done = self.run_(PROGRAM, "render", "drone.ply", "-o", "a.png", code=0 if has_gl else 1, EASYPBR_DEVICE="gl")
        said = self.run_(PROGRAM, "doctor", code=0).stdout
        if has_gl:
            self.assert_drawn("a.png")
            self.assertIn("llvmpipe", said)
        else:
            self.assertIn("libEGL", done.stderr)
            self.assertFalse((self.folder / "a.png").exists())


if __name__ == "__main__":
    unittest.main()

"""The program in a system that has what it is linked to and nothing else: no Mesa, no libGL, no libEGL, no shell."""
import os
import pathlib
import re
import shutil
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build/easypbr"
sys.path += [str(ROOT / "tests/cli"), str(ROOT / "tests/remote")]

import png  # noqa: E402
import shapes  # noqa: E402
from client import Client  # noqa: E402

OPENGL = re.compile(r"lib(GL|EGL|OpenGL|GLX|GLdispatch|OSMesa|gbm|gallium)[._\w]*\.so")
# Other users than root become root of a namespace of their own, for chroot.
CHROOT = ["unshare", "--mount", *([] if os.geteuid() == 0 else ["--map-root-user"]), "sh", "-c",
          'mount --rbind /proc "$0/proc" && exec chroot "$0" "$@"']


def linked(program: pathlib.Path) -> list[pathlib.Path]:
    """The libraries that the loader maps for a program, the loader among them."""
    lines = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout.splitlines()
    assert not [line for line in lines if "not found" in line]
    return [pathlib.Path(found[1]) for line in lines if (found := re.search(r"(?:=> |^\s+)(/\S+)", line))]


def copy_into(root: pathlib.Path, file: pathlib.Path) -> None:
    place = root / file.relative_to("/")
    place.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(file, place)


@pytest.fixture(scope="module")
def bare(tmp_path_factory):
    """Runs the program in that system."""
    root = tmp_path_factory.mktemp("root")
    for file in [PROGRAM, *linked(PROGRAM)]:
        copy_into(root, file)
    for folder in ("proc", "tmp"):
        (root / folder).mkdir()
    shapes.write_sphere(root / "tmp/sphere.obj")

    environment = {"PATH": os.environ["PATH"], "HOME": "/tmp"}

    def run(*arguments: str, code: int = 0) -> subprocess.CompletedProcess:
        done = subprocess.run([*CHROOT, root, PROGRAM, *arguments], env=environment, capture_output=True, text=True,
                              timeout=300, check=False)
        assert done.returncode == code, done.stdout + done.stderr
        return done

    run.root = root
    run.start = lambda *arguments: subprocess.Popen([*CHROOT, root, PROGRAM, *arguments], env=environment,
                                                    stdout=subprocess.PIPE, text=True)
    return run


def rows(text: str) -> dict[str, str]:
    """What doctor prints, by its first column."""
    return dict(line.split(maxsplit=1) for line in text.splitlines() if line[:1].strip() and " " in line.strip())


def test_the_system_has_no_opengl(bare):
    files = [path.name for path in bare.root.rglob("*") if path.is_file()]
    assert "libeasypbr.so.0.1" in files
    assert not [name for name in files if OPENGL.match(name)]


def test_doctor_says_what_draws_and_what_is_not_there(bare):
    told = rows(bare("doctor").stdout)
    assert told["device"] == "cpu: draws natively"
    assert told["OpenGL"].startswith("not there: ")
    assert "libegl1" in told["OpenGL"]
    shown = (ROOT / "docs/headless.md").read_text()
    for name in ("device", "OpenGL"):
        assert f"\n{name:<12}{told[name]}\n" in shown


@pytest.mark.parametrize("samples", ["1", "4"])
def test_a_mesh_is_drawn(bare, samples):
    name = f"tmp/{samples}.png"
    bare("render", "/tmp/sphere.obj", "-o", f"/{name}", "--size", "64x48", "--samples", samples,
         "--set", "background.mode=transparent")
    drawn = png.read(bare.root / name)
    assert drawn.shape[:2] == (48, 64)
    # The camera looks at the middle of the sphere: it covers the centre, the corners are empty.
    assert drawn[24, 32, 3] == 255 and drawn[24, 32, :3].max() > 30
    assert drawn[0, 0, 3] == drawn[-1, -1, 3] == 0


def test_a_browser_view_is_drawn_turned_and_picked(bare, tmp_path):
    with bare.start("serve", "/tmp/sphere.obj", "--set", "image.samples=4", "--set", "background.mode=transparent") as server:
        try:
            client = Client(re.search(r"http://\S+", server.stdout.readline())[0], size=(64, 48))
            drawn = client.until_exact()
            image = drawn.image(tmp_path)
            assert image.shape[:2] == (48, 64) and image[24, 32, :3].max() > 30
            client.drag((32, 24), (50, 24))
            turned = client.until_exact(after=drawn.number, shows=client.inputs)
            assert (turned.image(tmp_path)[24, 32] != image[24, 32]).any()
            client.pointer("press", 32, 24)
            client.pointer("release", 32, 24)
            client.until_known("scene", lambda scene: scene["selected"] == "sphere")
            assert not client.notices
            client.close()
        finally:
            server.terminate()


def test_the_device_gl_says_what_to_install(bare):
    done = bare("--device", "gl", "render", "/tmp/sphere.obj", "-o", "/tmp/gl.png", code=1)
    assert "libegl1" in done.stderr
    assert not (bare.root / "tmp/gl.png").exists()

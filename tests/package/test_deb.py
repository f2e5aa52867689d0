"""Debian packages: what is in which, what they depend on, and that what they hold runs and is found."""
import os
import pathlib
import re
import shutil
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
OUTSIDE = pathlib.Path(__file__).parent / "outside"
PACKAGES = {"easypbr", "libeasypbr", "libeasypbr-dev", "python3-easypbr"}


def run(*command, **options):
    result = subprocess.run([str(c) for c in command], capture_output=True, text=True, **options)
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


@pytest.fixture(scope="module")
def packages(tmp_path_factory):
    """The packages' files by their names."""
    folder = tmp_path_factory.mktemp("packages")
    run("cpack", "-G", "DEB", "-B", folder, cwd=ROOT / "build")
    return {path.name.split("_")[0]: path for path in folder.glob("*.deb")}


@pytest.fixture(scope="module")
def system(packages, tmp_path_factory):
    """A folder that all packages are unpacked in, its usr/."""
    folder = tmp_path_factory.mktemp("system")
    for path in packages.values():
        run("dpkg-deb", "-x", path, folder)
    return folder / "usr"


def fields(path):
    return dict(re.findall(r"^([A-Z][\w-]+): (.*)$", run("dpkg-deb", "-f", path), re.MULTILINE))


def contents(path):
    return [line.split()[5] for line in run("dpkg-deb", "-c", path).splitlines() if not line.startswith("d")]


def test_packages_hold_what_their_names_say(packages):
    assert set(packages) == PACKAGES
    files = {name: contents(path) for name, path in packages.items()}
    assert [name for name in PACKAGES if any(f.endswith("/bin/easypbr") for f in files[name])] == ["easypbr"]
    assert any(f.endswith("/man1/easypbr.1") for f in files["easypbr"])
    assert "./usr/share/thumbnailers/easypbr.thumbnailer" in files["easypbr"]
    assert "./usr/share/mime/packages/easypbr.xml" in files["easypbr"]
    assert any(re.search(r"/libeasypbr\.so\.\d", f) for f in files["libeasypbr"])
    assert not any(f.endswith(("/libeasypbr.so", ".h")) for f in files["libeasypbr"])
    headers = {f.split("/include/", 1)[1] for f in files["libeasypbr-dev"] if f.endswith(".h")}
    assert headers == {str(path.relative_to(ROOT / "include")) for path in (ROOT / "include").rglob("*.h")}
    assert any(f.endswith("/dist-packages/easypbr/py.typed") for f in files["python3-easypbr"])
    assert not any("__pycache__" in f for name in PACKAGES for f in files[name])
    for name in PACKAGES:
        assert f"./usr/share/doc/{name}/copyright" in files[name]


def test_packages_name_what_they_need(packages):
    version = re.search(r"project\(easypbr VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
    for name, path in packages.items():
        known = fields(path)
        assert known["Version"] == version
        assert known["Description"].startswith("Physically based renderer")
        if name != "libeasypbr":
            assert f"libeasypbr (= {version})" in known["Depends"]
    assert "libtbb" in fields(packages["libeasypbr"])["Depends"] and "libc6" in fields(packages["easypbr"])["Depends"]
    assert "python3-numpy" in fields(packages["python3-easypbr"])["Depends"]


@pytest.mark.skipif(os.geteuid() != 0, reason="only root may ask apt what it would install")
def test_apt_finds_what_they_need(packages):
    planned = run("apt-get", "install", "--simulate", "--no-install-recommends", *packages.values())
    assert {line.split()[1] for line in planned.splitlines() if line.startswith("Inst ")} >= PACKAGES


def test_unpacked_files_run_and_are_found(system, tmp_path):
    environment = {"PATH": os.environ["PATH"], "HOME": str(tmp_path), "EASYPBR_DEVICE": "cpu"}
    run(system / "bin/easypbr", "demo", "--size", "64x48", "--samples", "1", "-o", "demo.png", cwd=tmp_path, env=environment)
    assert (tmp_path / "demo.png").stat().st_size > 0
    used = run("ldd", system / "bin/easypbr", env=environment)
    assert str(system) in used and str(ROOT) not in used
    script = "import easypbr; print(easypbr.__file__, easypbr.shapes.sphere(1).V.shape[1])"
    printed = run("/usr/bin/python3", "-c", script, cwd=tmp_path,
                  env={**environment, "PYTHONPATH": str(system / "lib/python3/dist-packages")})
    assert printed.split() == [str(system / "lib/python3/dist-packages/easypbr/__init__.py"), "3"]
    shutil.copytree(OUTSIDE, tmp_path / "source")
    run("cmake", "-S", "source", "-B", "built", f"-DCMAKE_PREFIX_PATH={system}", cwd=tmp_path)

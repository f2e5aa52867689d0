#!/usr/bin/env python3
"""Makes the package of a build folder importable from a virtual environment, without installing it.

usage: link_python.py BUILD_FOLDER VENV      writes VENV/.../easypbr.pth and VENV/bin/easypbr
"""
import pathlib
import subprocess
import sys

PROGRAM = """#!{python}
import sys

from easypbr.__main__ import main

sys.exit(main())
"""


def link(build: pathlib.Path, venv: pathlib.Path) -> None:
    python = venv / "bin/python"
    query = "import sysconfig; print(sysconfig.get_path('purelib'))"
    packages = subprocess.run([python, "-c", query], check=True, capture_output=True, text=True).stdout.strip()
    (pathlib.Path(packages) / "easypbr.pth").write_text(f"{build / 'python'}\n")
    program = venv / "bin/easypbr"
    program.write_text(PROGRAM.format(python=python))
    program.chmod(0o755)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    # absolute(), not resolve(): a virtual environment's python is a link that must not be followed.
    build_folder, environment = (pathlib.Path(argument).absolute() for argument in sys.argv[1:])
    if not (build_folder / "python/easypbr/__init__.py").exists():
        sys.exit(f"{build_folder} holds no Python package: configure it with -DEASYPBR_BUILD_PYTHON=ON and build")
    link(build_folder, environment)

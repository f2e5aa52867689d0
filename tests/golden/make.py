"""Draws the golden pictures anew, or those that are named:

    .venv/bin/python tests/golden/make.py [NAME...]

Look at each before it is committed: a golden picture says that nothing has changed, not that it is right.
"""
import json
import os
import pathlib
import re
import subprocess
import sys

from effects import EFFECTS, SIZE

import easypbr

HERE = pathlib.Path(__file__).resolve().parent
PROGRAM = os.environ.get("EASYPBR_BINARY", HERE.parents[1] / "build/easypbr")


def main():
    names = sys.argv[1:] or list(EFFECTS)
    for name in names:
        easypbr.save_image(EFFECTS[name](), HERE / "pictures" / f"{name}.png")
        print(name)
    doctor = subprocess.run([PROGRAM, "doctor"], capture_output=True, text=True, check=True).stdout
    manifest = {"renderer": re.search(r"^renderer +(.*)$", doctor, re.MULTILINE)[1], "size": SIZE, "pictures": sorted(EFFECTS)}
    (HERE / "manifest.json").write_text(json.dumps(manifest, indent=1) + "\n")


if __name__ == "__main__":
    main()

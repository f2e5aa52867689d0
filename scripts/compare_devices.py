#!/usr/bin/env python3
"""Draws twelve scenes of tests/golden by the device cpu and by OpenGL, and prints how far they are apart: the table of
docs/headless.md.

usage: compare_devices.py [OUTPUT_FILE]      a sheet of the pictures; the easypbr package must be importable

On machines with a GPU the second pictures are the GPU's, else those of a driver that draws on the CPU.
"""
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import easypbr

ROOT = pathlib.Path(__file__).resolve().parents[1]
SCENES = ("shadows_hard", "shadows_3x3", "shadows_soft", "ambient_occlusion_horizon", "ambient_occlusion_hemisphere", "bloom",
          "transparency", "depth_of_field_single", "ground_shadow", "ground_plane", "eye_dome", "outline")
DEVICES = {"cpu": {"EASYPBR_DEVICE": "cpu"}, "gl": {"EASYPBR_DEVICE": "gl", "EASYPBR_NATIVE": "0"}}
DRAW = """
import sys
import numpy as np
from effects import EFFECTS
np.savez(sys.argv[1], **{name: EFFECTS[name]() for name in sys.argv[2:]})
"""
GAP = 6


def drawn_by(device: str) -> dict[str, np.ndarray]:
    """The scenes' colours, drawn in a process of its own."""
    environment = {**os.environ, **DEVICES[device], "PYTHONPATH": str(ROOT / "tests/golden")}
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "pictures.npz"
        subprocess.run([sys.executable, "-c", DRAW, str(file), *SCENES], env=environment, check=True)
        with np.load(file) as pictures:
            return {name: pictures[name][:, :, :3] for name in SCENES}


def beside(pictures: list[np.ndarray]) -> np.ndarray:
    gap = np.full((pictures[0].shape[0], GAP, 3), 255, np.uint8)
    return np.hstack([part for picture in pictures for part in (picture, gap)][:-1])


def compare() -> tuple[list[str], np.ndarray]:
    """A line of the table for each scene; the sheet: in two columns, each scene by cpu, by gl, and 64 times the difference."""
    cpu, gl = drawn_by("cpu"), drawn_by("gl")
    lines, rows = [], []
    for name in SCENES:
        difference = np.abs(cpu[name].astype(int) - gl[name])
        apart = difference.max(axis=2)
        parts = f"{100 * (apart > 0).mean():.2f} % | {100 * (apart > 1).mean():.2f} % | {apart.max()}"
        lines.append(f"| {name.replace('_', ' ')} | {parts} |")
        rows.append(beside([cpu[name], gl[name], np.minimum(64 * difference, 255).astype(np.uint8)]))
    gap = np.full((GAP, rows[0].shape[1], 3), 255, np.uint8)
    columns = [np.vstack([part for row in half for part in (row, gap)][:-1]) for half in (rows[::2], rows[1::2])]
    return lines, beside(columns)


def main() -> None:
    lines, sheet = compare()
    print("| Scene | pixels that differ | by more than 1 of 255 | largest |\n|---|---|---|---|")
    print("\n".join(lines))
    if len(sys.argv) > 1:
        easypbr.save_image(sheet, sys.argv[1])


if __name__ == "__main__":
    main()

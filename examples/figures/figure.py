"""What the figures share: their command line, placing things, pictures side by side."""
import argparse
import os
import pathlib
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

import easypbr
from easypbr import Mesh


def main(draw: Callable[[pathlib.Path | None, float], NDArray[Any]]) -> None:
    """usage of every figure: FIGURE.py [OUTPUT.png] [--data FOLDER] [--scale X]"""
    script = pathlib.Path(sys.argv[0])
    parser = argparse.ArgumentParser(description=sys.modules["__main__"].__doc__)
    parser.add_argument("output", nargs="?", default=f"{script.stem}.png")
    parser.add_argument("--data", default=os.environ.get("EASYPBR_TEST_DATA"),
                        help="folder with bunny.ply and clouds/lion.ply; without it shapes made here take their place "
                             "(default: $EASYPBR_TEST_DATA)")
    parser.add_argument("--scale", type=float, default=1.0, help="factor on the size of the picture")
    arguments = parser.parse_args()
    data = pathlib.Path(arguments.data) if arguments.data else None
    easypbr.save_image(draw(data, arguments.scale), arguments.output)


def sized(width: int, height: int, scale: float) -> tuple[int, int]:
    return max(16, round(width * scale)), max(16, round(height * scale))


def placed(mesh: Mesh, x: float = 0, y: float = 0, z: float = 0, turn_deg: float = 0, scale: float = 1) -> Mesh:
    """The mesh turned around the y axis, scaled, then moved."""
    c, s = np.cos(np.radians(turn_deg)) * scale, np.sin(np.radians(turn_deg)) * scale
    return mesh.transform([[c, 0, s, x], [0, scale, 0, y], [-s, 0, c, z], [0, 0, 0, 1]])


def labelled(mesh: Mesh, label: int) -> Mesh:
    """The mesh with one label for all of its vertices."""
    mesh.L = np.full(len(mesh.V), label)
    return mesh


def row(pictures: list[NDArray[Any]], gap: int = 6) -> NDArray[Any]:
    """Pictures side by side with a white gap."""
    white = np.full((len(pictures[0]), gap, 3), 255, np.uint8)
    parts = [part for picture in pictures for part in (picture[:, :, :3], white)]
    return np.hstack(parts[:-1])

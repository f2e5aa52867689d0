"""A labelled cloud in SemanticKITTI's colours, with a legend of what is in it (figure 8 of the paper).

Writes labelled_street.png.
"""
import pathlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from easypbr import Scene, Viewer
from figure import main, sized
from street import street


def draw(data: pathlib.Path | None, scale: float) -> NDArray[Any]:
    scene = Scene()
    scene.show(street(), "street")
    camera = {"position": (-9, 11, 34), "target": (1, 1, 6)}
    settings = {"camera": camera, "annotation": {"legend": True}, "points": {"hole_filling": 2}}
    return Viewer(sized(900, 480, scale), settings, scene).render()


if __name__ == "__main__":
    main(draw)

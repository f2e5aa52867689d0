"""A data set of drones over a garden of 3D Gaussian splats: its contact sheet. Writes splat_dataset.png."""
import pathlib
import tempfile
from typing import Any

from numpy.typing import NDArray

import easypbr
from easypbr.dataset import DatasetSpec, generate
from figure import main
from splats import garden

SPEC = """
count = 5
seed = 4
writers = ["coco"]

[image]
size = [{width}, {height}]
samples = 8

[camera]
elevation_deg = [15, 40]

[surroundings]
source = "{folder}/garden.ply"
size = 4
up = "y"
turn_deg = [-180, 180]

[[objects]]
source = "builtin:drone"
count = [1, 3]
size = [0.4, 0.7]
"""


def draw(data: pathlib.Path | None, scale: float) -> NDArray[Any]:
    with tempfile.TemporaryDirectory() as folder:
        garden().save(f"{folder}/garden.ply")
        path = pathlib.Path(folder, "spec.toml")
        path.write_text(SPEC.format(width=round(320 * scale), height=round(240 * scale), folder=folder))
        generate(DatasetSpec.from_toml(path), f"{folder}/drones", workers=1)
        return easypbr.load_image(f"{folder}/drones/contact_sheet.png")


if __name__ == "__main__":
    main(draw)

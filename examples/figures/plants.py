"""Instances of a procedural plant, and the same coloured by leaf (figure 9 of the paper). Writes plants.png."""
import pathlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from easypbr import Material, Mesh, Scene, Viewer, shapes
from figure import labelled, main, placed, row, sized

STEM = 0  # leaves count from 1


def leaf(length: float, width: float, droop: float) -> Mesh:
    """A blade along +x that rises, then bends down."""
    mesh = shapes.plane(1, divisions=16)
    s, side = mesh.V[:, 0] + 0.5, mesh.V[:, 2]
    outline = np.sqrt(np.clip(1 - (2 * s - 1) ** 2, 0, 1)) * (1.15 - 0.5 * s)
    x = length * s * (1 - 0.25 * droop * s)
    y = length * (0.75 * s - droop * s**2) + 0.25 * width * np.abs(side) * outline
    blade = Mesh(np.stack([x, y, width * side * outline], axis=1), mesh.F)
    return blade


def plant(leaves: int = 13) -> Mesh:
    """Leaves at the golden angle around a stem, the upper ones smaller and steeper."""
    parts = [part_of(placed(shapes.cylinder(0.018, 0.9, 16), y=0.45), STEM, "#7a9a4a")]
    for number in range(leaves):
        part = number / (leaves - 1)
        blade = leaf(0.62 - 0.3 * part, 0.26 - 0.12 * part, 0.95 - 0.6 * part)
        parts.append(part_of(placed(blade, y=0.2 + 0.68 * part, turn_deg=137.5 * number), number + 1, "#4f8f34"))
    return Mesh.merge(*parts)


def part_of(mesh: Mesh, label: int, color: str) -> Mesh:
    """Positions and faces alone: normals are computed from the faces."""
    part = labelled(Mesh(mesh.V, mesh.F), label)
    part.material = Material(base_color=color, roughness=0.5, double_sided=True)
    return part


def field(mesh: Mesh, color_by: str) -> Scene:
    """The mesh many times: its data are there once."""
    scene = Scene()
    random = np.random.default_rng(3)
    for x in range(3):
        for z in range(3):
            instance = mesh.clone()
            instance.T_parent_mesh = pose(1.25 * x, -1.25 * z, random.uniform(0, 360), random.uniform(0.8, 1.15))
            instance.style.color_by = color_by
            scene.show(instance, f"plant {x} {z}")
    ground = placed(shapes.plane(14), 1.2, 0, -3)
    ground.material = Material(base_color="#6a5a48", roughness=0.9)
    scene.show(ground, "ground")
    return scene


def pose(x: float, z: float, turn_deg: float, scale: float) -> NDArray[Any]:
    c, s = np.cos(np.radians(turn_deg)) * scale, np.sin(np.radians(turn_deg)) * scale
    return np.array([[c, 0, s, x], [0, scale, 0, 0], [-s, 0, c, z], [0, 0, 0, 1]])


def draw(data: pathlib.Path | None, scale: float) -> NDArray[Any]:
    mesh = plant()
    camera = {"position": (1.25, 2.2, 3.6), "target": (1.25, 0.4, -0.75), "fov_y_deg": 31}
    return row([Viewer(sized(450, 340, scale), {"camera": camera}, field(mesh, color_by)).render()
                for color_by in ("solid", "label")])


if __name__ == "__main__":
    main(draw)

"""A street as a laser scanner would see it: points with SemanticKITTI's labels, made of simple shapes."""
import numpy as np

from easypbr import LabelMap, Mesh, shapes
from figure import labelled, placed

CAR, ROAD, SIDEWALK, BUILDING, VEGETATION, TRUNK, TERRAIN, POLE, SIGN, PERSON = 10, 40, 48, 50, 70, 71, 72, 80, 81, 30


def ground(width: float, length: float, x: float, y: float, label: int) -> Mesh:
    slab = shapes.plane(1).transform(np.diag([width, 1, length, 1]))
    return labelled(placed(slab, x, y), label)


def car(x: float, z: float) -> list[Mesh]:
    body = shapes.box((1.8, 0.7, 4.2))
    cabin = shapes.box((1.5, 0.6, 2.1))
    wheels = [placed(shapes.sphere(0.34, 24), x + side * 0.8, 0.34, z + end) for side in (-1, 1) for end in (-1.3, 1.3)]
    parts = [placed(body, x, 0.75, z), placed(cabin, x, 1.4, z - 0.2), *wheels]
    return [labelled(part, CAR) for part in parts]


def tree(x: float, z: float, random: np.random.Generator) -> list[Mesh]:
    parts = [labelled(placed(shapes.cylinder(0.18, 2.6, 24), x, 1.3, z), TRUNK)]
    for _ in range(7):
        dx, dy, dz = random.normal(0, 0.6, 3)
        ball = placed(shapes.icosphere(random.uniform(0.6, 1.1), 3), x + dx, 3.6 + dy, z + dz)
        parts.append(labelled(ball, VEGETATION))
    return parts


def street(count: int = 1_500_000) -> Mesh:
    """Points on everything, about as dense everywhere: one of `count` in each cell of 9 cm. Metres, y up."""
    random = np.random.default_rng(4)
    parts = [ground(8, 60, 0, 0, ROAD)]
    for side in (-1, 1):
        parts.append(ground(2.6, 60, side * 5.3, 0.12, SIDEWALK))
        parts.append(ground(7, 60, side * 10.1, 0.1, TERRAIN))
        for z in range(-24, 30, 12):
            height = random.uniform(5, 9)
            house = placed(shapes.box((6, height, random.uniform(7, 10))), side * 15, height / 2, z)
            parts.append(labelled(house, BUILDING))
            parts += tree(side * 8.6, z + 5.5 + random.uniform(-1, 1), random)
            parts.append(labelled(placed(shapes.cylinder(0.09, 5, 16), side * 6.3, 2.5, z), POLE))
            parts += car(side * 2.9, z + random.uniform(-3, 3))
        sign = shapes.box((0.7, 0.7, 0.08))
        parts.append(labelled(placed(sign, side * 6.3, 3.2, 0), SIGN))
        parts.append(labelled(placed(shapes.capsule(0.28, 1.2), side * 5.4, 0.95, 7 * side), PERSON))
    solid = Mesh.merge(*parts)
    dense = solid.sample_surface(count, seed=1)
    _, faces, _ = solid.closest_points(dense.V)
    dense.L = solid.L[solid.F[faces, 0]]
    dense.label_map = LabelMap.semantic_kitti()
    return dense.subsample(cell_size=0.09)

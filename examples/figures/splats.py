"""A garden of 3D Gaussian splats with meshes in it: the picture, its instances and its depth. Writes splats.png.

The splats are made here: flat ones for the soil and the pots, long ones for blades of grass, round ones for flowers.
"""
import pathlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

import easypbr
from easypbr import Material, Mesh, Scene, Viewer, shapes
from figure import main, placed, row, sized

random = np.random.default_rng(5)


def turns(axes: NDArray[Any]) -> NDArray[Any]:
    """Quaternions w, x, y, z that turn the z axis to unit vectors."""
    w, x, y = 1 + axes[:, 2], -axes[:, 1], axes[:, 0]
    quaternions: NDArray[Any] = np.stack([w, x, y, np.zeros(len(axes))], 1)
    quaternions[w < 1e-6] = (0, 1, 0, 0)
    return quaternions


def soil(count: int) -> dict[str, NDArray[Any]]:
    means = random.uniform((-2.4, -0.02, -2.4), (2.4, 0.02, 2.4), (count, 3))
    means = means[np.hypot(means[:, 0], means[:, 2]) < 2.2]
    count = len(means)
    up = np.tile([0.0, 1, 0], (count, 1)) + random.normal(scale=0.15, size=(count, 3))
    tone = random.uniform(0.6, 1.1, (count, 1)) * np.array([0.42, 0.33, 0.24])
    return dict(means=means, axes=up, scales=np.tile([0.03, 0.03, 0.006], (count, 1)), colors=tone)


def grass(count: int) -> dict[str, NDArray[Any]]:
    """Blades of four splats each, bent; none near the middle."""
    angle, radius = random.uniform(0, 2 * np.pi, count), 2.1 * np.sqrt(random.uniform(0.08, 1, count))
    root = np.stack([radius * np.cos(angle), np.zeros(count), radius * np.sin(angle)], 1)
    lean = random.normal(scale=0.35, size=(count, 3)) * (1, 0, 1)
    height = random.uniform(0.15, 0.45, (count, 1))
    steps = (np.arange(4) + 0.5) / 4
    means = np.concatenate([root + height * (t * np.array([0, 1, 0]) + t * t * lean) for t in steps])
    axes = np.concatenate([np.array([0, 1, 0]) + 2 * t * lean for t in steps])
    tone = np.concatenate([np.array([0.12, 0.3, 0.08]) + t * np.array([0.35, 0.45, 0.1]) for t in steps for _ in (0,)])
    colors = np.repeat(tone.reshape(4, 3), count, 0) * np.tile(random.uniform(0.7, 1.15, (count, 1)), (4, 1))
    long = np.tile(height / 7, (4, 1))
    scales = np.concatenate([np.full((4 * count, 2), 0.006) * (1, 1.5), long], 1)
    return dict(means=means, axes=axes, scales=scales, colors=colors)


def flowers(count: int) -> dict[str, NDArray[Any]]:
    angle, radius = random.uniform(0, 2 * np.pi, count), random.uniform(0.9, 2.0, count)
    middle = np.stack([radius * np.cos(angle), random.uniform(0.25, 0.5, count), radius * np.sin(angle)], 1)
    petal = random.normal(size=(count, 40, 3)) * (1, 0.4, 1)
    petal /= np.linalg.norm(petal, axis=2, keepdims=True)
    tone = np.array([[0.95, 0.75, 0.2], [0.9, 0.35, 0.45], [0.6, 0.45, 0.9], [0.95, 0.95, 0.9]])[random.integers(4, size=count)]
    colors = np.repeat(tone, 40, 0) * random.uniform(0.8, 1.05, (40 * count, 1))
    scales = np.tile([0.016, 0.016, 0.006], (40 * count, 1))
    return dict(means=(middle[:, None] + 0.05 * petal).reshape(-1, 3), axes=petal.reshape(-1, 3), scales=scales, colors=colors)


def garden(blades: int = 14000) -> Mesh:
    parts = [soil(16000), grass(blades), flowers(60)]
    means, axes, scales, colors = (np.concatenate([part[key] for part in parts]) for key in ("means", "axes", "scales", "colors"))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    opacities = random.uniform(0.75, 0.98, len(means))
    return easypbr.splats(means, scales, turns(axes), opacities, colors=np.clip(colors, 0, 1))


def draw(data: pathlib.Path | None, scale: float) -> NDArray[Any]:
    scene = Scene()
    scene.show(garden(), "garden")
    ball = placed(shapes.sphere(0.34, 128), 0.6, 0.34, 0.6)
    ball.material = Material(base_color="white", roughness=0, transmission=1, ior=1.5, thickness=0.68)
    pot = placed(shapes.teapot(0.9), -0.3, 0.33, -0.1, 35)
    pot.material = Material(base_color="#c8642c", roughness=0.35)
    scene.show(ball, "ball")
    scene.show(pot, "pot")
    camera = {"position": (1.9, 1.5, 4.6), "target": (0, 0.25, 0), "fov_y_deg": 30}
    view = Viewer(sized(420, 320, scale), {"camera": camera, "image": {"samples": 8}}, scene)
    layers = view.render_layers(["color", "instance_id", "depth"], samples=8)
    colors = np.array([[255, 255, 255], [120, 170, 90], [90, 130, 200], [220, 130, 60]], np.uint8)
    depth = layers["depth"]
    seen = depth > 0
    near, far = depth[seen].min(), depth[seen].max()
    grey = np.where(seen, 235 - 200 * (depth - near) / (far - near), 255).astype(np.uint8)
    return row([layers["color"], colors[layers["instance_id"]], np.repeat(grey[:, :, None], 3, 2)])


if __name__ == "__main__":
    main(draw)

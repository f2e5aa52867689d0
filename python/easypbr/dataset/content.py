"""Procedural content: drones of several shapes and materials, simple shapes, skies."""

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import shapes
from .._easypbr import Environment, Mesh


def _merged(parts: list[Any]) -> Mesh:
    """One mesh of (mesh, 4 x 4 pose) pairs."""
    V, N, F, first = [], [], [], 0
    for mesh, T in parts:
        linear = T[:3, :3]
        V.append(mesh.V @ linear.T + T[:3, 3])
        # Normals turn with the cofactors, which need no inverse.
        cofactors = np.stack([np.cross(linear[1], linear[2]), np.cross(linear[2], linear[0]), np.cross(linear[0], linear[1])])
        normals = mesh.N @ cofactors.T
        N.append(normals / np.linalg.norm(normals, axis=1, keepdims=True))
        F.append(mesh.F + first)
        first += len(mesh.V)
    merged = Mesh(np.concatenate(V), np.concatenate(F))
    merged.N = np.concatenate(N)
    return merged


def _placed(position: ArrayLike, scale: ArrayLike = (1, 1, 1), turn_deg: float = 0) -> NDArray[Any]:
    """Scaled along its own axes, then turned about y, then moved."""
    angle = np.radians(turn_deg)
    c, s = np.cos(angle), np.sin(angle)
    T = np.eye(4)
    T[:3, :3] = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]) @ np.diag(np.asarray(scale))
    T[:3, 3] = position
    return T


def _material(mesh: Mesh, color: Iterable[float], metallic: float, roughness: float) -> Mesh:
    mesh.material.base_color = tuple(float(c) for c in color)
    mesh.material.metallic, mesh.material.roughness = float(metallic), float(roughness)
    return mesh


def random_material(mesh: Mesh, random: np.random.Generator) -> None:
    """A plausible paint, plastic or metal."""
    _material(mesh, random.uniform(0.03, 0.9, 3), float(random.random() < 0.3), random.uniform(0.15, 0.8))


def drone(random: np.random.Generator) -> Mesh:
    """A multicopter: 4, 6 or 8 arms around one of three bodies, rotors with or without guards, two sorts of legs."""
    arms = int(random.choice([4, 6, 8]))
    reach, thickness = random.uniform(0.36, 0.5), random.uniform(0.012, 0.025)
    height = random.uniform(0.09, 0.16)
    bodies: list[Callable[[], tuple[Mesh, NDArray[Any]]]] = [
        lambda: (shapes.box((0.26, height, 0.3)), np.eye(4)),
        lambda: (shapes.sphere(0.5, 24), _placed((0, 0, 0), (0.3, 1.2 * height, 0.34))),
        lambda: (shapes.cylinder(0.15, height, 24), np.eye(4)),
    ]
    body = bodies[random.integers(3)]()
    camera = (shapes.sphere(0.04, 12), _placed((0, -height / 2 - 0.02, 0.1)))
    root = _material(_merged([body, camera]), random.uniform(0.02, 0.9, 3), random.random() < 0.2, random.uniform(0.2, 0.7))
    frame, rotors = [], []
    guarded, radius = random.random() < 0.3, random.uniform(0.55, 0.9) * reach * np.sin(np.pi / arms)
    for k in range(arms):
        turn = 360 / arms * (k + 0.5)
        direction = np.array([np.sin(np.radians(turn)), 0, np.cos(np.radians(turn))])
        frame.append((shapes.box((thickness, thickness, reach)), _placed(direction * reach / 2, (1, 1, 1), turn)))
        frame.append((shapes.cylinder(0.03, 0.06, 12), _placed(direction * reach + (0, 0.02, 0))))
        blade = _placed(direction * reach + (0, 0.055, 0), (1, 1, 1), random.uniform(0, 180))
        rotors.append((shapes.box((2 * radius, 0.006, 0.035)), blade))
        if guarded:
            rotors.append((shapes.torus(radius, 0.008, 24, 8), _placed(direction * reach + (0, 0.05, 0))))
    for side in (-1, 1):
        x, low = side * 0.12, -height / 2 - 0.14
        frame.append((shapes.cylinder(0.008, 1, 8), _rod((x, low, -0.2), (x, low, 0.2))))
        for z in (-0.1, 0.1):
            frame.append((shapes.cylinder(0.008, 1, 8), _rod((x, low, z), (side * 0.08, 0, z))))
    root.add_child(_material(_merged(frame), random.uniform(0.02, 0.4, 3), random.random() < 0.5, random.uniform(0.2, 0.6)))
    root.add_child(_material(_merged(rotors), random.uniform(0.02, 0.6, 3), 0, random.uniform(0.2, 0.6)))
    return root


def _rod(start: ArrayLike, end: ArrayLike) -> NDArray[Any]:
    """Pose of a cylinder of height 1 along y that makes it reach from one point to the other."""
    start, end = np.asarray(start, float), np.asarray(end, float)
    y = end - start
    side = np.cross(y, (1, 0, 0) if abs(y[0]) < np.abs(y).max() else (0, 1, 0))
    x = side / np.linalg.norm(side)
    T = np.eye(4)
    T[:3, :3] = np.stack([x, y, np.cross(x, y / np.linalg.norm(y))], axis=1)
    T[:3, 3] = (start + end) / 2
    return T


def simple_shape(random: np.random.Generator) -> Mesh:
    """A ball, box, cylinder, cone, torus or capsule."""
    makers: list[Callable[[], Mesh]] = [shapes.sphere, shapes.box, shapes.cylinder, shapes.cone, shapes.torus, shapes.capsule]
    mesh = makers[random.integers(6)]()
    random_material(mesh, random)
    return mesh


BUILTIN: dict[str, Callable[[np.random.Generator], Mesh]] = {"drone": drone, "shapes": simple_shape}


def sky(random: np.random.Generator, height: int = 128) -> Environment:
    """An equirectangular sky: gradient, sun, clouds of smooth noise, ground."""
    width = 2 * height
    elevation = (0.5 - (np.arange(height) + 0.5) / height) * np.pi
    azimuth = (np.arange(width) + 0.5) / width * 2 * np.pi
    up = np.sin(elevation)[:, None] * np.ones(width)
    direction = np.stack([np.cos(elevation)[:, None] * np.sin(azimuth), up, np.cos(elevation)[:, None] * np.cos(azimuth)], -1)
    zenith = np.array([0.15, 0.35, 0.85]) * random.uniform(0.5, 1.3)
    horizon = np.array([0.75, 0.82, 0.9]) * random.uniform(0.7, 1.2) * (1, *random.uniform(0.8, 1, 2))
    picture = horizon + (zenith - horizon) * np.clip(up, 0, 1)[..., None] ** 0.5
    cloud = sum(_noise(random, width, height, 2**k) / 2**k for k in range(2, 6)) * 4
    cover = np.clip((cloud - random.uniform(-0.4, 1.2)) * 2, 0, 1) * np.clip(up * 4, 0, 1)
    picture += (np.array([1.0, 1.0, 1.02]) * random.uniform(0.6, 1.2) - picture) * cover[..., None]
    ground = random.uniform(0.05, 0.3) * random.uniform(0.8, 1.2, 3)
    picture = np.where(up[..., None] < 0, ground + (horizon - ground) * np.exp(up * 8)[..., None], picture)
    sun_up, sun_turn = np.radians(random.uniform(10, 70)), random.uniform(0, 2 * np.pi)
    sun = np.array([np.cos(sun_up) * np.sin(sun_turn), np.sin(sun_up), np.cos(sun_up) * np.cos(sun_turn)])
    strength = random.uniform(5, 60) if random.random() < 0.7 else 0
    picture += strength * np.exp((direction @ sun - 1) * 1500)[..., None] * (1, 0.95, 0.85)
    return Environment(np.ascontiguousarray(picture, dtype=np.float32))


def _noise(random: np.random.Generator, width: int, height: int, cells: int) -> NDArray[Any]:
    """Values in -1 .. 1 at grid points, interpolated smoothly; periodic around the horizon."""
    grid = random.uniform(-1, 1, (cells + 1, 2 * cells))
    y, x = np.linspace(0, cells, height, endpoint=False), np.linspace(0, 2 * cells, width, endpoint=False)
    y0, x0 = y.astype(int), x.astype(int)
    v, u = (y - y0)[:, None], x - x0
    u, v = u * u * (3 - 2 * u), v * v * (3 - 2 * v)
    x1 = (x0 + 1) % (2 * cells)
    top = grid[y0][:, x0] * (1 - u) + grid[y0][:, x1] * u
    bottom = grid[y0 + 1][:, x0] * (1 - u) + grid[y0 + 1][:, x1] * u
    return top * (1 - v) + bottom * v

#!/usr/bin/python3
"""Make a scene of 3D Gaussian splats of degree 3 and write it as PLY; the easypbr package must be importable.

usage: make_splats.py SPLATS OUT.ply
A ball on a chequered floor, covered by flat splats whose size goes with their number as in a trained scene, so that
about as many are before each other in a pixel. 1 M splats take 240 MB. Times of a frame:
bench_frames OUT.ply 20 ENVIRONMENT.hdr 1280x720 background.mode=color
"""
import sys

import numpy as np

import easypbr


def facing(normals):
    """Quaternions w, x, y, z that turn the z axis to unit normals."""
    quaternions = np.stack([1 + normals[:, 2], -normals[:, 1], normals[:, 0], 0 * normals[:, 0]], 1)
    quaternions[quaternions[:, 0] < 1e-6] = (0, 1, 0, 0)
    return quaternions


def scene(count, seed=1):
    """A mesh of `count` splats."""
    random = np.random.default_rng(seed)
    ball = random.normal(size=(count // 2, 3))
    ball /= np.linalg.norm(ball, axis=1, keepdims=True)
    floor = random.uniform(-3, 3, (count - len(ball), 3))
    floor[:, 1] = -1 + 0.01 * random.normal(size=len(floor))
    normals = np.concatenate([ball, np.tile([0.0, 1, 0], (len(floor), 1))])
    size = np.sqrt(36 / count) * np.exp(random.normal(-0.3, 0.5, (count, 1)))
    scales = np.concatenate([size, size * random.uniform(0.2, 1, (count, 1)), 0.05 * size], 1)
    light = (np.floor(floor[:, :1]) + np.floor(floor[:, 2:])) % 2 == 0
    colors = np.concatenate([0.5 + 0.4 * np.sin(5 * ball), np.where(light, [0.85, 0.8, 0.75], [0.35, 0.4, 0.45])])
    sh = random.normal(scale=0.03, size=(count, 16, 3))
    sh[:, 0] = (colors - 0.5) / 0.28209479
    opacities = random.beta(4, 1, count)
    return easypbr.splats(np.concatenate([ball, floor]), scales, facing(normals), opacities, sh)


if __name__ == "__main__":
    scene(int(sys.argv[1])).save(sys.argv[2])
    print(f"{sys.argv[2]}: {sys.argv[1]} splats")

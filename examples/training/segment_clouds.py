#!/usr/bin/env python3
"""Trains a network to tell the parts of clouds, and shows what it says: balls, boxes and the ground that they are on.

usage: segment_clouds.py [--steps N]
Writes segmentation.png: a new cloud in the colours of the predicted labels. Needs PyTorch; half a minute on a CPU.
"""
import argparse
from typing import Any

import numpy as np
from numpy.typing import NDArray
import torch

from easypbr import LabelMap, Mesh, Scene, Viewer, eigen2tensor, tensor2eigen

NAMES = ("ground", "ball", "box")


def cloud(random: np.random.Generator, count: int = 1024) -> tuple[NDArray[Any], NDArray[Any]]:
    """Points with noise on a ground, a ball on its one half and a box on the other, and their labels."""
    labels = random.integers(0, 3, count)
    ball, box = np.array([0.5, 0.3, 0]), np.array([-0.5, 0.25, 0])
    ball[[0, 2]] += random.uniform(-0.15, 0.15, 2)
    box[[0, 2]] += random.uniform(-0.15, 0.15, 2)
    points = random.uniform(-1, 1, (count, 3)) * (1, 0, 1)
    direction = random.normal(size=(count, 3))
    on_ball = ball + 0.3 * direction / np.linalg.norm(direction, axis=1, keepdims=True)
    cube = random.uniform(-1, 1, (count, 3))
    cube /= np.abs(cube).max(axis=1, keepdims=True)
    points[labels == 1], points[labels == 2] = on_ball[labels == 1], (box + 0.25 * cube)[labels == 2]
    return (points + random.normal(scale=0.005, size=points.shape)).astype(np.float32), labels


def layer(before: int, after: int) -> torch.nn.Sequential:
    return torch.nn.Sequential(torch.nn.Linear(before, after), torch.nn.ReLU())


class PointNet(torch.nn.Module):
    """A feature of each point beside the largest of all points' (Qi et al. 2017)."""

    def __init__(self, width: int = 64) -> None:
        super().__init__()
        self.point = torch.nn.Sequential(layer(3, width), layer(width, width))
        self.all = layer(width, width)
        self.head = torch.nn.Sequential(layer(2 * width, width), torch.nn.Linear(width, len(NAMES)))

    def forward(self, points: torch.Tensor) -> torch.Tensor:
        own = self.point(points)
        whole = self.all(own).amax(dim=-2, keepdim=True).expand_as(own)
        scores: torch.Tensor = self.head(torch.cat([own, whole], dim=-1))
        return scores


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=int, default=150)
    steps = parser.parse_args().steps
    torch.manual_seed(0)
    random = np.random.default_rng(0)
    net = PointNet()
    optimizer = torch.optim.Adam(net.parameters(), 3e-3)
    for _ in range(steps):
        batch = [cloud(random) for _ in range(4)]
        points, labels = torch.from_numpy(np.stack([b[0] for b in batch])), torch.from_numpy(np.stack([b[1] for b in batch]))
        loss = torch.nn.functional.cross_entropy(net(points).flatten(0, 1), labels.flatten())
        optimizer.zero_grad()
        torch.autograd.backward(loss)
        optimizer.step()

    new_points, true_labels = cloud(np.random.default_rng(1), 6000)
    shown = Mesh()
    shown.V = new_points
    shown.label_map = LabelMap(NAMES)
    shown.L = tensor2eigen(net(eigen2tensor(shown.V)).argmax(-1))
    print(f"{(shown.L == true_labels).mean():.3f} of the points are right")
    scene = Scene()
    scene.show(shown, "cloud")
    view = Viewer((640, 480), {"camera.elevation_deg": 25.0, "style.point_size": 4.0}, scene)
    view.recorder.record("segmentation.png")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Trains a detector on a generated set of drones, and draws what it finds in pictures that it has not seen.

usage: detect_drones.py [--pictures N] [--steps N] [--data FOLDER]
Generates the set in FOLDER (drones), or goes on with what is there. Writes detection.png: found boxes in orange with their
scores as bars, true ones in white. Needs PyTorch; about a minute on two cores.
"""
import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
import torch
from torch.nn import functional

from easypbr import load_image, save_image
from easypbr.dataset import DatasetSpec, ImageSpec, generate

SIZE, STRIDE, HELD_OUT = (320, 240), 16, 32


#: Pictures and their boxes, n x 4: x0, y0, x1, y1.
Data = list[tuple[NDArray[Any], NDArray[Any]]]
#: Scores and boxes.
Found = list[tuple[float, NDArray[Any]]]


def make_set(folder: Path, pictures: int) -> Data:
    """Pictures and their boxes (x0, y0, x1, y1), as any COCO set is read."""
    spec = DatasetSpec.demo()
    spec.count, spec.image, spec.writers = pictures, ImageSpec(SIZE, 2), ("coco",)
    spec.background.skies = 12
    generate(spec, folder, quiet=False)
    coco = json.loads((folder / "annotations.json").read_text())
    boxes: dict[int, list[tuple[float, ...]]] = {image["id"]: [] for image in coco["images"]}
    for annotation in coco["annotations"]:
        x, y, w, h = annotation["bbox"]
        boxes[annotation["image_id"]].append((x, y, x + w, y + h))
    return [(load_image(folder / image["file_name"])[..., :3], np.array(boxes[image["id"]], float).reshape(-1, 4))
            for image in coco["images"]]


class Detector(torch.nn.Module):
    """For each cell of the picture: is a drone's middle here, and how far from it are the sides? (Tian et al. 2019)"""

    def __init__(self, width: int = 24) -> None:
        super().__init__()
        layers: list[torch.nn.Module] = []
        before = 3
        for channels, step in ((width, 2), (2 * width, 2), (3 * width, 2), (4 * width, 2), (4 * width, 1), (4 * width, 1)):
            layers += [torch.nn.Conv2d(before, channels, 3, step, 1, bias=False), torch.nn.BatchNorm2d(channels), torch.nn.ReLU()]
            before = channels
        self.body = torch.nn.Sequential(*layers)
        self.head = torch.nn.Conv2d(before, 5, 1)
        with torch.no_grad():
            self.head.get_parameter("bias")[0] = -3.0  # Most cells hold nothing.

    def forward(self, pictures: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        found = self.head(self.body(pictures))
        return found[:, 0], found[:, 1:].permute(0, 2, 3, 1)


def cells() -> NDArray[Any]:
    """Middles of the cells, rows x columns x 2 (x, y)."""
    return np.stack(np.meshgrid(*((np.arange(side // STRIDE) + 0.5) * STRIDE for side in SIZE)), -1)


def targets(boxes: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Which cells lie near the middle of a box, and the logarithms of their distances to its sides, in cells."""
    middles = cells()
    is_drone, sides = np.zeros(middles.shape[:2], np.float32), np.zeros((*middles.shape[:2], 4), np.float32)
    for box in sorted(boxes, key=lambda b: -(b[2] - b[0]) * (b[3] - b[1])):  # The smallest box has the last word.
        middle, half = (box[:2] + box[2:]) / 2, (box[2:] - box[:2]) / 2
        near = (np.abs(middles - middle) <= np.maximum(half * 0.35, STRIDE / 2)).all(-1)
        is_drone[near] = 1
        distances = np.concatenate([middles[near] - box[:2], box[2:] - middles[near]], -1)
        sides[near] = np.log(np.maximum(distances, 1) / STRIDE)
    return is_drone, sides


def as_input(pictures: list[NDArray[Any]]) -> torch.Tensor:
    batch: torch.Tensor = torch.from_numpy(np.stack(pictures)).permute(0, 3, 1, 2).float() / 127.5 - 1
    return batch


def train(net: Detector, data: Data, steps: int, random: np.random.Generator) -> None:
    optimizer = torch.optim.AdamW(net.parameters(), 3e-3)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimizer, 4e-3, total_steps=steps)
    for _ in range(steps):
        pictures, answers = [], []
        for i in random.integers(0, len(data), 8):
            picture, boxes = data[i]
            if random.random() < 0.5:
                picture, boxes = picture[:, ::-1], (boxes * (-1, 1, -1, 1) + (SIZE[0], 0, SIZE[0], 0))[:, [2, 1, 0, 3]]
            pictures.append(picture)
            answers.append(targets(boxes))
        scores, sides = net(as_input(pictures))
        is_drone, right_sides = (torch.from_numpy(np.stack(part)) for part in zip(*answers))
        # Focal loss (Lin et al. 2017): cells that are easy count little.
        plain = functional.binary_cross_entropy_with_logits(scores, is_drone, reduction="none")
        loss = (1 - plain.neg().exp()).square().mul(plain).sum().div(8)
        if is_drone.any():
            loss = loss + functional.smooth_l1_loss(sides[is_drone > 0], right_sides[is_drone > 0])
        optimizer.zero_grad()
        torch.autograd.backward(loss)
        optimizer.step()
        schedule.step()


def overlap(box: NDArray[Any], others: NDArray[Any]) -> NDArray[Any]:
    """Intersection over union."""
    sides = np.minimum(box[2:], others[:, 2:]) - np.maximum(box[:2], others[:, :2])
    both = np.prod(np.maximum(sides, 0), -1)
    either = np.prod(box[2:] - box[:2]) + np.prod(others[:, 2:] - others[:, :2], -1) - both
    return np.asarray(both / either)


def detect(net: Detector, picture: NDArray[Any], least: float = 0.05) -> Found:
    """Scores and boxes, the best first; of those that overlap the best."""
    with torch.no_grad():
        scores, sides = net(as_input([picture]))
    scores, sides = torch.sigmoid(scores[0]).numpy(), sides[0].exp().numpy() * STRIDE
    boxes = np.concatenate([cells() - sides[..., :2], cells() + sides[..., 2:]], -1)
    found: Found = []
    for i in np.argsort(-scores.ravel()):
        score, box = scores.flat[i], boxes.reshape(-1, 4)[i]
        if score < least:
            break
        if not found or overlap(box, np.array([other for _, other in found])).max() < 0.4:
            found.append((float(score), box))
    return found


def average_precision(results: list[Found], truth: list[NDArray[Any]], least_overlap: float = 0.5) -> float:
    """Area under precision over recall; a true box counts once."""
    guesses = sorted(((score, i, box) for i, found in enumerate(results) for score, box in found), key=lambda g: -g[0])
    taken: list[set[int]] = [set() for _ in truth]
    hit: list[bool] = []
    for _, i, box in guesses:
        shares = overlap(box, truth[i]) if len(truth[i]) else np.zeros(1)
        best = int(np.argmax(shares))
        hit.append(bool(shares[best] >= least_overlap) and best not in taken[i])
        if hit[-1]:
            taken[i].add(best)
    hits = np.cumsum(hit)
    precision = hits / np.arange(1, len(hits) + 1)
    recall = np.concatenate([[0], hits / max(1, sum(map(len, truth)))])
    best_from_here = np.maximum.accumulate(precision[::-1])[::-1]
    return float((np.diff(recall) * best_from_here).sum())


def drawn(picture: NDArray[Any], boxes: NDArray[Any], found: Found) -> NDArray[Any]:
    picture = picture.copy()

    def frame(box: ArrayLike, color: tuple[int, int, int], thick: int) -> None:
        x0, y0, x1, y1 = np.clip(np.rint(box), 0, (*SIZE, *SIZE)).astype(int)
        for rows, columns in (((y0, y0 + thick), (x0, x1)), ((y1 - thick, y1), (x0, x1)),
                              ((y0, y1), (x0, x0 + thick)), ((y0, y1), (x1 - thick, x1))):
            picture[max(rows[0], 0) : rows[1], max(columns[0], 0) : columns[1]] = color

    for box in boxes:
        frame(box, (255, 255, 255), 1)
    for score, box in found:
        if score > 0.3:
            frame(box, (240, 120, 20), 2)
            frame((box[0], box[1] - 5, box[0] + score * (box[2] - box[0]), box[1] - 2), (240, 120, 20), 3)
    return picture


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pictures", type=int, default=160)
    parser.add_argument("--steps", type=int, default=150)
    parser.add_argument("--data", type=Path, default=Path("drones"))
    arguments = parser.parse_args()
    torch.manual_seed(0)
    data = make_set(arguments.data, arguments.pictures)
    # Frames do not depend on each other: the last ones are as good as any to be kept for the test.
    held_out = data[-max(4, min(HELD_OUT, len(data) // 4)) :]
    net = Detector()
    train(net, data[: -len(held_out)], arguments.steps, np.random.default_rng(0))
    net.eval()
    results = [detect(net, picture) for picture, _ in held_out]
    precision = average_precision(results, [boxes for _, boxes in held_out])
    print(f"average precision {precision:.3f} at an overlap of a half, on {len(held_out)} pictures that it has not seen")
    shown = [drawn(picture, boxes, found) for (picture, boxes), found in zip(held_out, results)]
    save_image(np.concatenate([np.concatenate(shown[i : i + 2], 1) for i in (0, 2)]), "detection.png")


if __name__ == "__main__":
    main()

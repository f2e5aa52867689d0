#!/usr/bin/env python3
"""Boxes on a synthetic drone, as figure 7 of the paper has them: the box in the picture and the box in space.

usage: figure_07_drone_boxes.py [--count N] [--seed N]
Writes drone_boxes.png: N pictures of the built-in data set side by side, annotations drawn over them.
"""
import argparse

import numpy as np

from easypbr import save_image
from easypbr.dataset import DatasetSpec, ImageSpec, ObjectSpec, PlacementSpec, SensorSpec
from easypbr.dataset.frames import FrameMaker
from easypbr.dataset.report import draw_annotations


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=3)
    parser.add_argument("--seed", type=int, default=3)
    arguments = parser.parse_args()
    spec = DatasetSpec(
        seed=arguments.seed,
        image=ImageSpec((480, 480), samples=16),
        objects=[ObjectSpec(class_name="drone", size=(1.0, 1.2), tilt_deg=20.0)],
        placement=PlacementSpec(distance=(1.6, 2.4), margin=0.35),
        sensor=SensorSpec(),
    )
    maker = FrameMaker(spec)
    frames = [maker.make(index) for index in range(arguments.count)]
    pictures = [draw_annotations(frame.picture, frame.objects, edges=True) for frame in frames]
    save_image(np.concatenate(pictures, axis=1), "drone_boxes.png")


if __name__ == "__main__":
    main()

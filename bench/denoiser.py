#!/usr/bin/env python3
"""What the denoiser leaves of the noise of few samples, as a table in Markdown.

Path traced pictures of each mesh are compared with one of many samples that is not denoised, all else equal: a pixel's
difference is that of its furthest channel, in codes of 8 bits.
"""
import argparse
import pathlib

import numpy as np

from easypbr import Mesh, Scene, Viewer

MUCH = 16  #: codes of 8 bits


def picture(mesh: Mesh, size: tuple[int, int], samples: int, denoise: str) -> np.ndarray:
    scene = Scene()
    scene.show(mesh, "mesh")
    view = Viewer(size, {"path": {"enabled": True, "denoise": denoise}, "image": {"noise": 0}}, scene)
    return np.asarray(view.render(samples=samples))[..., :3].astype(float)


def differences(shown: np.ndarray, reference: np.ndarray) -> np.ndarray:
    return np.abs(shown - reference).max(axis=-1)


def side_lengths(text: str) -> tuple[int, int]:
    width, height = text.split("x")
    return int(width), int(height)


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="+", metavar="MESH", help="mesh files")
    parser.add_argument("--samples", type=int, nargs="+", default=[2, 8, 32], metavar="N", help="default: 2 8 32")
    parser.add_argument("--reference", type=int, default=400, metavar="N", help="samples of the reference; default: 400")
    parser.add_argument("--size", type=side_lengths, default=(300, 300), metavar="WIDTHxHEIGHT", help="default: 300x300")
    parser.add_argument("--denoise", choices=["filter", "oidn", "off"], default="filter", help="default: filter (built in)")
    return parser.parse_args()


def main() -> None:
    given = arguments()
    print(f"| mesh | samples | RMSE | pixels off by more than {MUCH} |")
    print("|---|---|---|---|")
    for file in given.meshes:
        mesh = Mesh(file)
        reference = picture(mesh, given.size, given.reference, "off")
        for samples in given.samples:
            off = differences(picture(mesh, given.size, samples, given.denoise), reference)
            rmse, much = np.sqrt(np.mean(off**2)), np.mean(off > MUCH)
            print(f"| {pathlib.Path(file).stem} | {samples} | {rmse:.2f} | {100 * much:.2f} % |", flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""How far pictures are from the truth: mean FLIP of EasyPBR by default and of rasterisers, from Mitsuba 3 with many samples.

usage: light_peers.py --data FOLDER [--keep FOLDER] [--work FOLDER] [SCENE...]
FOLDER holds head.obj, env/monument_valley.hdr and env/studio.hdr. `make bench-light-peers` installs what it needs.

The twelve scenes of bench/light.py. All get the same meshes, materials, camera, environment and lamps; what a rasteriser cannot do its
script says. Its pictures are averages of 4 x 4 pixels, without a tone curve. It is drawn in several ways, such as with and without
occlusion, shadows, and ambient light in closed rooms, and the way that is nearest to the reference counts, at the exposure that makes
it nearest. EasyPBR's is one picture of 8 samples, denoised. --keep writes all pictures as PNG; --work keeps references between runs.
"""
import argparse
import os
import pathlib
import tempfile

import cv2
import light
import light_scenes
import numpy as np

PEERS = {"VTK": "vtk", "F3D": "f3d", "Open3D": "open3d"}
EXPOSURES = 2.0 ** np.linspace(-1, 1, 9)


def nearest(reference, pictures, exposures):
    """(FLIP, exposure, what it was drawn with, picture) of the pictures of a program."""
    shown = ((exposure, how, light_scenes.displayed(picture, exposure)) for how, picture in pictures.items() for exposure in exposures)
    return min(((light.flip(reference, picture), exposure, how, picture) for exposure, how, picture in shown), key=lambda found: found[0])


def write_png(path, picture):
    cv2.imwrite(str(path), np.rint(picture[:, :, ::-1] * 255).astype(np.uint8))


def compare(folder, name, setup, keep):
    """A row of the table, in words what was nearest, and EasyPBR's number."""
    halves = np.load(folder / f"reference {name}.npy")
    reference, *parts = (light_scenes.displayed(picture, setup.exposure) for picture in (halves.mean(0), *halves))
    found = {"EasyPBR": nearest(reference, np.load(folder / f"default {name}.npy", allow_pickle=True).item(), [1.0])}
    for peer, file in PEERS.items():
        found[peer] = nearest(reference, np.load(folder / f"{file} {name}.npy", allow_pickle=True).item(), EXPOSURES)
    if keep:
        for program, picture in {"Mitsuba": reference, **{program: best[3] for program, best in found.items()}}.items():
            write_png(keep / f"{name}, {program}.png", picture)
    cells = " | ".join(f"{best[0]:.3f}" for best in found.values())
    words = "; ".join(f"{program}: {how}, exposure {exposure:.2f}" for program, (_, exposure, how, _) in list(found.items())[1:])
    return f"| {name} | {cells} | {light.flip(*parts):.3f} |", f"{name}: {words}", found["EasyPBR"][0]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    folder = os.environ.get("EASYPBR_TEST_DATA")
    parser.add_argument("--data", type=pathlib.Path, default=folder, required=not folder)
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("--work", type=pathlib.Path)
    parser.add_argument("scenes", nargs="*", help="names of the table; all without any")
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        work = chosen.work or pathlib.Path(temporary)
        for made in filter(None, (chosen.work, chosen.keep)):
            made.mkdir(parents=True, exist_ok=True)
        light.run(".venv", "light_easypbr.py", "--setups", work, chosen.data, *chosen.scenes)
        light.run(".venv", "light_easypbr.py", "--default", work)
        light.run(".venv-oracle", "light_mitsuba.py", "--references", work, MITSUBA_VARIANT="llvm_ad_rgb")
        for file in PEERS.values():
            light.run(".venv-bench", f"light_{file}.py", work)
        print(f"| scene | EasyPBR | {' | '.join(PEERS)} | FLIP between halves of the reference |\n|---|---|---|---|---|---|")
        drawn_with, ours = [], []
        for name, setup in light_scenes.read_all(work).items():
            row, words, flip = compare(work, name, setup, chosen.keep)
            print(row, flush=True)
            drawn_with.append(words)
            ours.append(flip)
        print(f"| mean of {len(ours)} | {np.mean(ours):.3f} |")
        print("\n" + "\n".join(drawn_with))


if __name__ == "__main__":
    main()

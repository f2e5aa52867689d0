#!/usr/bin/env python3
"""What light costs: CPU seconds until pictures are within a mean FLIP of 0.05 of their limit, beside Mitsuba 3 in the same run.

usage: light.py --data FOLDER [SCENE...]
FOLDER holds head.obj, env/monument_valley.hdr and env/studio.hdr. `make bench-light` installs what it needs.

Twelve scenes of 256 x 192 pixels, paths of up to 8 reflections. Each renderer's pictures are compared with its own mean of many samples:
what the two limits differ by, which is their materials, is a column of its own. Seconds are those of the process from the second
picture on, so that neither loading nor compiling counts; of Mitsuba's variants scalar_rgb and llvm_ad_rgb the quicker one.
"""
import argparse
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import flip_evaluator
import light_scenes
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[1]
ASKED = 0.05
VARIANTS = ("scalar_rgb", "llvm_ad_rgb")


def flip(a, b):
    return float(flip_evaluator.evaluate(a, b, "LDR", inputsRGB=True, applyMagma=False, parameters={"ppd": 67.0})[1])


def seconds_to(points):
    """Of (seconds, FLIP) by samples: where the error falls below what is asked, between two by a power law."""
    for before, after in zip([None, *points], points):
        if after[1] <= ASKED:
            if before is None or before[1] <= after[1]:
                return after[0]
            part = math.log(before[1] / ASKED) / math.log(before[1] / after[1])
            return before[0] * (after[0] / before[0]) ** part
    return math.inf


def curve_of(pictures, setup, limit, denoise):
    """(seconds, FLIP) by samples."""
    return [(seconds, flip(limit, light_scenes.displayed(picture, setup.exposure)))
            for (samples, how), (picture, seconds) in pictures.items() if samples and how == denoise]


def compare(folder, name, setup):
    """A row of the table."""
    def read(renderer):
        return np.load(folder / f"{renderer} {name}.npy", allow_pickle=True).item()

    ours, theirs = read("easypbr"), {variant: read(variant) for variant in VARIANTS}
    limit, their_limit = (light_scenes.displayed(pictures[0, "off"][0], setup.exposure)
                          for pictures in (ours, theirs["llvm_ad_rgb"]))
    denoised = curve_of(ours, setup, limit, "filter")
    of_noisy, of_denoised = seconds_to(curve_of(ours, setup, limit, "off")), seconds_to(denoised)
    of_theirs = min(seconds_to(curve_of(pictures, setup, their_limit, "off")) for pictures in theirs.values())
    seconds, error = denoised[3]  # of 8 samples
    return (f"| {name} | {error:.3f} | {seconds:.2f} | {of_noisy:.2f} | {of_denoised:.2f} | {of_theirs:.2f} "
            f"| {of_noisy / of_theirs:.2f} | {of_denoised / of_theirs:.2f} | {flip(their_limit, limit):.3f} |")


def run(python, script, *arguments, **environment):
    command = [ROOT / python / "bin/python", ROOT / "bench" / script, *arguments]
    if subprocess.run(command, env={**os.environ, **environment}).returncode:
        sys.exit(f"{script} failed")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    folder = os.environ.get("EASYPBR_TEST_DATA")
    parser.add_argument("--data", type=pathlib.Path, default=folder, required=not folder)
    parser.add_argument("scenes", nargs="*", help="names of the table; all without any")
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as work:
        run(".venv", "light_easypbr.py", "--setups", work, chosen.data, *chosen.scenes)
        run(".venv", "light_easypbr.py", work)
        for variant in VARIANTS:
            run(".venv-oracle", "light_mitsuba.py", work, MITSUBA_VARIANT=variant)
        print(f"| scene | FLIP of 8 samples, denoised | CPU s | CPU s to {ASKED}: noisy | denoised | Mitsuba | noisy / Mitsuba "
              "| denoised / Mitsuba | FLIP between the limits |\n|---|---|---|---|---|---|---|---|---|")
        for name, setup in light_scenes.read_all(pathlib.Path(work)).items():
            print(compare(pathlib.Path(work), name, setup), flush=True)


if __name__ == "__main__":
    main()

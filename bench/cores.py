#!/usr/bin/env python3
"""What more cores give: frames and a still on the CPU with one thread and with all cores, in turns.

usage: cores.py [--data FOLDER] [--rounds N]
FOLDER holds nefertiti.obj, env/studio.hdr and DamagedHelmet/DamagedHelmet.gltf; by default $EASYPBR_TEST_DATA. Prints a row for
each: seconds with one thread, how many times faster all cores are, the part that is serial by Amdahl's law
(1 / speedup = serial + (1 - serial) / cores), and what the law says of 16 and 64 cores. Needs bench_frames and easypbr in build/.
"""
import argparse
import json
import os
import pathlib
import re
import statistics
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
CORES = len(os.sched_getaffinity(0))


def run(threads, *command):
    environment = {**os.environ, "EASYPBR_DEVICE": "cpu", "EASYPBR_THREADS": str(threads)}
    done = subprocess.run([*map(str, command)], capture_output=True, text=True, env=environment, check=True)
    return done.stdout + done.stderr


def frame_seconds(threads, *arguments):
    return json.loads(run(threads, ROOT / "build/bench_frames", *arguments))["frame_ms_median"] / 1000


def still_seconds(threads, file, folder):
    printed = run(threads, ROOT / "build/easypbr", "render", file, "-o", folder / "still.png", "--size", "1280x720", "--timing")
    return float(re.search(r"draw ([\d.]+) s", printed)[1])


def law(serial, cores):
    return 1 / (serial + (1 - serial) / cores)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=pathlib.Path, default=os.environ.get("EASYPBR_TEST_DATA"))
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    if options.data is None:
        parser.error("--data is missing, and $EASYPBR_TEST_DATA is not set")
    if CORES < 2:
        parser.error("there is one core: nothing to compare")
    head, studio = options.data / "nefertiti.obj", options.data / "env/studio.hdr"
    helmet = options.data / "DamagedHelmet/DamagedHelmet.gltf"
    effects = ["shadows.enabled=true", "ssao.enabled=true", "bloom.enabled=true", "ground.mode=shadow"]
    with tempfile.TemporaryDirectory() as folder:
        cases = {
            "frame: head of 0.4 M faces": lambda n: frame_seconds(n, head, 15, studio, "1920x1080", "ssao.enabled=false"),
            "frame: head, shadows, occlusion, bloom, ground": lambda n: frame_seconds(n, head, 10, studio, "1920x1080", *effects),
            "frame: DamagedHelmet": lambda n: frame_seconds(n, helmet, 15, studio, "1920x1080", "ssao.enabled=false"),
            "still: DamagedHelmet, 8 samples, 1280x720": lambda n: still_seconds(n, helmet, pathlib.Path(folder)),
        }
        print(f"| | one thread | {CORES} cores | serial part | 16 cores | 64 cores |\n|---|---|---|---|---|---|")
        for name, measure in cases.items():
            rounds = [(measure(1), measure(CORES)) for _ in range(options.rounds)]
            speedup = statistics.median(one / many for one, many in rounds)
            serial = max((1 / speedup - 1 / CORES) / (1 - 1 / CORES), 0)
            print(f"| {name} | {statistics.median(one for one, _ in rounds):.3f} s | {speedup:.2f} x | {100 * serial:.1f} % "
                  f"| {law(serial, 16):.1f} x | {law(serial, 64):.1f} x |", flush=True)


if __name__ == "__main__":
    main()

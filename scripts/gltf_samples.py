#!/usr/bin/env python3
"""Draws all models of a checkout of Khronos' glTF-Sample-Assets, and says how each went, as a table in Markdown.

Each variant of a model is drawn at 320x240 in raster mode, animated ones half a second after their start. A variant is
"drawn", "drawn, with a warning" or "refused"; the warning or error stands beside it. The pictures are left in OUTPUT to be
looked at. The exit status is 1 when a process was killed by a signal or took longer than five minutes, which no file may do.

usage: gltf_samples.py FOLDER OUTPUT [MODEL...]
"""
import argparse
import json
import pathlib
import subprocess
import sys

LONGEST_S = 300


def files_of(folder: pathlib.Path, models: list[str]) -> list[pathlib.Path]:
    files = sorted(path for ending in ("gltf", "glb") for path in folder.glob(f"*/*/*.{ending}"))
    return [path for path in files if not models or path.parent.parent.name in models]


def is_animated(program: str, file: pathlib.Path) -> bool:
    done = subprocess.run([program, "info", "--json", file], capture_output=True, text=True, timeout=LONGEST_S)
    return done.returncode == 0 and bool(json.loads(done.stdout).get("animations"))


def draw(program: str, file: pathlib.Path, output: pathlib.Path) -> tuple[str, str]:
    """How it went, and what was said."""
    command = [program, "render", file, "-o", output, "--size", "320x240", "--mode", "raster"]
    try:
        if is_animated(program, file):
            command += ["--animation", "0", "--animation-time", "0.5"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=LONGEST_S)
    except subprocess.TimeoutExpired:
        return "hung", ""
    said = "; ".join(line.partition(": ")[2] for line in done.stderr.splitlines())
    if done.returncode < 0:
        return f"killed by signal {-done.returncode}", said
    if done.returncode:
        return "refused", said
    return ("drawn, with a warning" if said else "drawn"), said


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("folder", type=pathlib.Path, help="Models/ of the checkout")
    parser.add_argument("output", type=pathlib.Path, help="folder of the pictures")
    parser.add_argument("models", nargs="*", help="only these")
    parser.add_argument("--program", default="build/easypbr")
    options = parser.parse_args()
    files = files_of(options.folder, options.models)
    if not files:
        print(f"{options.folder}: no MODEL/VARIANT/FILE.gltf in it", file=sys.stderr)
        return 2
    options.output.mkdir(parents=True, exist_ok=True)
    print("| Model | Variant | Result | Said |\n|---|---|---|---|")
    broken = False
    for file in files:
        name, variant = file.parent.parent.name, file.parent.name
        result, said = draw(options.program, file, options.output / f"{name}-{variant}.png")
        broken |= result.startswith(("killed", "hung"))
        print(f"| {name} | {variant} | {result} | {said} |", flush=True)
    return int(broken)


if __name__ == "__main__":
    sys.exit(main())

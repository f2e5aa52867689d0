#!/usr/bin/env python3
"""What part of the lines of io the fuzzer covered, from the JSON of `llvm-cov export -summary-only` on standard input.

Left out is what reads nothing that comes from anywhere: writers, videos, folders of files, and the other side of processes.
"""
import json
import re
import sys

LEFT_OUT = re.compile(r"writer|/glb_|npy_builder|vertex_rows|splat_row_parts|/video/|/settings/presets|child_process|module_loader|assimp_loader|mesh_queue|_draco")
LEAST = 0.9


def main() -> None:
    files = json.load(sys.stdin)["data"][0]["files"]
    lines = {file["filename"].rpartition("src/easypbr/")[2]: file["summary"]["lines"] for file in files}
    read = {name: (count["covered"], count["count"]) for name, count in lines.items()
            if name.startswith("io/") and not LEFT_OUT.search(name)}
    covered, count = (sum(numbers) for numbers in zip(*read.values()))
    print(f"{covered} of {count} lines of the readers of io: {100 * covered / count:.1f} %")
    for name, (covered, count) in sorted(read.items(), key=lambda item: item[1][0] / item[1][1]):
        if covered < LEAST * count:
            print(f"  {100 * covered / count:5.1f} %  {count - covered:4d} lines missed  {name}")


if __name__ == "__main__":
    main()

"""Writes src/easypbr/scene/colormap_tables.inc: the colour tables that are data, as matplotlib publishes them.

usage: write_colormaps.py > src/easypbr/scene/colormap_tables.inc
"""
from __future__ import annotations

import matplotlib
import numpy

ORIGINS = {
    "viridis": "Smith, van der Walt and Firing 2015, CC0-1.0",
    "plasma": "Smith and van der Walt 2015, CC0-1.0",
    "inferno": "Smith and van der Walt 2015, CC0-1.0",
    "magma": "Smith and van der Walt 2015, CC0-1.0",
    "turbo": "Mikhailov 2019, Copyright 2019 Google LLC, Apache-2.0 (LICENSES/Apache-2.0.txt)",
    "cividis": "Nunez, Anderton and Renslow 2018, doi 10.1371/journal.pone.0199239",
}
ENTRIES_PER_LINE = 16


def hex_lines(name: str) -> list[str]:
    table = numpy.array(matplotlib.colormaps[name].colors)
    codes = ["".join(f"{c:02x}" for c in entry) for entry in numpy.rint(table * 255).astype(int)]
    assert len(codes) == 256
    return ["".join(codes[i : i + ENTRIES_PER_LINE]) for i in range(0, 256, ENTRIES_PER_LINE)]


def main() -> None:
    print("// 256 sRGB entries rrggbb each, written by scripts/write_colormaps.py.")
    for name, origin in ORIGINS.items():
        print(f"\n// {origin}")
        print(f"constexpr std::string_view {name}_table =")
        print("\n".join(f'    "{line}"' for line in hex_lines(name)) + ";")


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Make a terrain of coloured points and write it as PLY and as PCD, both binary.

usage: make_large_cloud.py POINTS OUT
Writes OUT.ply (float x y z, uchar red green blue) and OUT.pcd (float x y z rgb): hills of several sizes, coloured by
height and slope, on a square of 1 km, the points scattered as a scanner's are. 10 M points take 10 s and 2 GB.
"""
import sys

import numpy as np


def terrain(count, seed=1):
    """Positions (float32) and colours (uint8) of points."""
    random = np.random.default_rng(seed)
    x, y = random.random((2, count), np.float32) * 1000
    z, slope = np.zeros(count, np.float32), np.zeros(count, np.float32)
    for wavelength, height in ((700, 60), (230, 18), (71, 5), (19, 1.2), (5, 0.3)):
        angle = random.random() * 2 * np.pi
        phase = (np.cos(angle) * x + np.sin(angle) * y) * np.float32(2 * np.pi / wavelength)
        other = (np.sin(angle) * x - np.cos(angle) * y) * np.float32(2 * np.pi / wavelength * 0.8)
        z += height * np.sin(phase) * np.cos(other)
        slope += height / wavelength * np.cos(phase)
    green = np.clip(0.55 - z / 160 + 0.2 * random.random(count, np.float32), 0, 1)
    rock = np.clip(np.abs(slope) * 0.8, 0, 1)
    colors = np.stack([0.35 + 0.4 * rock, 0.3 + 0.45 * green * (1 - rock), 0.2 + 0.3 * rock], 1)
    return np.stack([x, y, z], 1), (np.clip(colors, 0, 1) * 255).astype(np.uint8)


def write_ply(path, positions, colors):
    rows = np.empty(len(positions), [("xyz", "<f4", 3), ("rgb", "u1", 3)])
    rows["xyz"], rows["rgb"] = positions, colors
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(positions)}\n"
              "property float x\nproperty float y\nproperty float z\n"
              "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n")
    with open(path, "wb") as out:
        out.write(header.encode())
        rows.tofile(out)


def write_pcd(path, positions, colors):
    rows = np.zeros(len(positions), [("xyz", "<f4", 3), ("bgra", "u1", 4)])
    rows["xyz"], rows["bgra"][:, :3] = positions, colors[:, ::-1]
    header = ("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F F\n"
              f"COUNT 1 1 1 1\nWIDTH {len(positions)}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\n"
              f"POINTS {len(positions)}\nDATA binary\n")
    with open(path, "wb") as out:
        out.write(header.encode())
        rows.tofile(out)


if __name__ == "__main__":
    count, target = int(sys.argv[1]), sys.argv[2]
    xyz, rgb = terrain(count)
    write_ply(target + ".ply", xyz, rgb)
    write_pcd(target + ".pcd", xyz, rgb)
    print(f"{target}.ply, {target}.pcd: {count} points")

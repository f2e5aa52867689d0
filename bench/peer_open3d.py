#!/usr/bin/env python3
"""Side-by-side baseline: Open3D (PyPI) reads a point cloud.

usage: peer_open3d.py CLOUD [--compress OUT.pcd]
Prints one JSON line: seconds to read the file, and the number of points. With --compress it writes the cloud as
compressed PCD afterwards.
"""
import argparse
import json
import time

import open3d

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("cloud")
parser.add_argument("--compress")
args = parser.parse_args()

start = time.perf_counter()
cloud = open3d.io.read_point_cloud(args.cloud)
seconds = time.perf_counter() - start
print(json.dumps({"tool": "Open3D " + open3d.__version__, "load_s": round(seconds, 4), "points": len(cloud.points)}))
if args.compress:
    open3d.io.write_point_cloud(args.compress, cloud, write_ascii=False, compressed=True)

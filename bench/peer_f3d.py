#!/usr/bin/env python3
"""Side by side: F3D 4 (PyPI, in a virtual environment of its own) on a PLY of splats, sorted on the CPU.

usage: peer_f3d.py SPLATS.ply FRAMES WIDTHxHEIGHT [PICTURE.png]
Prints one JSON line: seconds to load, for the first frame; median milliseconds of a frame while the camera orbits by 3
degrees a frame, each read back; CPU seconds of a frame; the most memory that the process took, in MB.
"""
import json
import resource
import statistics
import sys
import time

import f3d

path, frames, size = sys.argv[1], int(sys.argv[2]), tuple(map(int, sys.argv[3].split("x")))
f3d.Log.set_verbose_level(f3d.Log.VerboseLevel.ERROR)
engine = f3d.Engine.create(True)
engine.window.size = size
engine.options["model.coloring"] = "direct"
engine.options["model.scivis.field"] = "points"
engine.options["model.point_sprites.type"] = "gaussian"
engine.options["model.point_sprites.absolute_size"] = True
engine.options["model.point_sprites.size"] = 1.0
engine.options["render.effect.blending.mode"] = "sort_cpu"
engine.options["ui.axis"] = False
start = time.perf_counter()
engine.scene.add(path)
loaded = time.perf_counter()
engine.window.camera.elevation(25)
image = engine.window.render_to_image()
first = time.perf_counter()
times, cpu = [], time.process_time()
for _ in range(frames):
    begin = time.perf_counter()
    engine.window.camera.azimuth(3)
    image = engine.window.render_to_image()
    times.append(time.perf_counter() - begin)
cpu = time.process_time() - cpu
if len(sys.argv) > 4:
    image.save(sys.argv[4])
print(
    json.dumps(
        {
            "load_s": loaded - start,
            "first_s": first - loaded,
            "frame_ms": 1000 * statistics.median(times),
            "cpu_s": cpu / frames,
            "peak_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
        }
    )
)

#!/usr/bin/env python3
"""One table: EasyPBR beside VTK 9 (clouds: Open3D) in the same run, on the same meshes, environment and size.

usage: run.py --data FOLDER [--work FOLDER] [--quick | --clouds]
FOLDER holds nefertiti.obj, env/studio.hdr and DamagedHelmet/DamagedHelmet.gltf. Without --quick the 25.6 M-face mesh is
measured too (VTK needs two minutes for it), a cloud of 10 M points and 1 M surfels; with --clouds only these. Needs
Debian's python3-vtk9, python3-open3d, xvfb, python3-numpy and time; scripts/bench.sh installs them.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
EASYPBR, FRAMES = ROOT / "build/easypbr", ROOT / "build/bench_frames"
SIZE = "1920x1080"
rows = []


def run(*command, **environment):
    """Wall seconds, peak memory in MB and standard output of a command that must succeed."""
    with tempfile.NamedTemporaryFile("r") as report:
        timed = ["/usr/bin/time", "-f", "%M", "-o", report.name, *map(str, command)]
        start = time.perf_counter()
        done = subprocess.run(timed, capture_output=True, text=True, env={**os.environ, **environment})
        seconds = time.perf_counter() - start
        if done.returncode:
            sys.exit(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
        return seconds, int(report.read().split()[-1]) / 1024, done.stdout


def row(what, ours, peer=None, target=None, unit="s"):
    ratio = f"{ours / peer:.3f}" if peer else "-"
    rows.append((what, f"{ours:.3g} {unit}", f"{peer:.3g} {unit}" if peer else "-", ratio, target or "-"))
    print(f"... {rows[-1]}", file=sys.stderr, flush=True)


def render(mesh, environment, output, *options, **variables):
    return run(EASYPBR, "render", mesh, "--env", environment, "--background", "env", "--size", SIZE, "--samples", 1,
               "--roughness", 0.4, "--metallic", 0, "-o", output, *options, **variables)


def frames(mesh, count, environment, *settings):
    return json.loads(run(FRAMES, mesh, count, environment, SIZE, *settings)[2])


def vtk(mesh, mode, count, environment, *options):
    seconds, memory, text = run("/usr/bin/python3", ROOT / "bench/peer_vtk.py", mesh, mode, count, "--env", environment,
                                "--size", SIZE, *options)
    return {**json.loads(text.strip().splitlines()[-1]), "process_s": seconds, "memory_mb": memory}


def make_mesh(data, work, levels, name):
    path = work / f"{name}.ply"
    if not path.exists():
        run("/usr/bin/python3", ROOT / "bench/make_large_mesh.py", data / "nefertiti.obj", levels, path)
    return path


def make_textured(work, head):
    """The head with a cylindrical uv and four maps of 8192 x 8192 pixels."""
    script = f"""
import numpy as np, easypbr
mesh = easypbr.Mesh({str(head)!r})
V = np.asarray(mesh.V)
c = (V.min(0) + V.max(0)) / 2
mesh.UV = np.stack([np.arctan2(V[:, 0] - c[0], V[:, 2] - c[2]) / (2 * np.pi) + .5,
                    (V[:, 1] - V[:, 1].min()) / np.ptp(V[:, 1])], 1).astype(np.float32)
mesh.save({str(work / 'head_uv.ply')!r})
n = 8192
y, x = np.mgrid[0:n, 0:n].astype(np.float32) / n
checker = ((x * 64).astype(int) + (y * 64).astype(int)) % 2
def save(name, *channels):
    planes = [np.broadcast_to(c, (n, n)) for c in channels]
    easypbr.save_image((np.stack(planes, -1) * 255).astype(np.uint8), {str(work)!r} + '/' + name + '.jpg')
save('base_color', .2 + .6 * checker, .4 + .2 * x, .3 + .4 * y)
save('roughness', .2 + .6 * x, .2 + .6 * x, .2 + .6 * x)
save('metallic', checker * .8, checker * .8, checker * .8)
save('normal', .5 + .1 * np.sin(x * 800), .5 + .1 * np.cos(y * 800), np.float32(.98))
"""
    if not (work / "normal.jpg").exists():
        run(ROOT / ".venv/bin/python", "-c", script)
    return work / "head_uv.ply"


def measure_head(data, work):
    environment = data / "env/studio.hdr"
    head = make_mesh(data, work, 1, "head")
    picture = work / "picture.png"
    render(head, environment, picture)
    warm = statistics.median(render(head, environment, picture)[0] for _ in range(5))
    with tempfile.TemporaryDirectory() as empty:
        cold = render(head, environment, picture, EASYPBR_CACHE_DIR=empty + "/ours", MESA_SHADER_CACHE_DIR=empty + "/mesa")[0]
    peer = vtk(head, "pbr", 1, environment, "--out", work / "vtk")
    row("head 0.4 M: process start to PNG, warm caches", warm, peer["process_s"], "<= 0.8 s")
    row("head 0.4 M: process start to PNG, empty caches", cold, peer["process_s"], "<= 4 s")
    peer = vtk(head, "pbr", 20, environment)
    ours = frames(head, 20, environment, "ssao.enabled=false")  # the peer's frame has none
    row("head 0.4 M: frame, PBR and environment", ours["frame_ms_median"], peer["frame_ms_median"], "<= 0.5 x", "ms")
    ours = frames(head, 20, environment)
    row("  with ambient occlusion, as by default", ours["frame_ms_median"], None, None, "ms")
    row("  share of pixels equal to the still", ours["equal_to_still"] * 100, None, ">= 99.9 %", "%")
    for name, ms in ours["passes_ms"].items():
        row(f"  pass {name}", ms, None, None, "ms")
    driver = frames(head, 20, environment, "--driver")
    row("  pass geometry by the driver's rasteriser", driver["passes_ms"]["geometry"], None, None, "ms")
    textured = make_textured(work, head)
    maps = [f"material.{name}_texture={work / name}.jpg" for name in ("base_color", "roughness", "metallic", "normal")]
    ours = frames(textured, 5, environment, *maps)
    row("head with four 8192^2 maps: first frame (decode, mips, upload)", ours["first_frame_s"])
    row("head with four 8192^2 maps: frame", ours["frame_ms_median"], None, None, "ms")


# The paper's section "Effects": three lights with shadows filtered over 3 x 3 texels, ambient occlusion, bloom, tone mapping.
LIGHTS = ["lights.key.enabled=true", "lights.fill.enabled=true", "lights.rim.enabled=true"]
OFF = ["shadows.enabled=false", "ssao.enabled=false"]
EFFECTS = [
    ("shadows of three lights, 3 x 3", ["shadows.enabled=true", "shadows.mode=pcf"]),
    ("shadows of three lights, soft", ["shadows.enabled=true", "shadows.mode=soft"]),
    ("ambient occlusion", ["ssao.enabled=true"]),
    ("bloom", ["bloom.enabled=true"]),
    ("depth of field", ["depth_of_field.enabled=true"]),
]


def measure_effects(data, work):
    environment = data / "env/studio.hdr"
    head = make_mesh(data, work, 1, "head")
    peer = vtk(head, "full", 20, environment)
    everything = [*LIGHTS, "shadows.mode=pcf", "ssao.enabled=true", "bloom.enabled=true"]
    ours = frames(head, 20, environment, *everything)
    row("head 0.4 M: all effects of the paper", ours["frame_ms_median"], peer["frame_ms_median"], "<= 0.5 x", "ms")
    for name, ms in ours["passes_ms"].items():
        row(f"  pass {name}", ms, None, None, "ms")
    plain = frames(head, 20, environment, *LIGHTS, *OFF)["frame_ms_median"]
    row("head 0.4 M: three lights, no effects", plain, None, None, "ms")
    for name, settings in EFFECTS:
        row(f"  more with {name}", frames(head, 20, environment, *LIGHTS, *OFF, *settings)["frame_ms_median"] - plain,
            None, None, "ms")
    # Differences of a few milliseconds drown in a median's noise: the quickest frame, and what each light more costs.
    counts = (0, 1, 4, 16, 64)
    lit = [frames(head, 40, environment, *OFF, f"--lights={count}")["frame_ms_min"] for count in counts]
    for (few, before), (many, after) in zip(list(zip(counts, lit))[:-1], list(zip(counts, lit))[1:]):
        row(f"head 0.4 M: from {few} to {many} lights without shadows, each", (after - before) / (many - few), None,
            "even within 20 %", "ms")


def measure_goliath(data, work):
    environment = data / "env/studio.hdr"
    goliath = make_mesh(data, work, 4, "goliath")
    goliath.read_bytes()  # both read it from the page cache
    seconds, memory, _ = render(goliath, environment, work / "picture.png")
    ours = frames(goliath, 3, environment)
    driver = frames(goliath, 1, environment, "--driver")
    peer = vtk(goliath, "pbr", 1, environment)
    row("goliath 25.6 M: load", ours["load_s"], peer["load_s"], "<= 0.2 x")
    row("goliath 25.6 M: vertex normals", ours["normals_s"], peer["normals_s"], "<= 0.05 x")
    row("goliath 25.6 M: process start to PNG", seconds, peer["process_s"], "<= 6 s")
    row("goliath 25.6 M: frame", ours["frame_ms_median"], peer["frame_ms_median"], None, "ms")
    row("  pass geometry", ours["passes_ms"]["geometry"], None, None, "ms")
    row("  pass geometry by the driver's rasteriser", driver["passes_ms"]["geometry"], None, None, "ms")
    row("goliath 25.6 M: peak memory", memory, peer["memory_mb"], "<= 3000 MB", "MB")


LOAD_CLOUD = """
import json, sys, time
import easypbr
start = time.perf_counter()
mesh = easypbr.Mesh(sys.argv[1])
print(json.dumps({"load_s": time.perf_counter() - start, "points": len(mesh.V)}))
"""


def load_cloud(path):
    """The faster of three loads, each in a process of its own; peak memory of the process beyond the file."""
    best = None
    for _ in range(3):
        _, memory, text = run(ROOT / ".venv/bin/python", "-c", LOAD_CLOUD, path)
        result = json.loads(text)
        result["memory_mb"] = memory - path.stat().st_size / 2**20
        best = min(best or result, result, key=lambda r: r["load_s"])
    return best


def open3d(path, *options):
    best = None
    for _ in range(1 if options else 3):
        result = json.loads(run("/usr/bin/python3", ROOT / "bench/peer_open3d.py", path, *options)[2].splitlines()[-1])
        best = min(best or result, result, key=lambda r: r["load_s"])
    return best


MAKE_SURFELS = """
import sys
import easypbr
sys.path.insert(0, sys.argv[1])
import make_large_cloud
cloud = easypbr.Mesh()
cloud.V, cloud.C = make_large_cloud.terrain(1_000_000)
cloud.estimate_surfels().save(sys.argv[2])
"""


def measure_surfels(data, work):
    surfels = work / "surfels.ply"
    if not surfels.exists():
        run(ROOT / ".venv/bin/python", "-c", MAKE_SURFELS, ROOT / "bench", surfels)
    ours = frames(surfels, 5, data / "env/studio.hdr")
    row("1 M surfels: frame", ours["frame_ms_median"] / 1000, None, "<= 1.5 s")
    row("  pass geometry", ours["passes_ms"]["geometry"] / 1000)


def measure_clouds(work, count=10_000_000):
    clouds = [work / f"cloud.{extension}" for extension in ("ply", "pcd")] + [work / "cloud_compressed.pcd"]
    if not clouds[1].exists():
        run("/usr/bin/python3", ROOT / "bench/make_large_cloud.py", count, work / "cloud")
    if not clouds[2].exists():
        open3d(clouds[0], "--compress", clouds[2])
    for path, name in zip(clouds, ("PLY", "PCD binary", "PCD compressed")):
        path.read_bytes()  # both read it from the page cache
        ours, peer = load_cloud(path), open3d(path)
        if ours["points"] != peer["points"]:
            sys.exit(f"{path}: {ours['points']} points, Open3D reads {peer['points']}")
        row(f"cloud of {count // 1_000_000} M points, {name}: load", ours["load_s"], peer["load_s"], "<= 0.2 x")
        row("  peak memory beyond the file", ours["memory_mb"], None, None, "MB")
    seconds, memory, _ = run(EASYPBR, "render", clouds[0], "--size", SIZE, "--samples", 1, "-o", work / "cloud.png")
    row("  process start to PNG", seconds, None, "<= 12 s")
    row("  peak memory beyond the file", memory - clouds[0].stat().st_size / 2**20, None, "<= 1000 MB", "MB")


def measure_recording(data, work):
    """What recording a turntable costs beside drawing it, each the best of three rounds."""
    command = (ROOT / "build/bench_recording", data / "DamagedHelmet/DamagedHelmet.gltf", 120, "1280x720")
    for name in ("turntable.mp4", "turntable_%03d.png"):
        times = json.loads(run(*command, work / name)[2])
        row(f"helmet, 120 frames of 1280x720 drawn and recorded: {name.partition('.')[2].upper()}", times["record_s"])
        row("  more than drawn alone", times["cost"] * 100, None, "<= 15 %" if name.endswith("mp4") else None, "%")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=pathlib.Path, required=True)
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path(tempfile.gettempdir()) / "easypbr_bench")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--clouds", action="store_true", help="only clouds and surfels")
    arguments = parser.parse_args()
    arguments.work.mkdir(parents=True, exist_ok=True)
    if not arguments.clouds:
        measure_head(arguments.data, arguments.work)
        measure_recording(arguments.data, arguments.work)
        measure_effects(arguments.data, arguments.work)
        if not arguments.quick:
            measure_goliath(arguments.data, arguments.work)
    if arguments.clouds or not arguments.quick:
        measure_clouds(arguments.work)
        measure_surfels(arguments.data, arguments.work)
    header = ("what", "EasyPBR", "VTK 9, Open3D", "ratio", "target")
    widths = [max(len(r[i]) for r in [header, *rows]) for i in range(5)]
    for line in [header, tuple("-" * w for w in widths), *rows]:
        print("| " + " | ".join(cell.ljust(w) for cell, w in zip(line, widths)) + " |")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""One table: EasyPBR beside VTK 9.7, threepp and Open3D in the same run, on the same meshes, environment and size.

usage: run.py --data FOLDER [--work FOLDER] [--quick | --clouds] [--rounds N]
FOLDER holds nefertiti.obj, env/studio.hdr and DamagedHelmet/DamagedHelmet.gltf. Without --quick the 25.6 M-face mesh is
measured too, a cloud of 10 M points and 1 M surfels; with --clouds only these. Frames of the programs are drawn in turns;
the table has the medians of the rounds, and in brackets the median of their ratios. Needs the environment .venv-bench;
scripts/bench.sh makes it.
"""
import argparse
import dataclasses
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
EASYPBR, FRAMES, PEERS = ROOT / "build/easypbr", ROOT / "build/bench_frames", ROOT / ".venv-bench/bin/python"
SIZE = "1920x1080"
NAMES = ("VTK 9.7", "threepp", "Open3D")


@dataclasses.dataclass
class Row:
    what: str
    ours: float
    unit: str = "s"
    asked: str = "-"
    peers: dict = dataclasses.field(default_factory=dict)  # name: (value, ours / value)

    def cells(self):
        def peer(name):
            if name not in self.peers:
                return "-"
            value, ratio = self.peers[name]
            return f"{value:.3g} {self.unit} ({ratio:.3f} x)"
        return (self.what, f"{self.ours:.3g} {self.unit}", *map(peer, NAMES), self.asked)


rows = []


def row(what, ours, unit="s", asked="-", **peers):
    """`peers` by the first word of a name, in small letters: values of the same run."""
    found = {name: peers[name.split()[0].lower()] for name in NAMES if name.split()[0].lower() in peers}
    add(Row(what, ours, unit, asked, {name: (value, ours / value) for name, value in found.items()}))


def add(made):
    rows.append(made)
    print(f"... {made.cells()}", file=sys.stderr, flush=True)


def in_turns(what, rounds, ours, unit="s", asked="-", **peers):
    """Draws by all programs in turns; each function gives a number."""
    results = [(ours(), {name: peer() for name, peer in peers.items()}) for _ in range(rounds)]
    names = {name.split()[0].lower(): name for name in NAMES}
    add(Row(what, statistics.median(own for own, _ in results), unit, asked,
            {names[peer]: (statistics.median(theirs[peer] for _, theirs in results),
                           statistics.median(own / theirs[peer] for own, theirs in results)) for peer in peers}))


def run(*command, **environment):
    """Wall seconds, peak memory in MB and standard output of a command that must succeed."""
    start = time.perf_counter()
    with tempfile.TemporaryFile("w+") as output, tempfile.TemporaryFile("w+") as errors:
        child = subprocess.Popen([*map(str, command)], stdout=output, stderr=errors, env={**os.environ, **environment})
        _, status, used = os.wait4(child.pid, 0)
        seconds = time.perf_counter() - start
        child.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        errors.seek(0)
        text = output.read()
        if child.returncode:
            sys.exit(f"{' '.join(map(str, command))}\n{text}{errors.read()}")
    return seconds, used.ru_maxrss / 1024, text


def render(mesh, environment, output, *options, **variables):
    return run(EASYPBR, "render", mesh, "--env", environment, "--background", "env", "--size", SIZE, "--samples", 1,
               "--roughness", 0.4, "--metallic", 0, "-o", output, *options, **variables)


def frames(mesh, count, environment, *settings, size=SIZE):
    _, memory, text = run(FRAMES, mesh, count, environment, size, *settings)
    return {**json.loads(text), "memory_mb": memory}


def peer(script, *arguments):
    seconds, memory, text = run(PEERS, ROOT / "bench" / script, *arguments)
    return {**json.loads(text.strip().splitlines()[-1]), "process_s": seconds, "memory_mb": memory}


def vtk(mesh, mode, count, environment, *options):
    return peer("peer_vtk.py", mesh, mode, count, "--env", environment, "--size", SIZE, *options)


def threepp(mesh, count, environment, *options):
    return peer("peer_threepp.py", mesh, count, "--env", environment, "--size", SIZE, *options)


def make_mesh(data, work, levels, name):
    path = work / f"{name}.ply"
    if not path.exists():
        run(PEERS, ROOT / "bench/make_large_mesh.py", data / "nefertiti.obj", levels, path)
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


def measure_start(what, mesh, data, work, rounds, asked, *options):
    """From the process' start to a PNG, with warm and with empty caches."""
    environment, picture = data / "env/studio.hdr", work / "picture.png"
    render(mesh, environment, picture)

    def cold():
        with tempfile.TemporaryDirectory() as empty:
            return render(mesh, environment, picture, EASYPBR_CACHE_DIR=empty + "/ours", MESA_SHADER_CACHE_DIR=empty + "/mesa")[0]

    peers = {"vtk": lambda: vtk(mesh, "pbr", 1, environment, "--out", work / "vtk")["process_s"],
             "threepp": lambda: threepp(mesh, 1, environment, "--out", work / "threepp.png")["process_s"]}
    chosen = {name: measure for name, measure in peers.items() if name in options}
    in_turns(f"{what}: process start to PNG, warm caches", rounds, lambda: render(mesh, environment, picture)[0],
             asked=asked[0], **chosen)
    in_turns(f"{what}: process start to PNG, empty caches", rounds, cold, asked=asked[1])


def frame_of(result):
    return result["frame_ms_median"]


def measure_frames(data, work, rounds):
    environment, helmet = data / "env/studio.hdr", data / "DamagedHelmet/DamagedHelmet.gltf"
    head = make_mesh(data, work, 1, "head")
    measure_start("head 0.4 M", head, data, work, rounds, ("<= 0.2 s", "<= 0.5 s"), "vtk", "threepp")
    measure_start("DamagedHelmet", helmet, data, work, rounds, ("-", "-"), "threepp")
    plain = "ssao.enabled=false"  # the peers' frames have none
    in_turns("head 0.4 M: frame, PBR and environment", rounds, lambda: frame_of(frames(head, 20, environment, plain)), "ms",
             "0.2 x VTK, 0.3 x threepp", vtk=lambda: frame_of(vtk(head, "pbr", 20, environment)),
             threepp=lambda: frame_of(threepp(head, 20, environment)))
    in_turns("DamagedHelmet: frame, five maps and environment", rounds,
             lambda: frame_of(frames(helmet, 20, environment, plain)), "ms", "0.3 x threepp",
             threepp=lambda: frame_of(threepp(helmet, 20, environment)))
    ours = frames(helmet, 20, environment, size="1280x720")
    row("DamagedHelmet, 1280x720, settings by default: frame", frame_of(ours), "ms", "<= 33 ms")
    ours = frames(head, 20, environment)
    row("head 0.4 M: frame with ambient occlusion, as by default", frame_of(ours), "ms")
    row("  share of pixels equal to the still", ours["equal_to_still"] * 100, "%", ">= 99.9 %")
    for name, ms in ours["passes_ms"].items():
        row(f"  pass {name}", ms, "ms")
    driver = frames(head, 20, environment, "--driver")
    row("  pass geometry by the driver's rasteriser", driver["passes_ms"]["geometry"], "ms")
    textured = make_textured(work, head)
    maps = [f"material.{name}_texture={work / name}.jpg" for name in ("base_color", "roughness", "metallic", "normal")]
    ours = frames(textured, 5, environment, *maps)
    row("head with four 8192^2 maps: first frame (decode, mips, upload)", ours["first_frame_s"])
    row("head with four 8192^2 maps: frame", frame_of(ours), "ms", "<= 50 ms")


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


def measure_effects(data, work, rounds):
    environment = data / "env/studio.hdr"
    head = make_mesh(data, work, 1, "head")
    everything = ["--lights=3", "--turning-lights", "shadows.mode=pcf", "ssao.enabled=true", "bloom.enabled=true"]
    in_turns("head 0.4 M: all effects of the paper, moving shadows", rounds, lambda: frame_of(frames(head, 20, environment, *everything)), "ms",
             "0.2 x VTK with SSAO alone", vtk=lambda: frame_of(vtk(head, "full", 20, environment)))
    for name, ms in frames(head, 20, environment, *everything)["passes_ms"].items():
        row(f"  pass {name}", ms, "ms")
    plain = frames(head, 20, environment, *LIGHTS, *OFF)["frame_ms_median"]
    row("head 0.4 M: three lights, no effects", plain, "ms")
    for name, settings in EFFECTS:
        row(f"  more with {name}", frames(head, 20, environment, *LIGHTS, *OFF, *settings)["frame_ms_median"] - plain,
            "ms")
    # Differences of a few milliseconds drown in a median's noise: the quickest frame, and what each light more costs.
    counts = (0, 1, 4, 16, 64)
    lit = [frames(head, 40, environment, *OFF, f"--lights={count}")["frame_ms_min"] for count in counts]
    for (few, before), (many, after) in zip(list(zip(counts, lit))[:-1], list(zip(counts, lit))[1:]):
        row(f"head 0.4 M: from {few} to {many} lights without shadows, each", (after - before) / (many - few), "ms",
            "even within 20 %")


def measure_goliath(data, work):
    environment = data / "env/studio.hdr"
    goliath = make_mesh(data, work, 4, "goliath")
    goliath.read_bytes()  # all read it from the page cache
    render(goliath, environment, work / "picture.png")
    seconds, memory, _ = render(goliath, environment, work / "picture.png")
    ours = frames(goliath, 20, environment, "ssao.enabled=false")
    driver = frames(goliath, 1, environment, "--driver")
    theirs = vtk(goliath, "pbr", 1, environment)
    row("goliath 25.6 M: load", ours["load_s"], vtk=theirs["load_s"])
    row("goliath 25.6 M: vertex normals", ours["normals_s"], vtk=theirs["normals_s"])
    row("goliath 25.6 M: process start to PNG", seconds, asked="<= 1.5 s", vtk=theirs["process_s"])
    row("goliath 25.6 M: frame", frame_of(ours), "ms", "0.025 x VTK, 100 ms", vtk=frame_of(theirs))
    row("  pass geometry", ours["passes_ms"]["geometry"], "ms")
    row("  pass geometry by the driver's rasteriser", driver["passes_ms"]["geometry"], "ms")
    row("goliath 25.6 M: peak memory of an image", memory, "MB", vtk=theirs["memory_mb"])
    row("goliath 25.6 M: second frame", ours["second_frame_s"])
    row("goliath 25.6 M: second frame and clusters", ours["ordered_s"])
    row("goliath 25.6 M: peak memory of frames, with clusters", ours["memory_mb"], "MB", "<= 1200 MB")


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
    return min((peer("peer_open3d.py", path, *options) for _ in range(1 if options else 3)), key=lambda r: r["load_s"])


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
    ours = frames(surfels, 20, data / "env/studio.hdr")
    row("1 M surfels: frame", frame_of(ours), "ms", "<= 150 ms")
    row("  pass geometry", ours["passes_ms"]["geometry"], "ms")


def measure_clouds(data, work, count=10_000_000):
    clouds = [work / f"cloud.{extension}" for extension in ("ply", "pcd")] + [work / "cloud_compressed.pcd"]
    if not clouds[1].exists():
        run(PEERS, ROOT / "bench/make_large_cloud.py", count, work / "cloud")
    if not clouds[2].exists():
        open3d(clouds[0], "--compress", clouds[2])
    for path, name in zip(clouds, ("PLY", "PCD binary", "PCD compressed")):
        path.read_bytes()  # both read it from the page cache
        ours, theirs = load_cloud(path), open3d(path)
        if ours["points"] != theirs["points"]:
            sys.exit(f"{path}: {ours['points']} points, Open3D reads {theirs['points']}")
        row(f"cloud of {count // 1_000_000} M points, {name}: load", ours["load_s"], open3d=theirs["load_s"])
        row("  peak memory beyond the file", ours["memory_mb"], "MB")
    row("  frame with eye-dome lighting", frame_of(frames(clouds[0], 20, data / "env/studio.hdr")), "ms", "<= 80 ms")
    seconds, memory, _ = run(EASYPBR, "render", clouds[0], "--size", SIZE, "--samples", 1, "-o", work / "cloud.png")
    row("  process start to PNG", seconds)
    row("  peak memory beyond the file", memory - clouds[0].stat().st_size / 2**20, "MB", "<= 1000 MB")


def measure_still(data, work, rounds):
    """By default, path traced: loading, drawing, writing."""
    helmet = data / "DamagedHelmet/DamagedHelmet.gltf"
    command = (EASYPBR, "render", helmet, "--set", "ground.mode=shadow", "--size", "1280x720", "-o", work / "still.png")
    in_turns("DamagedHelmet on a ground, 1280x720, a still by default", rounds, lambda: run(*command)[0], asked="<= 3 s")
    in_turns("  16 rasterised samples", rounds, lambda: run(*command, "--mode", "raster", "--samples", 16)[0], asked="<= 1.5 s")


def measure_recording(data, work):
    """What recording a turntable costs beside drawing it, each the best of three rounds."""
    command = (ROOT / "build/bench_recording", data / "DamagedHelmet/DamagedHelmet.gltf", 120, "1280x720")
    for name in ("turntable.mp4", "turntable_%03d.png"):
        times = json.loads(run(*command, work / name)[2])
        row(f"helmet, 120 frames of 1280x720 drawn and recorded: {name.partition('.')[2].upper()}", times["record_s"])
        row("  more than drawn alone", times["cost"] * 100, "%", "<= 15 %" if name.endswith("mp4") else "-")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=pathlib.Path, required=True)
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path(tempfile.gettempdir()) / "easypbr_bench")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--clouds", action="store_true", help="only clouds and surfels")
    parser.add_argument("--rounds", type=int, default=3)
    arguments = parser.parse_args()
    arguments.work.mkdir(parents=True, exist_ok=True)
    data, work, rounds = arguments.data, arguments.work, arguments.rounds
    if not arguments.clouds:
        measure_frames(data, work, rounds)
        measure_still(data, work, rounds)
        measure_recording(data, work)
        measure_effects(data, work, rounds)
        if not arguments.quick:
            measure_goliath(data, work)
    if arguments.clouds or not arguments.quick:
        measure_clouds(data, work)
        measure_surfels(data, work)
    header = ("what", "EasyPBR", *NAMES, "asked")
    table = [made.cells() for made in rows]
    widths = [max(len(cells[i]) for cells in [header, *table]) for i in range(len(header))]
    for line in [header, tuple("-" * w for w in widths), *table]:
        print("| " + " | ".join(cell.ljust(w) for cell, w in zip(line, widths)) + " |")


if __name__ == "__main__":
    main()

"""Code blocks of Markdown pages, and the files that they name."""
import base64
import json
import pathlib
import re

import numpy as np

import easypbr
from easypbr import shapes

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
IMPORTS_ALL = re.compile(r"^from easypbr\S* import \*", re.MULTILINE)
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def blocks(page, language):
    """The page's blocks of one language, in their order."""
    return [text for name, text in FENCE.findall(page.read_text()) if name == language]


def programs(page):
    """The page's Python; a block that imports all names again begins another program."""
    texts = []
    for block in blocks(page, "python"):
        if not texts or IMPORTS_ALL.search(texts[-1]) and IMPORTS_ALL.search(block):
            texts.append(block)
        else:
            texts[-1] += "\n" + block
    return texts


def write_inputs(folder):
    """Every file that a snippet names, small."""
    model = shapes.teapot(0.4, 4)
    for name in ("drone.ply", "drone.glb"):
        model.save(folder / name)
    easypbr.splats(model.V, 0.02, opacities=0.8, colors=np.full((len(model.V), 3), 0.5)).save(folder / "room.ply")
    write_stl(folder / "part.stl", model)
    rows = np.linspace(1.5, 0.1, 16, dtype=np.float32)[:, None, None]
    easypbr.save_image(np.broadcast_to(rows * np.array([0.6, 0.7, 1], np.float32), (16, 32, 3)), folder / "map.hdr")
    grain = np.random.default_rng(0).integers(60, 200, (16, 16, 3)).astype(np.uint8)
    easypbr.save_image(grain, folder / "wood.png")
    easypbr.save_image(np.full((4, 4, 3), (128, 128, 255), np.uint8), folder / "normal.png")
    write_gltf(folder / "scene.gltf")
    (folder / "lines.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\n")
    places = "".join(f"{x / 10} {y / 10} {1 + x / 20}\n" for y in range(8) for x in range(8))
    (folder / "frame.pcd").write_text("VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 8\nHEIGHT 8\n"
                                      f"POINTS 64\nDATA ascii\n{places}")
    (folder / "pose.txt").write_text("1 0 0 0\n0 -1 0 0.2\n0 0 -1 2\n0 0 0 1\n")


def write_gltf(path):
    """A triangle, and a camera named front that looks at it."""
    data = base64.b64encode(np.array([0, 0, 0, 1, 0, 0, 0, 1, 0], "<f4").tobytes()).decode()
    positions = {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0] * 3, "max": [1, 1, 0]}
    path.write_text(json.dumps({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0}, {"name": "front", "camera": 0, "translation": [0.3, 0.3, 3]}],
        "cameras": [{"name": "front", "type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [positions],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": f"data:application/octet-stream;base64,{data}"}],
    }))


def write_stl(path, mesh):
    """Binary STL: 80 bytes, the number of facets, 50 bytes for each."""
    facets = np.zeros(len(mesh.F), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    facets["corners"] = mesh.V[mesh.F]
    path.write_bytes(bytes(80) + np.uint32(len(facets)).tobytes() + facets.tobytes())

"""Draws the reference pictures of test_mitsuba.py with Mitsuba 3, in the environment that scripts/oracle.sh makes:

    .venv-oracle/bin/python tests/oracle/make_references.py --data FOLDER

FOLDER holds bunny.ply, env/monument_valley.hdr and env/studio.hdr. The pictures and manifest.json beside this file are
committed: each picture with its scene, the hash of that scene and of the files it was made from.

The sphere is lit by Mitsuba's integrator `direct`: a convex shape neither shadows nor reflects itself. The mesh is lit
by `unoccluded` (unoccluded.py), because image-based lighting by split sum knows no self-shadowing: comparing with a
path-traced mesh would measure that, not the shading. On the sphere the two integrators agree within their noise.
"""
import argparse
import hashlib
import json
import os
import pathlib

import mitsuba as mi
import numpy as np
import OpenEXR

from file_hash import hash_of

VARIANT = "llvm_ad_rgb"
mi.set_variant(VARIANT)
import unoccluded  # noqa: E402, F401  (registers the integrator; needs the variant)

HERE = pathlib.Path(__file__).resolve().parent
SIZE = 64
SAMPLES = 16384
SAMPLES_PER_PASS = 512
ENVIRONMENTS = ["monument_valley", "studio"]
SHAPES = {
    "sphere": {
        "file": None,
        "integrator": "direct",
        "camera": {"position": [2.0, 1.5, 4.0], "target": [0.0, 0.0, 0.0], "fov_y_deg": 28.0},
        "roughnesses": [0.1, 0.2, 0.4, 0.6, 0.8, 1.0],
    },
    "bunny": {
        "file": "bunny.ply",
        "integrator": "unoccluded",
        # So near that a pixel sees about three faces, which the 16 samples of the picture compared with it resolve.
        "camera": {"position": [0.19, 0.26, 0.42], "target": [-0.01, 0.125, 0.0], "fov_y_deg": 8.0},
        "roughnesses": [0.2, 0.6],
    },
}


def pictures():
    """What is drawn: one dictionary per picture, with all that determines its scene but the contents of files."""
    for shape, about in SHAPES.items():
        for environment in ENVIRONMENTS:
            common = {"shape": shape, "environment": f"env/{environment}.hdr", "mesh": about["file"],
                      "integrator": about["integrator"], "camera": about["camera"], "size": SIZE}
            yield {"name": f"{shape}_{environment}_diffuse", "bsdf": "diffuse", "reflectance": 0.5, **common}
            for roughness in about["roughnesses"]:
                yield {"name": f"{shape}_{environment}_conductor_{round(roughness * 100):03}",
                       "bsdf": "roughconductor", "roughness": roughness, **common}


def bsdf_of(picture):
    if picture["bsdf"] == "diffuse":
        return {"type": "diffuse", "reflectance": {"type": "rgb", "value": picture["reflectance"]}}
    return {"type": "roughconductor", "distribution": "ggx", "material": "none", "alpha": picture["roughness"] ** 2}


def scene_of(picture, data):
    camera = picture["camera"]
    transform = mi.ScalarTransform4f()
    shape = {"type": "ply", "filename": str(data / picture["mesh"])} if picture["mesh"] else {"type": "sphere"}
    return mi.load_dict({
        "type": "scene",
        "integrator": {"type": picture["integrator"]},
        "sensor": {
            "type": "perspective", "fov": camera["fov_y_deg"], "fov_axis": "y",
            "to_world": transform.look_at(origin=camera["position"], target=camera["target"], up=[0, 1, 0]),
            "film": {"type": "hdrfilm", "width": picture["size"], "height": picture["size"],
                     "pixel_format": "rgba", "rfilter": {"type": "box"}},
            "sampler": {"type": "independent"},
        },
        "shape": {**shape, "bsdf": bsdf_of(picture)},
        # Mitsuba's picture starts at -Z and grows towards +X; ours has -Z in the middle.
        "environment": {"type": "envmap", "filename": str(data / picture["environment"]),
                        "to_world": transform.rotate([0, 1, 0], 180)},
    })


def render(picture, data, samples, seed):
    """Height x width x 4: radiance (premultiplied) and coverage."""
    scene = scene_of(picture, data)
    passes = max(1, samples // SAMPLES_PER_PASS)
    total = np.zeros((picture["size"], picture["size"], 4))
    for i in range(passes):
        total += np.array(mi.render(scene, spp=samples // passes, seed=seed * 100_003 + i))
    return total / passes


def write(path, pixels):
    """As halves, compressed by ZIP: Mitsuba itself writes PIZ, which few readers know."""
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, {"RGBA": pixels.astype(np.float16)}).write(str(path))


def scene_hash(picture, inputs):
    """Of the description and of the contents of the files it names."""
    contents = {file: inputs[file] for file in (picture["mesh"], picture["environment"]) if file}
    return hashlib.sha256(json.dumps({**picture, "contents": contents}, sort_keys=True).encode()).hexdigest()


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=pathlib.Path, default=os.environ.get("EASYPBR_TEST_DATA"),
                        help="folder with the mesh and the environments (default: $EASYPBR_TEST_DATA)")
    parser.add_argument("--only", metavar="NAME", help="draw this picture alone and write no manifest")
    parser.add_argument("--output", type=pathlib.Path, default=HERE / "references")
    parser.add_argument("--samples", type=int, default=SAMPLES)
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args()
    if chosen.data is None:
        parser.error("--data FOLDER is needed when EASYPBR_TEST_DATA is not set")
    if chosen.only and chosen.only not in [p["name"] for p in pictures()]:
        parser.error(f"there is no picture '{chosen.only}'")
    return chosen


def main():
    chosen = options()
    inputs = {file: hash_of(chosen.data / file) for p in pictures() for file in (p["mesh"], p["environment"]) if file}
    chosen.output.mkdir(parents=True, exist_ok=True)
    entries = []
    for picture in pictures():
        if chosen.only and picture["name"] != chosen.only:
            continue
        path = chosen.output / f"{picture['name']}.exr"
        write(path, render(picture, chosen.data, chosen.samples, chosen.seed))
        entries.append({**picture, "scene_hash": scene_hash(picture, inputs), "sha256": hash_of(path)})
        print(path)
    if not chosen.only:
        manifest = {"mitsuba": mi.__version__, "variant": VARIANT, "samples": chosen.samples, "seed": chosen.seed,
                    "inputs": inputs, "pictures": entries}
        (HERE / "manifest.json").write_text(json.dumps(manifest, indent=1) + "\n")


if __name__ == "__main__":
    main()

"""Draws the reference picture of test_room.py with Mitsuba 3, in the environment that scripts/oracle.sh makes:

    .venv-oracle/bin/python tests/oracle/make_room.py --data FOLDER

FOLDER holds room_scene.obj. Its faces are lit by two point lights, directly: what shadow maps have to show. The picture and
room.json beside this file are committed.
"""
import argparse
import json
import os
import pathlib

import mitsuba as mi
import numpy as np
import OpenEXR

from file_hash import hash_of

mi.set_variant("llvm_ad_rgb")
HERE = pathlib.Path(__file__).resolve().parent
SCENE = {
    "mesh": "room_scene.obj", "size": [240, 180], "reflectance": 0.5, "samples": 4096,
    "camera": {"position": [2.3, 1.7, 3.2], "target": [-0.1, -0.55, 0.0], "fov_y_deg": 30.0},
    "lights": [{"position": [1.2, 1.1, 0.6], "intensity": 8.0}, {"position": [0.2, 0.9, 2.0], "intensity": 5.0}],
}


def render(data):
    """Height x width x 4: radiance (premultiplied) and coverage."""
    camera = SCENE["camera"]
    transform = mi.ScalarTransform4f()
    white = {"type": "diffuse", "reflectance": {"type": "rgb", "value": SCENE["reflectance"]}}
    scene = {
        "type": "scene", "integrator": {"type": "direct"},
        "sensor": {
            "type": "perspective", "fov": camera["fov_y_deg"], "fov_axis": "y",
            "to_world": transform.look_at(origin=camera["position"], target=camera["target"], up=[0, 1, 0]),
            "film": {"type": "hdrfilm", "width": SCENE["size"][0], "height": SCENE["size"][1],
                     "pixel_format": "rgba", "rfilter": {"type": "box"}},
            "sampler": {"type": "independent"},
        },
        "room": {"type": "obj", "filename": str(data / SCENE["mesh"]), "face_normals": True,
                 "bsdf": {"type": "twosided", "nested": white}},
    }
    for number, light in enumerate(SCENE["lights"]):
        scene[f"light{number}"] = {"type": "point", "position": light["position"],
                                   "intensity": {"type": "rgb", "value": light["intensity"]}}
    return np.array(mi.render(mi.load_dict(scene), spp=SCENE["samples"], seed=1))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    folder = os.environ.get("EASYPBR_TEST_DATA")
    parser.add_argument("--data", type=pathlib.Path, default=folder, required=not folder)
    data = pathlib.Path(parser.parse_args().data)
    path = HERE / "room.exr"
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, {"RGBA": render(data).astype(np.float16)}).write(str(path))
    about = {"mitsuba": mi.__version__, **SCENE, "input": hash_of(data / SCENE["mesh"]), "sha256": hash_of(path)}
    (HERE / "room.json").write_text(json.dumps(about, indent=1) + "\n")


if __name__ == "__main__":
    main()

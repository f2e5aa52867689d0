"""Draws the reference picture of test_paths.py with Mitsuba 3, in the environment that scripts/oracle.sh makes:

    .venv-oracle/bin/python tests/oracle/make_paths.py

Paths of any length in the scene of path_scene.py. The picture and paths.json beside this file are committed.
"""
import json
import pathlib

import mitsuba as mi
import numpy as np
import OpenEXR

import path_scene
from file_hash import hash_of

mi.set_variant("llvm_ad_rgb")
HERE = pathlib.Path(__file__).resolve().parent


def diffuse(reflectance):
    return {"type": "diffuse", "reflectance": {"type": "rgb", "value": list(reflectance)}}


def conductor(roughness):
    """GGX that reflects all; alpha is the square of the roughness."""
    return {"type": "roughconductor", "material": "none", "distribution": "ggx", "alpha": roughness * roughness}


def render():
    """Height x width x 4: radiance (premultiplied) and coverage."""
    camera, transform = path_scene.CAMERA, mi.ScalarTransform4f()
    width, height = path_scene.SIZE
    scene = {
        "type": "scene", "integrator": {"type": "path", "max_depth": -1, "hide_emitters": True},
        "sensor": {
            "type": "perspective", "fov": camera["fov_y_deg"], "fov_axis": "y",
            "to_world": transform.look_at(origin=camera["position"], target=camera["target"], up=[0, 1, 0]),
            "film": {"type": "hdrfilm", "width": width, "height": height, "pixel_format": "rgba",
                     "rfilter": {"type": "box"}},
            "sampler": {"type": "independent"},
        },
        "sky": {"type": "envmap", "bitmap": mi.Bitmap(path_scene.sky())},
        "light": {"type": "point", "position": path_scene.LIGHT["position"],
                  "intensity": {"type": "rgb", "value": path_scene.LIGHT["intensity"]}},
    }
    for name, (size, centre, reflectance) in path_scene.BOXES.items():
        place = transform.translate(list(centre)).scale([side / 2 for side in size])
        scene[name] = {"type": "cube", "to_world": place, "bsdf": diffuse(reflectance)}
    for name, (radius, centre, reflectance, roughness) in path_scene.BALLS.items():
        scene[name] = {"type": "sphere", "center": list(centre), "radius": radius,
                       "bsdf": diffuse(reflectance) if roughness is None else conductor(roughness)}
    return np.array(mi.render(mi.load_dict(scene), spp=path_scene.SAMPLES, seed=1))


def main():
    path = HERE / "paths.exr"
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, {"RGBA": render().astype(np.float16)}).write(str(path))
    about = {"mitsuba": mi.__version__, "scene": hash_of(HERE / "path_scene.py"), "sha256": hash_of(path)}
    (HERE / "paths.json").write_text(json.dumps(about, indent=1) + "\n")


if __name__ == "__main__":
    main()

"""Draws the reference picture of test_splat_ball.py with Mitsuba 3, in the environment that scripts/oracle.sh makes:

    .venv-oracle/bin/python tests/oracle/make_splat_ball.py

The walls are rectangles that emit what splat_ball.py says. The picture and splat_ball.json beside this file are committed.
"""
import json
import pathlib

import mitsuba as mi
import numpy as np
import OpenEXR

import splat_ball
from file_hash import hash_of

mi.set_variant("llvm_ad_rgb")
HERE = pathlib.Path(__file__).resolve().parent
SAMPLES = 2048


def linear(code):
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)


def rectangle(wall):
    """Mitsuba's rectangle lies in [-1, 1]^2 of its x and y; the rows of a raw bitmap go up."""
    corner, along, up = (np.array(part, float) for part in wall[:3])
    to_world = np.eye(4)
    to_world[:3, 0], to_world[:3, 1] = along / 2, up / 2
    to_world[:3, 2] = np.cross(along, up) / np.linalg.norm(np.cross(along, up))
    to_world[:3, 3] = corner + along / 2 + up / 2
    bitmap = mi.Bitmap(linear(splat_ball.texels(wall)).astype(np.float32))
    radiance = {"type": "bitmap", "bitmap": bitmap, "raw": True, "wrap_mode": "clamp"}
    return {"type": "rectangle", "to_world": mi.ScalarTransform4f(to_world), "bsdf": {"type": "diffuse", "reflectance": 0.0},
            "emitter": {"type": "area", "radiance": radiance}}


def render():
    """Height x width x 3: radiance."""
    camera, ball = splat_ball.CAMERA, splat_ball.BALL
    scene = {
        "type": "scene", "integrator": {"type": "path", "max_depth": 24},
        "sensor": {
            "type": "perspective", "fov": camera["fov_y_deg"], "fov_axis": "y",
            "to_world": mi.ScalarTransform4f().look_at(origin=camera["position"], target=camera["target"], up=[0, 1, 0]),
            "film": {"type": "hdrfilm", "width": splat_ball.SIZE[0], "height": splat_ball.SIZE[1],
                     "pixel_format": "rgb", "rfilter": {"type": "box"}},
            "sampler": {"type": "independent"},
        },
        "ball": {"type": "sphere", "center": ball["center"], "radius": ball["radius"],
                 "bsdf": {"type": "dielectric", "int_ior": ball["ior"], "ext_ior": 1.0}},
        **{name: rectangle(wall) for name, wall in splat_ball.WALLS.items()},
    }
    return np.array(mi.render(mi.load_dict(scene), spp=SAMPLES, seed=1))


def main():
    path = HERE / "splat_ball.exr"
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, {"RGB": render().astype(np.float16)}).write(str(path))
    about = {"mitsuba": mi.__version__, "samples": SAMPLES, "sha256": hash_of(path)}
    (HERE / "splat_ball.json").write_text(json.dumps(about, indent=1) + "\n")


if __name__ == "__main__":
    main()

"""Draws the reference picture of test_helmet.py with Mitsuba 3, in the environment that scripts/oracle.sh makes:

    .venv-oracle/bin/python tests/oracle/make_helmet.py --data FOLDER

FOLDER holds DamagedHelmet/DamagedHelmet.gltf and env/monument_valley.hdr. The helmet stands on a square of ground under the
sky, path traced. The picture and helmet.json beside this file are committed.
"""
import argparse
import base64
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
    "mesh": "DamagedHelmet/DamagedHelmet.gltf", "environment": "env/monument_valley.hdr", "size": [320, 240],
    "camera": {"position": [1.6, 1.1, 3.4], "target": [0.0, -0.12, 0.0], "fov_y_deg": 36.0},
    "ground": {"height": -0.901, "size": 5.0, "reflectance": 0.5}, "samples": 1024, "samples_per_pass": 64, "depth": 8,
}


def read_gltf(path):
    """Positions, normals, texture coordinates and triangles of the only primitive, and its images by what they are."""
    document = json.loads(path.read_text())

    def bytes_of(uri):
        return base64.b64decode(uri.split(",", 1)[1]) if uri.startswith("data:") else (path.parent / uri).read_bytes()

    buffer = bytes_of(document["buffers"][0]["uri"])

    def array(index):
        accessor = document["accessors"][index]
        view = document["bufferViews"][accessor["bufferView"]]
        columns = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[accessor["type"]]
        dtype = {5123: np.uint16, 5125: np.uint32, 5126: np.float32}[accessor["componentType"]]
        offset = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        values = np.frombuffer(buffer, dtype, accessor["count"] * columns, offset)
        return values.reshape(-1, columns)

    x, y, z, w = document["nodes"][0]["rotation"]
    turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    primitive = document["meshes"][0]["primitives"][0]
    attributes = primitive["attributes"]
    material = document["materials"][primitive["material"]]
    pbr = material["pbrMetallicRoughness"]
    textures = {"base_color": pbr["baseColorTexture"], "metallic_roughness": pbr["metallicRoughnessTexture"],
                "emissive": material["emissiveTexture"], "normal": material["normalTexture"]}
    images = {name: path.parent / document["images"][document["textures"][t["index"]]["source"]]["uri"]
              for name, t in textures.items()}
    return {"V": array(attributes["POSITION"]) @ turn.T, "N": array(attributes["NORMAL"]) @ turn.T,
            "UV": array(attributes["TEXCOORD_0"]), "F": array(primitive["indices"]).reshape(-1, 3), "images": images}


def bitmap(path, raw, channel=None):
    image = mi.Bitmap(str(path)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.UInt8, srgb_gamma=True)
    if channel is not None:
        image = mi.Bitmap(np.ascontiguousarray(np.array(image)[:, :, channel:channel + 1]))
    return {"type": "bitmap", "bitmap": image, "raw": raw}


def helmet_of(gltf, glows):
    images = gltf["images"]
    surface = {
        "type": "principled", "base_color": bitmap(images["base_color"], raw=False), "specular": 0.5,
        "roughness": bitmap(images["metallic_roughness"], raw=True, channel=1),
        "metallic": bitmap(images["metallic_roughness"], raw=True, channel=2),
    }
    properties = mi.Properties()
    properties["bsdf"] = mi.load_dict({"type": "normalmap", "normalmap": bitmap(images["normal"], raw=True), "bsdf": surface})
    if glows:
        properties["emitter"] = mi.load_dict({"type": "area", "radiance": bitmap(images["emissive"], raw=False)})
    mesh = mi.Mesh("helmet", len(gltf["V"]), len(gltf["F"]), has_vertex_normals=True, has_vertex_texcoords=True,
                   props=properties)
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"] = gltf["V"].astype(np.float32).ravel()
    parameters["vertex_normals"] = gltf["N"].astype(np.float32).ravel()
    parameters["vertex_texcoords"] = gltf["UV"].astype(np.float32).ravel()
    parameters["faces"] = gltf["F"].astype(np.uint32).ravel()
    parameters.update()
    return mesh


def scene_of(data, glows):
    """The helmet lit by the sky, or by its own glow alone: an integrator that hides the sky hides all that glows."""
    camera, ground = SCENE["camera"], SCENE["ground"]
    transform = mi.ScalarTransform4f()
    half = ground["size"] / 2
    scene = {
        "type": "scene", "integrator": {"type": "path", "max_depth": SCENE["depth"], "hide_emitters": not glows},
        "sensor": {
            "type": "perspective", "fov": camera["fov_y_deg"], "fov_axis": "y",
            "to_world": transform.look_at(origin=camera["position"], target=camera["target"], up=[0, 1, 0]),
            "film": {"type": "hdrfilm", "width": SCENE["size"][0], "height": SCENE["size"][1],
                     "pixel_format": "rgba", "rfilter": {"type": "box"}},
            "sampler": {"type": "independent"},
        },
        "helmet": helmet_of(read_gltf(data / SCENE["mesh"]), glows),
        "ground": {"type": "rectangle",
                   "to_world": transform.translate([0, ground["height"], 0]).rotate([1, 0, 0], -90).scale([half, half, 1]),
                   "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": ground["reflectance"]}}},
    }
    if not glows:
        # Mitsuba's picture starts at -Z and grows towards +X; ours has -Z in the middle.
        scene["environment"] = {"type": "envmap", "filename": str(data / SCENE["environment"]),
                                "to_world": transform.rotate([0, 1, 0], 180)}
    return mi.load_dict(scene)


def render(data, samples):
    """Height x width x 4: radiance (premultiplied) and coverage."""
    lit, glowing = scene_of(data, False), scene_of(data, True)
    passes = max(1, samples // SCENE["samples_per_pass"])
    total = 0
    for i in range(passes):
        picture = np.array(mi.render(lit, spp=samples // passes, seed=2 * i), dtype=np.float64)
        picture[:, :, :3] += np.array(mi.render(glowing, spp=samples // passes, seed=2 * i + 1))[:, :, :3]
        total = total + picture / passes
    return total


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    folder = os.environ.get("EASYPBR_TEST_DATA")
    parser.add_argument("--data", type=pathlib.Path, default=folder, required=not folder)
    parser.add_argument("--samples", type=int, default=SCENE["samples"])
    parser.add_argument("--output", type=pathlib.Path, default=HERE)
    chosen = parser.parse_args()
    data = pathlib.Path(chosen.data)
    path = chosen.output / "helmet.exr"
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, {"RGBA": np.minimum(render(data, chosen.samples), 60000).astype(np.float16)}).write(str(path))
    about = {"mitsuba": mi.__version__, **SCENE, "samples": chosen.samples, "sha256": hash_of(path),
             "inputs": {file: hash_of(data / file) for file in (SCENE["mesh"], SCENE["environment"])}}
    (chosen.output / "helmet.json").write_text(json.dumps(about, indent=1) + "\n")


if __name__ == "__main__":
    main()

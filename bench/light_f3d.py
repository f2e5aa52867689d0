"""The pictures of bench/light_peers.py that F3D draws, in the environment of scripts/peers.sh. usage: light_f3d.py FOLDER

Physically based shading, image-based lighting and ambient occlusion in screen space, of a glTF file with its materials and lamps. Lamps
have no shadows in F3D, and their light does not fall with the distance: they have what arrives at the target. Emissive meshes are spot
lights; what rooms get besides is an ambient light. Glass is translucent. Its wheel has no ray tracing.
"""
import base64
import io
import itertools
import json
import math
import pathlib
import struct
import sys
import tempfile

import f3d
import light_scenes
import numpy as np
import PIL.Image

SUPERSAMPLING = 4
SIZE = (SUPERSAMPLING * light_scenes.SIZE[0], SUPERSAMPLING * light_scenes.SIZE[1])


def material_of(shape, matt, opacity):
    if shape.emission:
        # Without a texture VTK's shaders, which it uses, have no emission.
        return {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}, "emissiveFactor": [1, 1, 1],
                "emissiveTexture": {"index": 0}}
    glass = shape.kind == light_scenes.GLASS
    return {"pbrMetallicRoughness": {"baseColorFactor": [*map(float, shape.color), opacity if glass else 1.0],
                                     "metallicFactor": float(shape.kind == light_scenes.CONDUCTOR),
                                     "roughnessFactor": shape.roughness},
            "alphaMode": "BLEND" if glass else "OPAQUE", "extensions": {"KHR_materials_ior": {"ior": 1.0 if matt else 1.5}}}


def lights_of(setup):
    """Of KHR_lights_punctual, and their nodes; spot lights shine along -z."""
    def at_target(position, intensity):
        return float(intensity) * setup.exposure / float(np.sum(np.subtract(setup.target, position) ** 2))

    # Where a file has no lamp it shines one of its own.
    lamps = setup.lamps or [((0.0, 1000.0, 0.0), 1e-3)]
    lights = [{"type": "point", "intensity": at_target(*lamp)} for lamp in lamps]
    nodes = [{"translation": list(position)} for position, _ in lamps]
    down = [-math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)]
    for position, _, intensity in light_scenes.spots(setup):
        lights.append({"type": "spot", "intensity": at_target(position, intensity),
                       "spot": {"innerConeAngle": 0.0, "outerConeAngle": math.radians(89)}})
        nodes.append({"translation": position.tolist(), "rotation": down})
    return lights, nodes


def write_glb(setup, opacity, path):
    buffer, views, accessors, meshes = b"", [], [], []
    for i, shape in enumerate(setup.shapes):
        corners, normals = light_scenes.flat(shape)
        attributes = {"POSITION": corners, "NORMAL": normals, "TEXCOORD_0": np.zeros((len(corners), 2), np.float32)}
        for values in attributes.values():
            views.append({"buffer": 0, "byteOffset": len(buffer), "byteLength": values.nbytes})
            accessors.append({"bufferView": len(views) - 1, "componentType": 5126, "count": len(values),
                              "type": f"VEC{values.shape[1]}", "min": values.min(0).tolist(), "max": values.max(0).tolist()})
            buffer += np.ascontiguousarray(values, np.float32).tobytes()
        indices = {name: len(accessors) - 3 + k for k, name in enumerate(attributes)}
        meshes.append({"primitives": [{"attributes": indices, "material": i}]})
    lights, light_nodes = lights_of(setup)
    nodes = [{"mesh": i} for i in range(len(meshes))]
    nodes += [{**node, "extensions": {"KHR_lights_punctual": {"light": i}}} for i, node in enumerate(light_nodes)]
    white = io.BytesIO()
    PIL.Image.new("RGB", (4, 4), "white").save(white, "PNG")
    gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes,
            "meshes": meshes, "materials": [material_of(shape, setup.matt, opacity) for shape in setup.shapes],
            "buffers": [{"byteLength": len(buffer)}], "bufferViews": views, "accessors": accessors, "textures": [{"source": 0}],
            "extensionsUsed": ["KHR_materials_ior", "KHR_lights_punctual"], "extensions": {"KHR_lights_punctual": {"lights": lights}},
            "images": [{"uri": "data:image/png;base64," + base64.b64encode(white.getvalue()).decode()}]}
    text = json.dumps(gltf).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(buffer)))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text)
        file.write(struct.pack("<I4s", len(buffer), b"BIN\0") + buffer)


def write_hdr(sky, path):
    """Radiance, of pixels one after another."""
    height, width, _ = sky.shape
    exponent = np.ceil(np.log2(np.maximum(sky.max(-1), 1e-20) * 1.004))
    pixels = np.concatenate([np.rint(sky * 2.0 ** (8 - exponent)[..., None]), exponent[..., None] + 128], -1)
    with open(path, "wb") as file:
        file.write(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode())
        file.write(np.clip(pixels, 0, 255).astype(np.uint8).tobytes())


def draw(setup, cache, occlusion=False, ambient=0.0, opacity=light_scenes.OPACITIES[0]):
    engine = f3d.Engine.create(True)
    engine.cache_path = cache
    engine.window.size = SIZE
    options = engine.options
    options["render.background.color"] = [0.0, 0.0, 0.0]
    options["render.effect.ambient_occlusion"] = occlusion
    options["render.effect.blending.mode"] = "ddp"
    with tempfile.TemporaryDirectory() as folder:
        if setup.sky is not None or ambient:
            sky = setup.sky if setup.sky is not None else np.full((64, 128, 3), ambient, np.float32)  # of fewer pixels it fails
            write_hdr(np.roll(sky * setup.exposure, -sky.shape[1] // 4, axis=1), folder + "/sky.hdr")
            options["render.hdri.file"] = folder + "/sky.hdr"
            options["render.hdri.ambient"] = True
        write_glb(setup, opacity, folder + "/scene.glb")
        engine.scene.add(folder + "/scene.glb")
        camera = engine.window.camera
        camera.position, camera.focal_point, camera.view_up = setup.position, setup.target, (0.0, 1.0, 0.0)
        camera.view_angle = setup.fov_y_deg
        image = engine.window.render_to_image()
    pixels = np.frombuffer(image.content, np.uint8).reshape(image.height, image.width, image.channel_count)[::-1, :, :3]
    # Its shaders take the root of 2.2.
    return light_scenes.averaged((pixels / 255.0) ** 2.2, SUPERSAMPLING)


def main():
    f3d.Log.set_verbose_level(f3d.Log.VerboseLevel.QUIET)
    with tempfile.TemporaryDirectory() as cache:
        def draw_all(setup):
            return {f"occlusion {occlusion}, ambient {ambient}, opacity {opacity}": draw(setup, cache, occlusion, ambient, opacity)
                    for occlusion, ambient, opacity in itertools.product(
                        (False, True), light_scenes.ambient_of(setup), light_scenes.opacities_of(setup))}

        light_scenes.draw_each(pathlib.Path(sys.argv[1]), "f3d", draw_all)


if __name__ == "__main__":
    main()

"""The half of bench/light.py that Mitsuba 3 draws, in the environment of scripts/oracle.sh.

usage: light_mitsuba.py FOLDER | --references FOLDER
The references of bench/light_peers.py are two means of half the samples each; those that FOLDER has are kept.
"""
import os
import pathlib
import sys
import time

import mitsuba as mi
import numpy as np

import light
import light_scenes

SAMPLES = (1, 2, 4, 8, 16, 36, 64, 144, 256)  # as multijitter takes them
REFERENCE_SAMPLES = 256  # of a pass
BETWEEN_HALVES = 0.015  # FLIP; that of noise in their mean is below 0.01


def bsdf(shape, as_gltf):
    color = {"type": "rgb", "value": [float(c) for c in shape.color]}
    metallic = {light_scenes.CONDUCTOR: 1.0, light_scenes.PLASTIC: 0.0}.get(shape.kind)
    if as_gltf and metallic is not None:
        return {"type": "gltf", "base_color": color, "roughness": shape.roughness, "metallic": metallic}
    if shape.kind == light_scenes.CONDUCTOR:
        return {"type": "roughconductor", "material": "none", "distribution": "ggx", "alpha": shape.roughness ** 2,
                "specular_reflectance": color}
    if shape.kind == light_scenes.PLASTIC:
        return {"type": "principled", "base_color": color, "roughness": shape.roughness, "specular": 0.5}
    if shape.kind == light_scenes.GLASS:
        rough = {"type": "roughdielectric", "distribution": "ggx", "alpha": shape.roughness ** 2} if shape.roughness else {}
        return {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0, **rough}
    return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": color}}


def mesh(shape, as_gltf):
    properties = mi.Properties()
    properties["bsdf"] = mi.load_dict(bsdf(shape, as_gltf))
    if shape.emission:
        properties["emitter"] = mi.load_dict({"type": "area", "radiance": {"type": "rgb", "value": shape.emission}})
    made = mi.Mesh("shape", len(shape.V), len(shape.F), props=properties)
    parameters = mi.traverse(made)
    parameters["vertex_positions"] = np.ascontiguousarray(shape.V, np.float32).ravel()
    parameters["faces"] = np.ascontiguousarray(shape.F, np.uint32).ravel()
    parameters.update()
    return made


def scene_of(setup, as_gltf=False):
    """Metals and dielectrics are Mitsuba's own, which cost less, or those of glTF, which the other renderers have."""
    transform = mi.ScalarTransform4f()
    scene = {
        "type": "scene", "integrator": {"type": "path", "max_depth": 9, "hide_emitters": not setup.shows_emitters},
        "sensor": {
            "type": "perspective", "fov": setup.fov_y_deg, "fov_axis": "y",
            "to_world": transform.look_at(origin=list(setup.position), target=list(setup.target), up=[0, 1, 0]),
            "film": {"type": "hdrfilm", "width": light_scenes.SIZE[0], "height": light_scenes.SIZE[1],
                     "pixel_format": "rgba", "rfilter": {"type": "box"}},
            "sampler": {"type": "multijitter"},
        },
    }
    if setup.sky is not None:
        scene["sky"] = {"type": "envmap", "bitmap": mi.Bitmap(setup.sky), "to_world": transform.rotate([0, 1, 0], 180)}
    for i, (position, intensity) in enumerate(setup.lamps):
        scene[f"lamp{i}"] = {"type": "point", "position": list(position), "intensity": {"type": "rgb", "value": intensity}}
    for i, shape in enumerate(setup.shapes):
        scene[f"shape{i}"] = mesh(shape, as_gltf)
    return mi.load_dict(scene)


def render(scene, samples, seed):
    """The picture and the CPU seconds that it took."""
    start = time.process_time()
    picture = np.array(mi.render(scene, spp=samples, seed=seed))
    return picture, time.process_time() - start


def passes(scene, samples, first=0):
    return [render(scene, REFERENCE_SAMPLES, 100 + first + i)[0] for i in range(samples // REFERENCE_SAMPLES)]


def reference(scene, setup):
    """Two means of as many samples each, which are so many that hardly anything is between them."""
    sums, count = np.zeros((2, *reversed(light_scenes.SIZE), 4)), 0
    while True:
        for picture in passes(scene, setup.limit_samples, count):
            sums[count % 2] += picture
            count += 1
        means = 2 * sums / count
        if light.flip(*(light_scenes.displayed(mean, setup.exposure) for mean in means)) <= BETWEEN_HALVES:
            return means


def write_references(folder):
    for name, setup in light_scenes.read_all(folder).items():
        path = folder / f"reference {name}.npy"
        if not path.exists():
            np.save(path, reference(scene_of(setup, as_gltf=True), setup))
        print(f"... reference: {name}", file=sys.stderr, flush=True)


def main():
    variant = os.environ["MITSUBA_VARIANT"]
    mi.set_variant(variant)
    from gltf_bsdf import GltfBsdf  # needs a variant

    mi.register_bsdf("gltf", GltfBsdf)
    if sys.argv[1] == "--references":
        write_references(pathlib.Path(sys.argv[2]))
        return
    folder = pathlib.Path(sys.argv[1])
    for name, setup in light_scenes.read_all(folder).items():
        scene = scene_of(setup)
        render(scene, 1, 0)  # compiles kernels
        drawn = {(samples, "off"): render(scene, samples, 1) for samples in SAMPLES}
        if variant.startswith("llvm"):
            drawn[0, "off"] = np.mean(passes(scene, setup.limit_samples), axis=0), 0
        np.save(folder / f"{variant} {name}.npy", drawn)
        print(f"... {variant}: {name}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()

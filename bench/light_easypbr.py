"""The half of bench/light.py that EasyPBR draws. usage: light_easypbr.py --setups FOLDER DATA [SCENE...] | FOLDER | --default FOLDER"""
import pathlib
import sys
import time

import light_scenes
import numpy as np

import easypbr
from easypbr import Material, Mesh, Scene, Viewer

SAMPLES = (1, 2, 4, 8, 16, 32, 64, 128, 256)
DENOISED_SAMPLES = (1, 2, 4, 8, 16, 32)


def write_setups(folder, data, names):
    sky, studio = (np.ascontiguousarray(easypbr.load_image(data / f"env/{name}.hdr")[:, :, :3], np.float32)
                   for name in ("monument_valley", "studio"))
    head = Mesh(data / "head.obj")
    setups = {**light_scenes.rooms(), "open box": light_scenes.pit(sky), **light_scenes.balls(sky),
              **light_scenes.figures(np.asarray(head.V), np.asarray(head.F), sky, studio)}
    np.save(folder / "setups.npy", {name: setups[name] for name in names or setups})


def view_of(setup):
    scene = Scene()
    for i, shape in enumerate(setup.shapes):
        mesh = Mesh(shape.V, shape.F)
        mesh.material = Material(base_color=shape.color, metallic=float(shape.kind == light_scenes.CONDUCTOR),
                                 roughness=shape.roughness, emissive=(shape.emission,) * 3)
        if shape.kind == light_scenes.DIFFUSE and not setup.matt:
            mesh.material.specular = 0.0
        if shape.kind == light_scenes.GLASS:
            mesh.material.transmission = mesh.material.thickness = 1.0
            mesh.material.ior = 1.5
        mesh.style.flat = True  # as Mitsuba draws what has no normals
        scene.show(mesh, f"shape{i}")
    view = Viewer(light_scenes.SIZE, {
        "camera": {"position": setup.position, "target": setup.target, "fov_y_deg": setup.fov_y_deg},
        "shading": {"dielectric_f0": 0.0 if setup.matt else 0.04, "multiple_scattering": False}, "background": {"mode": "transparent"},
        "environment": {"enabled": setup.sky is not None, "sun": False}, "path": {"enabled": True, "bounces": 8}}, scene)
    if setup.sky is not None:
        view.load_environment_map(setup.sky)
    for name in ("key", "fill", "rim"):
        view.lights[name].enabled = False
    for i, (position, intensity) in enumerate(setup.lamps):
        view.add_light(f"lamp{i}", position=position, intensity=intensity, radius=0)
    return view


def draw(setup):
    """By number of samples and denoiser: (picture, CPU seconds). 0 samples: the limit."""
    view = view_of(setup)

    def drawn(samples, denoise):
        view.settings.path.denoise = denoise
        start = time.process_time()
        picture = view.render(samples=samples, hdr=True)
        return picture, time.process_time() - start

    drawn(1, "off")
    pictures = {(samples, "off"): drawn(samples, "off") for samples in SAMPLES}
    pictures |= {(samples, "filter"): drawn(samples, "filter") for samples in DENOISED_SAMPLES}
    view.settings.path.clamp = 0
    pictures[0, "off"] = drawn(setup.limit_samples, "off")
    return pictures


def draw_default(setup):
    """Of 8 samples, denoised."""
    view = view_of(setup)
    view.settings.path.denoise = "filter"
    return {"default": view.render(samples=8, hdr=True)[:, :, :3] * setup.exposure}


def main():
    if sys.argv[1] == "--setups":
        write_setups(pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]), sys.argv[4:])
        return
    if sys.argv[1] == "--default":
        light_scenes.draw_each(pathlib.Path(sys.argv[2]), "default", draw_default)
        return
    folder = pathlib.Path(sys.argv[1])
    for name, setup in light_scenes.read_all(folder).items():
        np.save(folder / f"easypbr {name}.npy", draw(setup))
        print(f"... easypbr: {name}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Draws the pictures of the documentation, headless, from content that is made in code.

usage: write_pictures.py [OUTPUT_FOLDER]      default: docs/images; the easypbr package must be importable
"""
import importlib
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import compare_devices
import easypbr
from easypbr import Material, Mesh, Scene, Viewer, shapes

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "examples/figures"))


def sky(width: int = 512) -> np.ndarray:
    """An equirectangular evening: blue above, orange at the horizon, a low sun, dark ground."""
    height = width // 2
    elevation = np.pi * (0.5 - (np.arange(height) + 0.5) / height)
    azimuth = 2 * np.pi * (np.arange(width) + 0.5) / width
    up = np.sin(elevation)[:, None, None]
    horizon = np.exp(-8 * np.abs(up)) * np.array([1.3, 0.75, 0.4])
    dome = np.where(up > 0, np.array([0.25, 0.45, 0.9]), np.array([0.12, 0.1, 0.08])) * (0.4 + 0.6 * np.abs(up))
    # The sun: 3 degrees wide, to the left behind the viewer of the default camera.
    toward_sun = np.sin(elevation)[:, None] * np.sin(0.35) + np.cos(elevation)[:, None] * np.cos(0.35) * np.cos(
        azimuth[None, :] - 5.6
    )
    sun = (toward_sun > np.cos(np.radians(3)))[:, :, None] * np.array([600.0, 420.0, 250.0])
    return (horizon + dome + sun).astype(np.float32)


def figure(name: str):
    """A figure of examples/figures, drawn without data."""
    module = importlib.import_module(name)

    def draw() -> np.ndarray:
        return module.draw(None, 1.0)

    draw.__name__ = name
    return draw


FIGURES = [figure(name) for name in ("eye_dome_lighting", "surfel_steps", "bunny_surfels", "labelled_street", "plants",
                                     "all_kinds", "scalar_field", "colormaps", "slices", "shadows_and_occlusion", "gltf_materials",
                                     "figure_10", "transparent_shadows", "splats", "splat_dataset", "depth_image",
                                     "vector_field")]


def row(pictures) -> np.ndarray:
    """Pictures side by side with a white gap."""
    pictures = [picture[:, :, :3] for picture in pictures]
    gap = np.full((pictures[0].shape[0], 6, 3), 255, np.uint8)
    parts = [part for picture in pictures for part in (picture, gap)][:-1]
    return np.hstack(parts)


def teapot(color: str = "#b03a2e", metallic: float = 0.0, roughness: float = 0.25) -> Mesh:
    mesh = shapes.teapot(1.0)
    mesh.material = Material(base_color=color, metallic=metallic, roughness=roughness)
    return mesh


def on_floor(mesh: Mesh) -> Scene:
    scene = Scene()
    scene.show(mesh, "object")
    floor = shapes.plane(2.2)
    floor.material = Material(base_color="#8a8a8a", roughness=0.6)
    scene.show(floor, "floor")
    return scene


def window_of(size, samples=16) -> Viewer:
    """A viewer with a few things to look at, one of them selected."""
    scene = on_floor(teapot("#b03a2e", 0, 0.25))
    ball = shapes.sphere(0.2)
    ball.material = Material(base_color="#d9b54a", metallic=1, roughness=0.3)
    ball.T_parent_mesh = [[1, 0, 0, -0.6], [0, 1, 0, 0.2], [0, 0, 1, 0.5], [0, 0, 0, 1]]
    scene.show(ball, "ball")
    return Viewer(size, {"image": {"samples": samples}, "camera": {"elevation_deg": 20}}, scene=scene)


def viewer() -> np.ndarray:
    """The window, a ball selected."""
    view = window_of((1120, 700))
    view._handle.set_gui("object", "ball")
    return view.screenshot()[:, :, :3]


def viewer_slices() -> np.ndarray:
    """The window with light panels, its G-buffer in slices."""
    view = window_of((1120, 620))
    view._handle.set_gui("light_theme", True)
    view._handle.set_gui("channel", "slices")
    view._handle.set_gui("Effects", False)
    return view.screenshot()[:, :, :3]


def viewer_path() -> np.ndarray:
    """The panels of camera path and recorder, a path of four keys around a teapot."""
    view = Viewer((1120, 740), {"image.samples": 16}, on_floor(teapot("#c8b89a", roughness=0.6)))
    view.scene.get("floor").scale(2.5)
    keys = [easypbr.Camera.look_at((2 * np.sin(a), 0.4 + 0.4 * i, 2 * np.cos(a)), (0, 0.45, 0), fov_y_deg=35)
            for i, a in enumerate(np.radians([-40, 25, 90, 160]))]
    view.camera_path = easypbr.CameraPath(keys, segment_s=1.5)
    view.camera = easypbr.Camera.look_at((2.9, 3, 5), (-0.3, 0.5, 0), fov_y_deg=35)
    view.show_panels("Scene", "Camera path", "Recorder")
    return view.screenshot()[:, :, :3]


def pot_with_animations(folder: str) -> str:
    """A glTF file with a teapot and two animations of it."""
    pot = teapot("#c8b89a")
    times = np.linspace(0, 2, 9, dtype=np.float32)
    half = np.radians(45) * np.arange(9) / 2
    turn = np.stack([0 * half, np.sin(half), 0 * half, np.cos(half)], axis=1)
    lean = np.radians(-25) * np.sin(np.pi * times / 2) ** 2
    pour = np.stack([0 * lean, 0 * lean, np.sin(lean / 2), np.cos(lean / 2)], axis=1)
    arrays = [np.asarray(pot.V, np.float32), np.asarray(pot.N, np.float32), np.asarray(pot.F, np.uint32).reshape(-1, 1), times[:, None],
              turn.astype(np.float32), pour.astype(np.float32)]
    kinds = [("VEC3", 5126), ("VEC3", 5126), ("SCALAR", 5125), ("SCALAR", 5126), ("VEC4", 5126), ("VEC4", 5126)]
    starts = np.cumsum([0] + [a.nbytes for a in arrays])
    document = {
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "scene": 0, "nodes": [{"mesh": 0, "name": "pot"}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.05, 0.03, 1], "metallicFactor": 0, "roughnessFactor": 0.3}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": 0}]}],
        "animations": [
            {"name": name, "samplers": [{"input": 3, "output": output}],
             "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}]}
            for name, output in (("Turn", 4), ("Pour", 5))],
        "accessors": [
            {"bufferView": i, "componentType": component, "count": len(array), "type": kind,
             **({"min": array.min(0).tolist(), "max": array.max(0).tolist()} if i in (0, 3) else {})}
            for i, (array, (kind, component)) in enumerate(zip(arrays, kinds))],
        "bufferViews": [{"buffer": 0, "byteOffset": int(start), "byteLength": array.nbytes} for start, array in zip(starts, arrays)],
        "buffers": [{"byteLength": int(starts[-1]), "uri": "pot.bin"}],
    }
    pathlib.Path(folder, "pot.bin").write_bytes(b"".join(array.tobytes() for array in arrays))
    pathlib.Path(folder, "pot.gltf").write_text(json.dumps(document))
    return f"{folder}/pot.gltf"


def viewer_animations() -> np.ndarray:
    """The panel of animations, one of a file's two going on."""
    with tempfile.TemporaryDirectory() as folder:
        pot = easypbr.load_scene(pot_with_animations(folder))
    view = Viewer((1120, 560), {"image.samples": 16}, on_floor(pot.mesh))
    view.scene.get("floor").scale(2.5)
    view.camera = easypbr.Camera.look_at((1.1, 1.5, 3.6), (-0.25, 0.3, 0), fov_y_deg=35)
    view.play(pot.animations, "Pour")
    view.fixed_step = 0.25
    for _ in range(3):
        view._handle.tick()
    view.show_panels("Scene", "Object", "Animations")
    return view.screenshot()[:, :, :3]


def viewer_lights() -> np.ndarray:
    """The panels of lights, environment, camera and statistics."""
    view = window_of((1120, 900))
    view.scene.set_light("lamp", easypbr.Light("point", position=(1.2, 1.6, 1.4), intensity=14))
    view.show_panels("Lights", "Environment", "Camera", "Statistics")
    return view.screenshot()[:, :, :3]


def viewer_own() -> np.ndarray:
    """A panel of one's own, images and a camera with its image."""
    view = window_of((1280, 760))
    view._handle.set_gui("Effects", False)
    random = np.random.default_rng(0)
    losses = np.exp(-np.arange(300) / 70) + 0.04 * random.normal(size=300)
    picture = view.render((160, 120), samples=8)[:, :, :3]

    @view.add_panel("Training")
    def training(ui):
        ui.text("Epoch 12 of 40")
        ui.progress(0.3, "30 %")
        ui.slider("learning rate", 0.1, 0.0, 1.0)
        ui.checkbox("augment", True)
        ui.combo("optimizer", "Adam", ["SGD", "Adam"])
        ui.plot("loss", losses)
        ui.button("Forget")

    view.show_image("prediction", picture)
    view.show_image("error", random.random((30, 40)) ** 4, colormap="magma")
    return view.screenshot()[:, :, :3]


def demo() -> np.ndarray:
    """What `easypbr demo` draws, its camera included, smaller."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "demo.png"
        command = [sys.executable, "-m", "easypbr", "demo", "-o", path, "--size", "960x540"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        return easypbr.load_image(path)


def materials() -> np.ndarray:
    """Roughness from left to right, dielectric above, metal below."""
    scene = Scene()
    ball = shapes.sphere(0.46, 96)
    for line, (color, metallic) in enumerate([("#c23b22", 0), ("#d9d9d9", 0), ("#ffe29b", 1), ("#f7a58c", 1)]):
        for column, roughness in enumerate(np.linspace(0.05, 1, 7)):
            mesh = ball.clone()
            mesh.material = Material(base_color=color, metallic=metallic, roughness=roughness)
            mesh.T_parent_mesh = [[1, 0, 0, column], [0, 1, 0, -line], [0, 0, 1, 0], [0, 0, 0, 1]]
            scene.show(mesh, f"{line}-{column}")
    values = {"camera": {"azimuth_deg": 0, "elevation_deg": 0, "fov_y_deg": 12}}
    return Viewer((700, 400), values, scene).render(samples=64)


def lights() -> np.ndarray:
    """Studio and three-point lights; the lights alone; an environment alone; one spot light."""
    given = easypbr.Environment(sky())
    views = [Viewer((280, 210), scene=on_floor(teapot())) for _ in range(4)]
    views[1].settings.environment.enabled = False
    views[2].load_environment_map(given)
    views[3].settings.environment.enabled = False
    for name in ("key", "fill", "rim"):
        views[3].lights[name].enabled = False
    views[3].add_light("spot", "spot", position=(1.5, 2.5, 1.5), direction=(-1.5, -2.1, -1.5), intensity=60,
                       inner_cone_deg=10, outer_cone_deg=18)
    return row(view.render() for view in views)


def area_lights() -> np.ndarray:
    """Rectangle, disc, sphere: rasterised and path traced."""
    rows = []
    for paths in (False, True):
        views = []
        for kind in ("rectangle", "disc", "sphere"):
            values = {"environment.enabled": False, "path.enabled": paths, "background.color": "#303030"}
            view = Viewer((280, 210), values, on_floor(teapot("#d9b77a", 1, 0.15)))
            view.lights["key"].enabled = False
            view.add_light("lamp", kind, position=(-1.0, 1.5, 1.7), direction=(1.0, -1.1, -1.7), size=(0.6, 1.7), width_axis=(1.7, 0, 1.0),
                           radius=0.56, intensity=8)
            views.append(view)
        rows.append(row(view.render(samples=64) for view in views))
    return np.concatenate(rows)


def backgrounds() -> np.ndarray:
    """Colour, environment, environment blurred."""
    return row(
        easypbr.render(teapot("#dddddd", 1, 0.1), size=(280, 210), environment=sky(1024), background=background)
        for background in ("#404040", "environment", "blur")
    )


def tone_curves() -> np.ndarray:
    """The five curves, two stops over: where they differ is in the lights."""
    mesh = teapot("#1f4fd8", 0, 0.3)
    return row(
        easypbr.render(mesh, size=(200, 160), tonemap=operator, exposure_compensation=2)
        for operator in ("aces", "reinhard", "agx", "neutral", "none")
    )


def antialiasing() -> np.ndarray:
    """A tilted box, five times as large: one frame, one frame with FXAA, 16 frames."""
    box = shapes.box()
    cosine, sine = np.cos(0.3), np.sin(0.3)
    box.T_parent_mesh = [[cosine, -sine, 0, 0], [sine, cosine, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    pictures = []
    for samples, antialias in ((1, "none"), (1, "fxaa"), (16, "fxaa")):
        picture = easypbr.render(box, size=(56, 42), samples=samples, antialias=antialias)
        pictures.append(picture.repeat(5, axis=0).repeat(5, axis=1))
    return row(pictures)


def layers() -> np.ndarray:
    """Picture, albedo, normal, depth, roughness."""
    view = Viewer((200, 150), scene=on_floor(teapot()))
    found = view.layers(["albedo", "normal_world", "depth", "roughness"])
    seen = found["depth"] > 0
    depth = np.zeros_like(found["depth"])
    depth[seen] = 1 - (found["depth"][seen] - found["depth"][seen].min()) / np.ptp(found["depth"][seen])
    shown = [found["albedo"][:, :, :3] ** (1 / 2.2), (found["normal_world"] * 0.5 + 0.5) * seen[:, :, None]]
    shown += [np.repeat(plane[:, :, None], 3, axis=2) for plane in (depth, found["roughness"])]
    return row([view.render(), *((np.clip(plane, 0, 1) * 255).astype(np.uint8) for plane in shown)])


def fits() -> np.ndarray:
    """The automatic camera: default, from above, narrow margin, orthographic."""
    choices = [{}, {"elevation_deg": 60}, {"margin": 0.4}, {"projection": "orthographic"}]
    return row(easypbr.render(teapot(), size=(230, 170), settings={"camera": choice}) for choice in choices)


def shading() -> np.ndarray:
    """Smooth and flat."""
    mesh = shapes.teapot(1.0, 4)
    return row(easypbr.render(mesh, size=(280, 210), flat=flat) for flat in (False, True))


def ambient_occlusion() -> np.ndarray:
    """Without, with, and the visibility."""
    view = Viewer((290, 220), {"path": {"enabled": False}}, on_floor(teapot("#d8d2c4", 0, 0.6)))
    view.load_environment_map(np.full((16, 32, 3), 1.0, np.float32))
    visibility = view.layers(["ambient_occlusion"])["ambient_occlusion"]
    with_occlusion = view.render()
    view.settings.ssao.enabled = False
    grey = np.where(view.layers(["depth"])["depth"] > 0, visibility, 0.25) * 255
    return row([view.render(), with_occlusion, np.repeat(grey.astype(np.uint8)[:, :, None], 3, axis=2)])


def rays() -> np.ndarray:
    """Ambient occlusion, and rays."""
    scene = on_floor(teapot("#e8e4da", 1, 0.1))
    for name, place, color, metallic in (("ball", (-0.85, 0.22, 0.45), "#c03020", 0), ("box", (0.55, 0.25, -0.75), "#3878c0", 0)):
        mesh = shapes.sphere(0.22) if name == "ball" else shapes.box((0.9, 0.5, 0.3))
        mesh.material = Material(base_color=color, metallic=metallic, roughness=0.6)
        mesh.translate(place)
        scene.show(mesh, name)
    view = Viewer((430, 320), scene=scene)
    view.load_environment_map(sky())
    pictures = []
    for traced in (False, True):
        view.settings.rays.enabled = traced
        pictures.append(view.render(samples=64))
    return row(pictures)


def open_box(pot: Mesh) -> Viewer:
    """A pot in a box that is open above and in front, under a sky."""
    scene = Scene()
    sides = {"floor": ((2, 0.04, 2), (0, 0, 0), "#d8d4cc"), "back": ((2, 1.4, 0.04), (0, 0.7, -1), "#d8d4cc"),
             "left": ((0.04, 1.4, 2), (-1, 0.7, 0), "#c03020"), "right": ((0.04, 1.4, 2), (1, 0.7, 0), "#3878c0")}
    for name, (size, place, color) in sides.items():
        side = shapes.box(size)
        side.material = Material(base_color=color, roughness=1)
        side.translate(place)
        scene.show(side, name)
    pot.translate((0, 0.02, 0))
    scene.show(pot, "pot")
    view = Viewer((290, 220), {"camera": {"azimuth_deg": 0, "elevation_deg": 20}}, scene)
    view.load_environment_map(sky())
    return view


def modes() -> np.ndarray:
    """Rasterised; path traced by default; with 256 samples. A matt pot, and one of metal."""
    rows = []
    for metallic, roughness in ((0, 0.6), (1, 0.15)):
        view = open_box(teapot("#e8e4da", metallic, roughness))
        pictures = []
        for enabled, samples in ((False, 16), (True, 8), (True, 256)):
            view.settings.path.enabled = enabled
            pictures.append(view.render(samples=samples))
        rows.append(row(pictures))
    return np.vstack([rows[0], np.full((6, rows[0].shape[1], 3), 255, np.uint8), rows[1]])


def paths() -> np.ndarray:
    """Path tracing with few samples, noisy and denoised, and with many: an open box under a sky."""
    view = open_box(teapot("#e8e4da", 0, 0.3))
    view.settings.path.enabled = True
    pictures = []
    for denoise, samples in (("off", 8), ("filter", 8), ("filter", 256)):
        view.settings.path.denoise = denoise
        pictures.append(view.render(samples=samples))
    return row(pictures)


def fireflies() -> np.ndarray:
    """A closed room with a block of gold: bright pixels of few samples, the same with their light spread, many samples."""
    scene = Scene()
    white, gold = Material(base_color="#d8d4cc", roughness=1), Material(base_color="#ffc557", metallic=1, roughness=0.15)
    for name, size, place, material in (
            ("floor", (2, 0.05, 2), (0, -1, 0), white), ("ceiling", (2, 0.05, 2), (0, 1, 0), white), ("back", (2, 2, 0.05), (0, 0, -1), white),
            ("left", (0.05, 2, 2), (-1, 0, 0), Material(base_color="#c03020", roughness=1)),
            ("right", (0.05, 2, 2), (1, 0, 0), Material(base_color="#3878c0", roughness=1)), ("block", (0.55, 1.1, 0.55), (-0.35, -0.43, -0.35), gold),
            ("lamp", (0.4, 0.02, 0.4), (0, 0.96, 0), Material(base_color="#000000", emissive=(12, 12, 12)))):
        part = shapes.box(size)
        part.material = material
        part.translate(place)
        scene.show(part, name)
    view = Viewer((290, 290), {"camera": {"position": (0, 0, 4.4), "target": (0, 0, 0), "fov_y_deg": 28}, "environment": {"enabled": False},
                               "path": {"enabled": True, "denoise": "off"}}, scene)
    for lamp in ("key", "fill", "rim"):
        view.lights[lamp].enabled = False
    pictures = []
    for clamp, samples in ((0, 16), (0.25, 16), (0, 1024)):
        view.settings.path.clamp = clamp
        pictures.append(view.render(samples=samples))
    return row(pictures)


def bloom() -> np.ndarray:
    """Without, with a threshold, with a tenth of all light spread."""
    scene = on_floor(teapot("#ffe29b", 1, 0.2))
    lamp = shapes.sphere(0.08)
    lamp.material = Material(base_color="#000000", emissive=(60, 30, 10))
    lamp.T_parent_mesh = [[1, 0, 0, 0.75], [0, 1, 0, 0.12], [0, 0, 1, 0.5], [0, 0, 0, 1]]
    scene.show(lamp, "lamp")
    view = Viewer((290, 220), {"environment": {"intensity": 0.3}}, scene)
    pictures = [view.render()]
    view.settings.bloom.enabled = True
    pictures.append(view.render())
    view.settings.update({"bloom": {"threshold": 0, "intensity": 0.1}})
    return row([*pictures, view.render()])


def outlines() -> np.ndarray:
    """Without and with outlines; outlines of unlit white, as in a drawing."""
    scene = Scene()
    meshes = {"torus": shapes.torus(), "box": shapes.box(), "pot": teapot("#3f7f5f")}
    meshes["torus"].material = Material(base_color="#b03a2e", roughness=0.5)
    meshes["box"].material = Material(base_color="#d9a441", roughness=0.5)
    for (name, mesh), x in zip(meshes.items(), (-1.3, 0, 1.6)):
        mesh.T_parent_mesh = [[1, 0, 0, x], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
        scene.show(mesh, name)
    view = Viewer((290, 220), {"rays": {"enabled": False}}, scene)
    pictures = [view.render()]
    view.settings.outline.enabled = True
    pictures.append(view.render())
    for name in scene.names():
        scene.get(name).material = Material(base_color="#ffffff", unlit=True)
    view.settings.background.color = "#ffffff"
    return row([*pictures, view.render()])


def depth_of_field() -> np.ndarray:
    """A row of teapots: without, focused on the nearest, on the farthest."""
    scene = Scene()
    for place, color in enumerate(("#b03a2e", "#d9a441", "#3f7f5f", "#2f5f9f", "#6f4f8f")):
        mesh = teapot(color)
        mesh.T_parent_mesh = [[1, 0, 0, 0.8 * place], [0, 1, 0, 0], [0, 0, 1, -1.6 * place], [0, 0, 0, 1]]
        scene.show(mesh, str(place))
    view = Viewer((290, 220), {"camera": {"azimuth_deg": 0, "elevation_deg": 12}}, scene)
    pictures = [view.render()]
    depth = view.layers(["depth"])["depth"]
    view.settings.update({"depth_of_field": {"enabled": True, "f_number": 2.5}})
    for distance in (depth[depth > 0].min() * 1.1, depth.max() * 0.95):
        view.settings.depth_of_field.focus_distance = float(distance)
        pictures.append(view.render(samples=64))
    return row(pictures)


def geometry() -> np.ndarray:
    """A teapot; simplified; as surfels estimated from bare points; as voxels."""
    mesh = teapot("#c8a15a", 0, 0.35)
    simple = mesh.remove_duplicate_vertices(keep_seams=False).decimate(faces=800)
    simple.style.flat = True
    cloud = Mesh()
    cloud.V = mesh.sample_surface(30000).V
    surfels = cloud.estimate_surfels()
    voxels = mesh.sample_surface(100000).voxelize(0.04)
    for derived in (surfels, voxels):
        derived.material = Material(base_color="#c8a15a", roughness=0.35)
    return row(easypbr.render(each, size=(260, 190)) for each in (mesh, simple, surfels, voxels))


def all_shapes() -> np.ndarray:
    """All shapes."""
    made = [shapes.box(0.8), shapes.sphere(0.45), shapes.icosphere(0.45, 1), shapes.cylinder(0.4, 0.8),
            shapes.cone(0.45, 0.9), shapes.torus(0.4, 0.15), shapes.capsule(0.25, 0.4), shapes.plane(0.9),
            shapes.grid(0.9, 6), shapes.arrow((0, -0.4, 0), (0.1, 0.45, 0.1), 0.03), shapes.axes(0.8, 0.02),
            shapes.teapot(0.55)]
    checker = (np.indices((64, 64)) // 8).sum(axis=0) % 2
    texture = np.array([[208, 160, 96], [120, 80, 60]], np.uint8)[checker]
    pictures = []
    for mesh in made:
        if len(mesh.UV) and not len(mesh.C):
            mesh.material = Material(base_color="#ffffff", base_color_texture=texture, roughness=0.4)
        pictures.append(easypbr.render(mesh, size=(150, 120), settings={"camera": {"elevation_deg": 25}}))
    return np.vstack([row(pictures[:6]), row(pictures[6:])])


def glass() -> np.ndarray:
    """A thin wall, solid, frosted, and coloured glass on a chequered floor."""
    scene = Scene()
    checker = (np.indices((256, 256)) // 32).sum(axis=0) % 2
    floor = shapes.plane(6)
    floor.material = Material(base_color="white", roughness=0.8,
                              base_color_texture=np.array([[70, 78, 98], [205, 196, 178]], np.uint8)[checker])
    scene.show(floor, "floor")
    box = shapes.box(0.5)
    box.material = Material(base_color="#c03020", roughness=0.4)
    box.T_parent_mesh = [[1, 0, 0, -0.7], [0, 1, 0, 0.25], [0, 0, 1, -1.3], [0, 0, 0, 1]]
    scene.show(box, "box")
    kinds = [{}, {"thickness": 1}, {"thickness": 1, "roughness": 0.3},
             {"thickness": 1, "attenuation_color": "#40c060", "attenuation_distance": 0.6}]
    for place, kind in enumerate(kinds):
        ball = shapes.sphere(0.5, 128)
        ball.material = Material(**{"base_color": "white", "roughness": 0, "transmission": 1} | kind)
        ball.T_parent_mesh = [[1, 0, 0, 1.15 * (place - 1.5)], [0, 1, 0, 0.5], [0, 0, 1, 0], [0, 0, 0, 1]]
        scene.show(ball, f"ball {place}")
    camera = {"position": (0, 1.9, 5.2), "target": (0, 0.4, 0), "fov_y_deg": 21}
    view = Viewer((880, 330), {"camera": camera}, scene)
    view.load_environment_map(sky(1024))
    view.settings.background.mode = "environment"
    return view.render(samples=64)


def camera_path() -> np.ndarray:
    """A path of four keys around a teapot on a pedestal, as its curve and its cameras."""
    scene = on_floor(teapot("#c8b89a", roughness=0.6))
    floor = scene.get("floor")
    floor.scale(2.5)
    keys = [easypbr.Camera.look_at((2 * np.sin(a), 0.4 + 0.4 * i, 2 * np.cos(a)), (0, 0.45, 0), fov_y_deg=35)
            for i, a in enumerate(np.radians([-40, 25, 90, 160]))]
    path = easypbr.CameraPath(keys)
    scene.show(shapes.camera_path(path, size=(16, 9), depth=0.4), "path")
    view = Viewer((640, 360), {"style.line_color": "#ff6a00", "style.line_width": 2.5}, scene)
    view.camera = easypbr.Camera.look_at((3.4, 2.8, 5), (0.1, 0.5, 0), fov_y_deg=30)
    return view.render()


def shadows() -> np.ndarray:
    """None, 3x3, soft in one frame, soft in 64."""
    view = Viewer((220, 170), {"path": {"enabled": False}}, on_floor(teapot("#d8d2c4", 0, 0.6)))
    view.settings.environment.intensity = 0.4
    for name in ("fill", "rim"):
        view.lights[name].enabled = False
    pictures = []
    for mode, samples in (("none", 1), ("pcf", 1), ("soft", 1), ("soft", 64)):
        view.settings.shadows.enabled = mode != "none"
        view.settings.shadows.mode = mode if mode != "none" else "soft"
        pictures.append(view.render(samples=samples))
    return row(pictures)


def ground() -> np.ndarray:
    """A shadow on white, on an environment; a plane."""
    pictures = []
    for mode, background in (("shadow", "#ffffff"), ("shadow", "environment"), ("plane", "#b8c4d0")):
        scene = Scene()
        scene.show(teapot("#c8a15a", 0, 0.35), "teapot")
        view = Viewer((290, 220), {"ground": {"mode": mode, "plane_color": "#9098a0"}, "camera": {"margin": 0.25}}, scene)
        if background == "environment":
            view.load_environment_map(sky(1024))
            view.settings.background.mode = background
        else:
            view.settings.background.color = background
        pictures.append(view.render(samples=64))
    return row(pictures)


def drones() -> np.ndarray:
    """The contact sheet of the built-in data set, in smaller pictures and without their noise."""
    from easypbr.dataset import DatasetSpec, ImageSpec, PlacementSpec, SensorSpec, generate

    spec = DatasetSpec.demo()
    spec.count, spec.image, spec.placement = 10, ImageSpec((320, 240), 8), PlacementSpec(distance=(2.0, 4.5))
    spec.sensor = SensorSpec()
    with tempfile.TemporaryDirectory() as folder:
        generate(spec, folder, workers=1)
        return easypbr.load_image(pathlib.Path(folder) / "contact_sheet.png")


def trained(script: str, name: str) -> np.ndarray:
    """What an example of examples/training draws in the end."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, ROOT / "examples/training" / script], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        return easypbr.load_image(pathlib.Path(folder) / name)


def detection() -> np.ndarray:
    return trained("detect_drones.py", "detection.png")


def segmentation() -> np.ndarray:
    return trained("segment_clouds.py", "segmentation.png")


def own_shading() -> np.ndarray:
    """The picture of examples/07_own_shading.py."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, ROOT / "examples/07_own_shading.py"], cwd=folder, check=True)
        return easypbr.load_image(pathlib.Path(folder) / "own_shading.png")


def devices() -> np.ndarray:
    """Twelve scenes by the CPU, by OpenGL, and 64 times their difference."""
    return compare_devices.compare()[1]


def outline() -> np.ndarray:
    """What examples/cpp/outline.cpp draws, by the same shader."""
    scene = easypbr.Scene()
    teapot = easypbr.shapes.teapot()
    teapot.material.base_color = "#c8b89a"
    scene.show(teapot, "teapot")
    view = easypbr.Viewer((800, 600), scene=scene)
    text = (ROOT / "examples/cpp/outline.frag").read_text()
    # The program sets them.
    text = text.replace("uniform vec3 u_color;", "const vec3 u_color = vec3(0.02, 0.02, 0.03);")
    view.add_pass("outline", text.replace("uniform float u_width;", "const float u_width = 2.0;"))
    return view.render()


def assembly_drawing() -> str:
    """A shaft in its bearing, screwed onto a plate: SVG."""
    scene = Scene()

    def add(name: str, mesh: Mesh, position: tuple[float, float, float]) -> None:
        mesh.translate(position)
        scene.show(mesh, name)

    add("plate", shapes.box((4, 0.4, 4)), (0, 0, 0))
    add("flange", shapes.cylinder(1.5, 0.3), (0, 0.35, 0))
    add("bearing", shapes.cylinder(0.9, 1.1), (0, 1.05, 0))
    add("shaft", shapes.cylinder(0.4, 1.4), (0, 2.3, 0))
    add("journal", shapes.cylinder(0.4, 2.2), (0, 0.5, 0))
    for i, (x, z) in enumerate([(-1, -1), (-1, 1), (1, -1), (1, 1)]):
        add(f"head {i}", shapes.cylinder(0.24, 0.25, 6), (1.6 * x, 0.325, 1.6 * z))
        add(f"screw {i}", shapes.cylinder(0.12, 0.7), (1.6 * x, -0.1, 1.6 * z))
    view = Viewer((800, 600), {"camera.projection": "orthographic", "camera.elevation_deg": 30}, scene=scene)
    with tempfile.TemporaryDirectory() as folder:
        return view.save_svg(pathlib.Path(folder) / "assembly.svg").read_text()


PICTURES = [demo, materials, lights, area_lights, backgrounds, tone_curves, antialiasing, layers, fits, shading, ambient_occlusion, rays, modes, paths, fireflies,
            bloom, outlines, depth_of_field, geometry, all_shapes, glass, camera_path, shadows, ground, drones, viewer,
            viewer_slices, viewer_path, viewer_animations, viewer_lights, viewer_own, segmentation, detection, own_shading,
            outline, devices]
#: Vector graphics.
DRAWINGS = [assembly_drawing]


def file_name(draw) -> str:
    return f"{draw.__name__}.{'svg' if draw in DRAWINGS else 'png'}"


if __name__ == "__main__":
    if len(sys.argv) > 2 or sys.argv[1:] in (["-h"], ["--help"]):
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) == 2 else ROOT / "docs/images"
    folder.mkdir(parents=True, exist_ok=True)
    for draw in PICTURES + FIGURES:
        easypbr.save_image(draw(), folder / file_name(draw))
    for draw in DRAWINGS:
        (folder / file_name(draw)).write_text(draw())

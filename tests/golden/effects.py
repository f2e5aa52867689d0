"""What the golden pictures show: one small scene of generated shapes per effect."""
import numpy as np

from easypbr import Material, Mesh, Scene, Viewer, shapes

SIZE = (160, 120)
SAMPLES = 8
DARK = {f"lights.{name}.enabled": False for name in ("key", "fill", "rim")}
LOOK = {"camera.position": (3.2, 2.4, 4.6), "camera.target": (0.1, 0.45, 0.0), "camera.fov_y_deg": 30,
        "tonemap.exposure": 1.0, "ssao.enabled": False, "background.color": (0.25, 0.25, 0.25), "ground.mode": "none",
        "environment.intensity": 1, "lights.fill.enabled": True, "lights.rim.enabled": True}


def moved(mesh, x, y, z):
    mesh.translate((x, y, z))
    return mesh


def painted(mesh, **material):
    mesh.material = Material(**{"roughness": 0.5, **material})
    return mesh


def still_life():
    """A ball, a box and a torus on a floor."""
    scene = Scene()
    scene.show(painted(moved(shapes.box((6, 0.1, 6)), 0, -0.05, 0), base_color=(0.7, 0.68, 0.64)), "floor")
    scene.show(painted(moved(shapes.sphere(0.6, 64), -0.7, 0.6, 0.2), base_color=(0.75, 0.2, 0.15)), "ball")
    scene.show(painted(moved(shapes.box((0.7, 1.2, 0.7)), 0.8, 0.6, -0.5), base_color=(0.2, 0.45, 0.75)), "box")
    scene.show(painted(moved(shapes.torus(0.35, 0.12), 0.7, 0.12, 0.8), base_color=(0.9, 0.75, 0.3), metallic=1), "torus")
    return scene


def drawn(scene, settings=None, samples=SAMPLES):
    return Viewer(SIZE, {**LOOK, **(settings or {})}, scene=scene).render(samples=samples)


def shadows(mode, radius):
    scene = still_life()
    settings = {**LOOK, **DARK, "environment.enabled": False, "shadows.mode": mode, "shadows.resolution": 512}
    view = Viewer(SIZE, settings, scene=scene)
    view.add_light("lamp", position=(2.5, 4, 1.5), intensity=60, radius=radius)
    return view.render(samples=1)


def ambient_occlusion(method):
    return drawn(still_life(), {**DARK, "ssao.enabled": True, "ssao.radius": 0.8, "ssao.method": method}, 16)


def bloom(threshold):
    scene = still_life()
    scene.show(moved(painted(shapes.sphere(0.15, 32), base_color=(0, 0, 0), emissive=(12, 9, 4)), 0.1, 1.3, 0.4), "lamp")
    return drawn(scene, {"bloom.enabled": True, "bloom.threshold": threshold, "bloom.intensity": 0.3})


def blended():
    scene = still_life()
    for place, color in ((0.2, (0.9, 0.3, 0.2)), (0.6, (0.2, 0.7, 0.3)), (1.0, (0.2, 0.3, 0.9))):
        veil = painted(shapes.sphere(0.45, 48), base_color=color, alpha_mode="blend", opacity=0.4)
        scene.show(moved(veil, place - 0.5, 0.6, 1.2 - place / 2), f"veil {place}")
    return drawn(scene)


def transmission(roughness):
    scene = still_life()
    glass = painted(shapes.sphere(0.5, 64), base_color=(0.9, 1, 0.95), roughness=roughness, transmission=1, thickness=1)
    scene.show(moved(glass, 0.2, 0.5, 1.2), "glass")
    return drawn(scene)


def depth_of_field(samples):
    return drawn(still_life(), {"depth_of_field.enabled": True, "depth_of_field.f_number": 1.4,
                                "depth_of_field.sensor_height": 0.3, "rays.enabled": False}, samples)


def motion_blur():
    scene = still_life()
    view = Viewer(SIZE, {**LOOK, "motion_blur.enabled": True, "motion_blur.shutter": 1.0}, scene=scene)
    view.render(samples=1)
    scene.get("ball").translate((0.7, 0, 0.5))
    return view.render(samples=16)


def ground(mode):
    scene = still_life()
    scene.remove("floor")
    return drawn(scene, {"ground.mode": mode, "background.mode": "transparent", "ssao.enabled": True})


def outline(width, samples):
    return drawn(still_life(), {"outline.enabled": True, "outline.width": width, "rays.enabled": False}, samples)


def eye_dome():
    angles = np.random.default_rng(3).uniform(0, 2 * np.pi, (20000, 2))
    around = 1 + 0.4 * np.cos(angles[:, 1])
    cloud = Mesh()
    cloud.V = np.stack([around * np.cos(angles[:, 0]), 0.4 * np.sin(angles[:, 1]) + 0.4, around * np.sin(angles[:, 0])], 1)
    scene = Scene()
    scene.show(cloud, "cloud")
    return drawn(scene, {"style.point_size": 3.0}, 1)


EFFECTS = {
    "shadows_hard": lambda: shadows("hard", 0),
    "shadows_3x3": lambda: shadows("pcf", 0),
    "shadows_soft": lambda: shadows("soft", 0.25),
    "ambient_occlusion_horizon": lambda: ambient_occlusion("horizon"),
    "ambient_occlusion_hemisphere": lambda: ambient_occlusion("hemisphere"),
    "bloom": lambda: bloom(0),
    "bloom_threshold": lambda: bloom(1),
    "transparency": blended,
    "transmission_clear": lambda: transmission(0),
    "transmission_rough": lambda: transmission(0.4),
    "depth_of_field_single": lambda: depth_of_field(1),
    "depth_of_field_sampled": lambda: depth_of_field(32),
    "motion_blur": motion_blur,
    "ground_shadow": lambda: ground("shadow"),
    "ground_plane": lambda: ground("plane"),
    "eye_dome": eye_dome,
    "outline": lambda: outline(2.0, 1),
    "outline_wide": lambda: outline(5.0, 8),
}

"""A gallery of glTF's material extensions, a ball each, made here: the core model, clearcoat, sheen, transmission, volume; ior,
specular, iridescence, anisotropy, emissive strength. Writes gltf_materials.png.
"""
import pathlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from easypbr import Material, Scene, Viewer, shapes
from figure import main, sized

BALLS = [
    Material(base_color="#8c1c13", roughness=0.5),
    Material(base_color="#8c1c13", roughness=0.5, clearcoat=1, clearcoat_roughness=0.03),
    Material(base_color="#26264d", roughness=0.8, sheen_color=(0.6, 0.6, 0.9), sheen_roughness=0.4),
    Material(base_color="white", roughness=0, transmission=1),
    Material(base_color="white", roughness=0.02, transmission=1, thickness=1, ior=1.5, attenuation_color="#2f8f5b",
             attenuation_distance=0.5),
    Material(base_color="#202020", roughness=0.1, ior=2.4),
    Material(base_color="#202020", roughness=0.25, specular=1, specular_color=(1.0, 0.5, 0.15)),
    Material(base_color="#101010", roughness=0.1, metallic=1, iridescence=1, iridescence_ior=1.8,
             iridescence_thickness_max=450),
    Material(base_color="#c8c8c8", metallic=1, roughness=0.35, anisotropy=0.9),
    Material(base_color="black", emissive=(1.6, 0.5, 0.08)),
]


def sky() -> NDArray[Any]:
    """Two soft boxes over a grey horizon."""
    height, width = 256, 512
    elevation = np.pi * (0.5 - (np.arange(height) + 0.5) / height)[:, None]
    azimuth = 2 * np.pi * (np.arange(width) + 0.5)[None, :] / width
    light = 0.25 + 0.25 * np.sin(elevation) + 0 * azimuth
    for middle, power in ((4.2, 9.0), (0.9, 4.0)):
        light += power * (abs(elevation - 0.7) < 0.25) * (abs(azimuth - middle) < 0.35)
    return np.repeat(light[:, :, None], 3, axis=2).astype(np.float32)


def draw(data: pathlib.Path | None, scale: float) -> NDArray[Any]:
    scene = Scene()
    checker = (np.indices((512, 512)) // 16).sum(axis=0) % 2
    floor = shapes.plane(16)
    floor.material = Material(base_color="white", roughness=0.7,
                              base_color_texture=np.array([[96, 100, 108], [168, 168, 164]], np.uint8)[checker])
    scene.show(floor, "floor")
    for number, material in enumerate(BALLS):
        ball = shapes.sphere(0.5, 128)
        ball.material = material
        ball.translate((1.2 * (number % 5 - 2), 0.5, 2.4 * (number // 5) - 1.2))
        scene.show(ball, f"ball {number}")
    camera = {"position": (0, 5.2, 8.8), "target": (0, 0.3, 0.1), "fov_y_deg": 21}
    view = Viewer(sized(900, 390, scale), {"camera": camera}, scene)
    view.load_environment_map(sky())
    view.settings.background.mode = "environment"
    return view.render(samples=64)


if __name__ == "__main__":
    main(draw)

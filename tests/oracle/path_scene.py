"""The scene of test_paths.py: numbers that both renderers build it from."""
import numpy as np

SIZE = (96, 72)
SAMPLES = 4096
CAMERA = {"position": [0.0, 0.9, 4.2], "target": [0.0, 0.62, 0.0], "fov_y_deg": 30.0}
LIGHT = {"position": [0.35, 1.15, 0.6], "intensity": 0.8}
#: Name: width, height and depth; centre; reflectance. Walls of a box that is open above and in front.
BOXES = {
    "floor": ((2.0, 0.1, 2.0), (0.0, -0.05, 0.0), (0.7, 0.7, 0.7)),
    "back": ((2.0, 1.3, 0.1), (0.0, 0.65, -0.95), (0.7, 0.7, 0.7)),
    "left": ((0.1, 1.3, 1.8), (-0.95, 0.65, 0.05), (0.7, 0.1, 0.1)),
    "right": ((0.1, 1.3, 1.8), (0.95, 0.65, 0.05), (0.1, 0.5, 0.1)),
}
#: Name: radius, centre, reflectance, roughness of a conductor or None where it is diffuse.
BALLS = {
    "matt": (0.3, (-0.45, 0.3, 0.1), (0.6, 0.6, 0.6), None),
    "metal": (0.35, (0.35, 0.35, -0.3), (1.0, 1.0, 1.0), 0.4),
}


def sky():
    """Equirectangular radiance: brighter above, the same all around. So fine that it does not matter how it is filtered."""
    elevation = np.pi * (0.5 - (np.arange(256) + 0.5) / 256)
    column = 0.3 + 1.2 * np.maximum(np.sin(elevation), 0) ** 4
    return np.repeat(np.repeat(column[:, None, None], 512, axis=1), 3, axis=2).astype(np.float32)

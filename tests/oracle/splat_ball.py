"""The scene of test_splat_ball.py: a ball of glass before walls that shine, and a post that hides a part of it.

Each wall is a square: a corner, two edges, and the sRGB-encoded colour at (u, v) in [0, 1]^2.
"""
import numpy as np

SIZE, SIDE = (240, 180), 128
CAMERA = {"position": [0.8, 0.35, 4.2], "target": [0.0, -0.25, 0.0], "fov_y_deg": 32.0}
BALL = {"center": [0.1, -0.45, 0.0], "radius": 0.45, "ior": 1.5}


def waves(low, high, across, up):
    """Between two colours, by a product of cosines."""
    def color(u, v):
        part = 0.5 + 0.5 * np.cos(2 * np.pi * across * u) * np.cos(2 * np.pi * up * v)
        return np.asarray(low) + part[..., None] * (np.asarray(high) - np.asarray(low))
    return color


WALLS = {
    "back": ([-1.5, -1, -1], [3, 0, 0], [0, 2.4, 0], waves((0.2, 0.25, 0.45), (0.9, 0.85, 0.6), 2, 1.5)),
    "floor": ([-1.5, -1, 1.5], [3, 0, 0], [0, 0, -2.5], waves((0.35, 0.2, 0.15), (0.8, 0.75, 0.7), 3, 2)),
    "side": ([-1.5, -1, 1.5], [0, 0, -2.5], [0, 2.4, 0], waves((0.15, 0.4, 0.2), (0.75, 0.9, 0.5), 1.5, 2)),
    "post": ([0.34, -1, 0.75], [0.14, 0, 0], [0, 1.1, 0], waves((0.75, 0.2, 0.2), (0.95, 0.6, 0.3), 1, 2)),
}


def texels(wall):
    """SIDE x SIDE x 3: colours at the middles of a wall's texels, rows along the second edge."""
    at = (np.arange(SIDE) + 0.5) / SIDE
    return wall[3](*np.meshgrid(at, at))

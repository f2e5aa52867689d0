"""From numpy arrays: a wave with a colour for every vertex, in one call. Writes arrays.png."""

import numpy as np

import easypbr

# A grid of n x n points over a square, and its height.
n = 200
x, z = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n))
distance = np.hypot(x, z)
y = 0.18 * np.cos(14 * distance) * np.exp(-2 * distance)
V = np.stack([x, y, z], axis=-1).reshape(-1, 3)

# Two triangles for every cell, counter-clockwise seen from above.
corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
F = np.concatenate([np.stack([corner, corner + n, corner + 1], axis=1),
                    np.stack([corner + 1, corner + n, corner + n + 1], axis=1)])

# Blue in the valleys, orange on the crests; sRGB in 0..1. Normals are computed.
height = (y.ravel() - y.min()) / np.ptp(y)
C = np.outer(1 - height, [0.1, 0.25, 0.6]) + np.outer(height, [0.95, 0.6, 0.2])

easypbr.render({"V": V, "F": F, "C": C}, out="arrays.png", roughness=0.3, elevation_deg=35)

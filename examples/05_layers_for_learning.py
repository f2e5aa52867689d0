"""Pictures with ground truth from random views. Writes learning_N.png and learning_N.npz, for N from 0 to 3.

Depth, normals and albedo are exact: through the pixels' centres, without anti-aliasing or tone curve. The file also
holds the camera, so that every pixel can be taken back into the world; the script does so and checks it.
"""

import numpy as np

from easypbr import Scene, Viewer, shapes

size = 320, 240
random = np.random.default_rng(1)
teapot = shapes.teapot()
scene = Scene()
scene.show(teapot, "teapot")
view = Viewer(size, scene=scene)

for number in range(4):
    view.settings.camera.azimuth_deg = random.uniform(-180, 180)
    view.settings.camera.elevation_deg = random.uniform(5, 60)
    view.settings.material.color = tuple(random.uniform(0.1, 0.9, 3))
    view.settings.material.roughness = random.uniform(0.05, 0.9)
    view.refit()  # what was fitted to the last view is inferred anew
    view.recorder.record(f"learning_{number}.png", samples=8)

    layers = view.layers(["depth", "normal_world", "albedo"])
    K, T_world_cam = view.camera.opencv_K(size), view.camera.opencv_T_world_cam
    np.savez_compressed(f"learning_{number}.npz", K=K, T_world_cam=T_world_cam, **layers)

    # From pixels and depth to points of the world: they lie within the teapot's bounds.
    depth = layers["depth"]
    y, x = np.nonzero(depth)
    rays = np.linalg.inv(K) @ np.stack([x, y, np.ones_like(x)])
    points = T_world_cam[:3, :3] @ (rays * depth[y, x]) + T_world_cam[:3, 3:]
    lower, upper = teapot.V.min(axis=0)[:, None], teapot.V.max(axis=0)[:, None]
    assert (points > lower - 1e-4).all() and (points < upper + 1e-4).all()

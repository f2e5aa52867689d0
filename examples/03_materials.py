"""Spheres: metallic from bottom to top, roughness from left to right. Writes materials.png."""

import numpy as np

from easypbr import Material, Scene, Viewer, shapes

ball = shapes.sphere(0.45)
scene = Scene()
for row, metallic in enumerate(np.linspace(0, 1, 5)):
    for column, roughness in enumerate(np.linspace(0, 1, 7)):
        # A clone shares the arrays and has materials and a pose of its own.
        sphere = ball.clone()
        sphere.material = Material(base_color="#e0a050", metallic=metallic, roughness=roughness)
        pose = np.eye(4)
        pose[:3, 3] = column, row, 0
        sphere.T_parent_mesh = pose
        scene.show(sphere, f"metallic {metallic:.2f}, roughness {roughness:.2f}")

# Seen from straight ahead, with little perspective.
view = Viewer(settings={"camera": {"azimuth_deg": 0, "elevation_deg": 0, "fov_y_deg": 10}}, scene=scene)
view.recorder.record("materials.png", size=(980, 700))

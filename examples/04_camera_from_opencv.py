"""The camera of a calibrated photograph: OpenCV's K and pose. Writes camera_from_opencv.png.

A point that OpenCV projects to a pixel is drawn at that pixel; the end of the script checks it.
"""

import numpy as np

from easypbr import Camera, Scene, Viewer, shapes

width, height = 640, 480
# Pixel centres are at integers, as OpenCV has them, and the principal point is off the centre.
K = np.array([[700.0, 0, 300.0], [0, 700.0, 260.0], [0, 0, 1]])

# OpenCV and COLMAP give world-to-camera, x right, y down, z forward; we want camera-to-world.
angle = np.radians(20)
R_cam_world = np.array([[1, 0, 0], [0, -np.cos(angle), np.sin(angle)], [0, -np.sin(angle), -np.cos(angle)]])
T_cam_world = np.eye(4)
T_cam_world[:3, :3] = R_cam_world
T_cam_world[:3, 3] = 0, 0.2, 3
T_world_cam = np.linalg.inv(T_cam_world)

ball = shapes.sphere(0.04)
center = np.array([0.5, 0.85, 0.3])
ball.V = ball.V + center
ball.material.base_color = "#ff5020"
scene = Scene()
scene.show(shapes.teapot(), "teapot")
scene.show(ball, "ball")

view = Viewer((width, height), scene=scene)
view.camera = Camera.from_opencv(K, T_world_cam, size=(width, height))
view.recorder.record("camera_from_opencv.png")

# The ray through the ball's centre meets its surface one radius earlier.
ball_in_camera = R_cam_world @ center + T_cam_world[:3, 3]
x, y, z = K @ ball_in_camera
expected = z * (1 - 0.04 / np.linalg.norm(ball_in_camera))
depth = view.layers("depth")["depth"]
assert abs(depth[round(y / z), round(x / z)] - expected) < 0.001, "the ball is not where OpenCV projects it"

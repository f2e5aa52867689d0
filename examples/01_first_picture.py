"""A mesh in, a picture out: camera, lights and exposure are inferred. Writes first_picture.png."""

from easypbr import Mesh, Scene, Viewer, shapes

# A file of our own, so that the example needs none; yours comes in the same way.
shapes.teapot().save("teapot.ply")

view = Viewer(size=(800, 600))
teapot = Mesh("teapot.ply")
teapot.material.base_color = "#b03a2e"
teapot.material.roughness = 0.2
Scene.show(teapot, "teapot")
view.recorder.record("first_picture.png")

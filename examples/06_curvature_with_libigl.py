"""libigl takes a mesh's matrices as they are: simplifies a ring, computes its curvature, shows it as a scalar.

Writes curvature.png. Needs libigl (pip install libigl).
"""
import igl
import numpy as np

from easypbr import *

ring = shapes.torus(1, 0.4, segments=192, tube_segments=96)
# The texture's seam has its vertices twice; welded, the ring is closed for libigl too.
mesh = ring.remove_duplicate_vertices(keep_seams=False).decimate(faces=8000)

# Gaussian curvature: the product of the two principal ones, from quadrics fitted to the neighbours of each vertex.
k1, k2 = igl.principal_curvature(mesh.V, mesh.F)[2:4]
mesh.add_scalar("curvature", k1 * k2)

# On paper: cos(a) / (0.4 (1 + 0.4 cos(a))) at the angle a around the tube, from -4.2 to 1.8, which the fit smooths a
# little; and 0 in sum over any ring (Gauss and Bonnet), here as what the angles at each vertex lack to a full turn.
outwards = np.hypot(mesh.V[:, 0], mesh.V[:, 2])
expected = (outwards - 1) / 0.4 / (0.4 * outwards)
assert np.median(np.abs(k1 * k2 - expected)) < 0.2
assert abs(igl.gaussian_curvature(mesh.V, mesh.F).sum()) < 0.01

mesh.style.colormap = "coolwarm"
mesh.style.color_min, mesh.style.color_max = -4, 4
view = Viewer(settings={"camera": {"elevation_deg": 40}})
Scene.show(mesh, "ring")
view.recorder.record("curvature.png")

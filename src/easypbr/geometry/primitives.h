// Shapes made in code, centred at the origin, with normals and uv. Y is up.
#pragma once

#include "easypbr/scene/mesh.h"
#include "easypbr/scene/scene.h"

namespace easypbr {

/// UV sphere. Throws ArgumentError when radius <= 0 or segments < 3.
Mesh make_sphere(float radius = 1, int segments = 64);
/// Axis-aligned box with flat faces.
Mesh make_box(const Vec3& size = Vec3(1, 1, 1));
/// Square in the xz plane, facing up.
Mesh make_plane(float size = 1);
/// Newell's Utah teapot from its 32 Bezier patches, standing on y = 0, `height` high, each patch cut
/// `subdivisions` times.
Mesh make_teapot(float height = 1, int subdivisions = 16);

/// The demo: teapots of several metals and dielectrics on a floor.
Scene make_demo_scene();

}  // namespace easypbr

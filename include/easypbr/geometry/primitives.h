// Shapes made in code, centred at the origin unless said otherwise, with normals and uv. Y is up, and the
// axis of what is round. Every function throws ArgumentError for sizes that are not numbers above 0 and for
// counts out of range; segments may be 3 to 8192.
#pragma once

#include <optional>

#include "easypbr/scene/mesh.h"
#include "easypbr/scene/scene.h"

namespace easypbr {

/// UV sphere of `segments` meridians (at least 3) and half as many rings.
Mesh make_sphere(float radius = 1, int segments = 64);
/// Icosahedron whose triangles are cut in four `subdivisions` times (0 to 10) and pushed to the sphere: 20 *
/// 4^n nearly equal faces. Vertices are shared, so there is no uv.
Mesh make_icosphere(float radius = 1, int subdivisions = 3);
/// Axis-aligned box with flat faces.
Mesh make_box(const Vec3& size = Vec3(1, 1, 1));
/// Square in the xz plane, facing up, of divisions x divisions quads.
Mesh make_plane(float size = 1, int divisions = 1);
/// Lines of a square in the xz plane with divisions x divisions fields: edges only.
Mesh make_grid(float size = 10, int divisions = 10);
/// Closed cylinder. v runs along the profile, from the middle of the bottom over the side to that of the top,
/// as it does for all shapes of revolution.
Mesh make_cylinder(float radius = 0.5f, float height = 1, int segments = 64);
/// Closed cone, its tip up.
Mesh make_cone(float radius = 0.5f, float height = 1, int segments = 64);
/// Ring around the y axis: `radius` from the centre to the middle of the tube, which must be the smaller one.
Mesh make_torus(float radius = 1, float tube_radius = 0.25f, int segments = 64, int tube_segments = 32);
/// Cylinder with half spheres as ends, whose centres are `height` apart.
Mesh make_capsule(float radius = 0.5f, float height = 1, int segments = 64);
/// Arrow from one point to another. The shaft has the radius, by default a fortieth of the length; the head
/// is 2.5 times as wide and 6 radii long, but at most half of the arrow.
Mesh make_arrow(const Vec3& from, const Vec3& to, std::optional<float> radius = std::nullopt,
                int segments = 32);

/// How arrows of a vector field look.
struct ArrowOptions {
    /// Length of an arrow by that of its vector, above 0; 1: true lengths. Automatic: the longest arrow is as
    /// long as neighbouring starts are apart (the median), but at least a fiftieth of the diagonal of their
    /// bounding box; 1 where all starts are at one place.
    std::optional<double> scale = {};
    /// Of all shafts, above 0. Automatic: a fortieth of the longest arrow, at most a twelfth of each.
    std::optional<double> radius = {};
    int segments = 12;  ///< around each arrow, 3 to 8192
    /// One for each arrow, as scalars "value" that colour the arrows; or none.
    Array1f values = {};
    ArrayXf colors = {};  ///< sRGB, n x 3 or n x 4, one for each arrow; or none
    /// Whether rows that are not finite throw; else they are left out with a warning.
    bool strict = false;
};
/// Arrows of a vector field as one mesh, each from its start along its vector, with the head of make_arrow()
/// and without uv: 7 * segments vertices an arrow, in the order of the rows. Vectors of length 0 have no
/// arrow. The lengths of the vectors are scalars "length", which colour the arrows when asked for. Starts far
/// from zero give the mesh an offset. Throws ArgumentError unless both are n x 3, for rows that do not fit
/// together, and when no row is finite.
Mesh make_arrows(const Array3d& starts, const Array3d& vectors, const ArrowOptions& options = {});

/// Arrows along x, y and z from the origin, coloured red, green and blue by vertex.
Mesh make_axes(float length = 1, std::optional<float> radius = std::nullopt);
/// Newell's Utah teapot from its 32 Bezier patches, standing on y = 0, `height` high, each patch cut
/// `subdivisions` times.
Mesh make_teapot(float height = 1, int subdivisions = 16);

/// The demo: teapots of several metals and dielectrics on a floor.
Scene make_demo_scene();

}  // namespace easypbr

#include "easypbr/geometry/primitives.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "easypbr/core/error.h"

namespace easypbr {

namespace {

MeshData with_shape(std::string name, Array3f::Dense V, Array3f::Dense N, Array2f::Dense UV,
                    Array3i::Dense F) {
    MeshData data;
    data.name = std::move(name);
    data.V = std::move(V);
    data.N = std::move(N);
    data.UV = std::move(UV);
    data.F = std::move(F);
    return data;
}

void require_positive(const char* what, float value) {
    if (!(value > 0) || !std::isfinite(value))
        throw ArgumentError(fmt::format("{}: expected a number > 0, got {}", what, value));
}

/// Direction of a sphere's grid point; exact at the poles and at the seam, so that the surface is closed.
Vec3 sphere_normal(int ring, int rings, int segment, int segments) {
    if (ring == 0) return Vec3::UnitY();
    if (ring == rings) return -Vec3::UnitY();
    const double theta = pi * ring / rings, phi = 2 * pi * (segment % segments) / segments;
    return Vec3d(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi))
        .cast<float>();
}

/// Two triangles per quad of the grid, one beside the poles. Columns run to the right, rows down, seen from
/// outside.
Array3i::Dense sphere_faces(int rings, int segments) {
    Array3i::Dense F(2 * segments * (rings - 1), 3);
    Eigen::Index face = 0;
    for (int ring = 0; ring < rings; ++ring) {
        for (int segment = 0; segment < segments; ++segment) {
            const int a = ring * (segments + 1) + segment, b = a + 1, c = a + segments + 1, d = c + 1;
            if (ring < rings - 1) F.row(face++) << a, c, d;
            if (ring == rings - 1)
                F.row(face++) << a, c, b;
            else if (ring > 0)
                F.row(face++) << a, d, b;
        }
    }
    return F;
}

}  // namespace

Mesh make_sphere(float radius, int segments) {
    require_positive("sphere: radius", radius);
    if (segments < 3)
        throw ArgumentError(fmt::format("sphere: expected at least 3 segments, got {}", segments));
    const int rings = std::max(2, segments / 2), count = (rings + 1) * (segments + 1);
    Array3f::Dense V(count, 3), N(count, 3);
    Array2f::Dense UV(count, 2);
    for (int ring = 0, i = 0; ring <= rings; ++ring) {
        // A pole's vertex belongs to one triangle: its u is that of the triangle's middle.
        const float shift = ring == 0 || ring == rings ? 0.5f : 0.0f;
        for (int segment = 0; segment <= segments; ++segment, ++i) {
            N.row(i) = sphere_normal(ring, rings, segment, segments).transpose();
            UV.row(i) << (float(segment) + shift) / float(segments), 1 - float(ring) / float(rings);
        }
    }
    V = radius * N;
    return Mesh(
        with_shape("sphere", std::move(V), std::move(N), std::move(UV), sphere_faces(rings, segments)));
}

Mesh make_box(const Vec3& size) {
    for (const float side : size) require_positive("box: size", side);
    Array3f::Dense V(24, 3), N(24, 3);
    Array2f::Dense UV(24, 2);
    Array3i::Dense F(12, 3);
    for (int side = 0; side < 6; ++side) {
        const int axis = side / 2;
        const Vec3 normal = (side % 2 == 0 ? 1.0f : -1.0f) * Vec3::Unit(axis);
        // The texture stands upright on the walls; on top and bottom its right is +x.
        const Vec3 right = axis == 1 ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitY().cross(normal));
        const Vec3 up = normal.cross(right);
        for (int corner = 0; corner < 4; ++corner) {
            const float u = corner == 1 || corner == 2 ? 1.0f : 0.0f, v = corner >= 2 ? 1.0f : 0.0f;
            const Vec3 position = 0.5f * normal + (u - 0.5f) * right + (v - 0.5f) * up;
            V.row(4 * side + corner) = position.cwiseProduct(size).transpose();
            N.row(4 * side + corner) = normal.transpose();
            UV.row(4 * side + corner) << u, v;
        }
        F.row(2 * side) << 4 * side, 4 * side + 1, 4 * side + 2;
        F.row(2 * side + 1) << 4 * side, 4 * side + 2, 4 * side + 3;
    }
    return Mesh(with_shape("box", std::move(V), std::move(N), std::move(UV), std::move(F)));
}

Mesh make_plane(float size) {
    require_positive("plane: size", size);
    const float half = size / 2;
    Array3f::Dense V(4, 3), N(4, 3);
    Array2f::Dense UV(4, 2);
    Array3i::Dense F(2, 3);
    V << -half, 0, half, half, 0, half, half, 0, -half, -half, 0, -half;
    N.rowwise() = Vec3::UnitY().transpose();
    UV << 0, 0, 1, 0, 1, 1, 0, 1;
    F << 0, 1, 2, 0, 2, 3;
    return Mesh(with_shape("plane", std::move(V), std::move(N), std::move(UV), std::move(F)));
}

}  // namespace easypbr

// Martin Newell's teapot (University of Utah, 1975). Its 32 bicubic Bezier patches are six profiles, each
// turned through four quarters, and four half tubes (handle and spout), each with its mirror image; so they
// are kept here. Units and control points are Newell's, with his z as y and the lid, rim and bottom of the
// later complete version.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"
#include "easypbr/geometry/primitives.h"

namespace easypbr {

namespace {

constexpr double newell_height = 3.15;

/// A control circle: its radius, the length of the handles of its quarter arcs, and its height.
struct Circle {
    double radius, handle, height;
};
constexpr Circle circle(double radius, double height) {
    return {radius, 0.56 * radius, height};
}

using Profile = std::array<Circle, 4>;
constexpr std::array<Profile, 6> profiles{{
    {circle(1.4, 2.4), circle(1.3375, 2.53125), circle(1.4375, 2.53125), circle(1.5, 2.4)},  // rim
    {circle(1.5, 2.4), circle(1.75, 1.875), circle(2, 1.35), circle(2, 0.9)},                // body
    {circle(2, 0.9), circle(2, 0.45), circle(1.5, 0.225), circle(1.5, 0.15)},                // body, below
    {circle(0, 3.15), Circle{0.8, 0.45, 3.15}, circle(0, 2.85), circle(0.2, 2.7)},           // knob
    {circle(0.2, 2.7), circle(0.4, 2.55), circle(1.3, 2.55), circle(1.3, 2.4)},              // lid
    {circle(1.5, 0.15), circle(1.5, 0.075), circle(1.425, 0), circle(0, 0)},                 // bottom
}};

/// Half of a tube's control section: from (x0, y0) in the plane of symmetry out to half_width and back to
/// (x1, y1).
struct Section {
    double x0, y0, x1, y1, half_width;
};

using Tube = std::array<Section, 4>;
constexpr std::array<Tube, 4> tubes{{
    {{{-1.6, 2.025, -1.5, 2.25, 0.3},  // handle
      {-2.3, 2.025, -2.5, 2.25, 0.3},
      {-2.7, 2.025, -3, 2.25, 0.3},
      {-2.7, 1.8, -3, 1.8, 0.3}}},
    {{{-2.7, 1.8, -3, 1.8, 0.3},
      {-2.7, 1.575, -3, 1.35, 0.3},
      {-2.5, 1.125, -2.65, 0.9375, 0.3},
      {-2, 0.9, -1.9, 0.6, 0.3}}},
    {{{1.7, 1.425, 1.7, 0.6, 0.66},  // spout
      {2.6, 1.425, 3.1, 0.825, 0.66},
      {2.3, 2.1, 2.4, 2.025, 0.25},
      {2.7, 2.4, 3.3, 2.4, 0.25}}},
    {{{2.7, 2.4, 3.3, 2.4, 0.25},
      {2.8, 2.475, 3.525, 2.49375, 0.25},
      {2.9, 2.475, 3.45, 2.5125, 0.15},
      {2.8, 2.4, 3.2, 2.4, 0.15}}},
}};

using Row = std::array<Vec3d, 4>;
/// Control points; along a row s grows, from row to row t. Seen from outside, t x s points to the viewer.
using Patch = std::array<Row, 4>;

Patch turned_patch(const Profile& profile, int quarter) {
    const Eigen::AngleAxisd rotation(quarter * pi / 2, Vec3d::UnitY());
    Patch patch;
    for (int i = 0; i < 4; ++i) {
        const auto [radius, handle, height] = profile[i];
        patch[i] = {Vec3d(0, height, radius), Vec3d(handle, height, radius), Vec3d(radius, height, handle),
                    Vec3d(radius, height, 0)};
        for (Vec3d& point : patch[i]) point = rotation * point;
    }
    return patch;
}

/// side: +1 or -1, the sign of the half's z.
Patch half_of(const Tube& tube, int side) {
    Patch patch;
    for (int i = 0; i < 4; ++i) {
        const auto [x0, y0, x1, y1, half_width] = tube[i];
        const double z = side * half_width;
        patch[i] = {Vec3d(x0, y0, 0), Vec3d(x0, y0, z), Vec3d(x1, y1, z), Vec3d(x1, y1, 0)};
        if (side > 0) std::reverse(patch[i].begin(), patch[i].end());
    }
    return patch;
}

std::vector<Patch> all_patches() {
    std::vector<Patch> patches;
    for (const Profile& profile : profiles)
        for (int quarter = 0; quarter < 4; ++quarter) patches.push_back(turned_patch(profile, quarter));
    for (const Tube& tube : tubes)
        for (const int side : {1, -1}) patches.push_back(half_of(tube, side));
    return patches;
}

struct CurvePoint {
    Vec3d position, derivative;
};

/// De Casteljau's algorithm.
CurvePoint evaluate(const Row& p, double t) {
    const auto between = [t](const Vec3d& a, const Vec3d& b) -> Vec3d { return a + t * (b - a); };
    const Vec3d a = between(p[0], p[1]), b = between(p[1], p[2]), c = between(p[2], p[3]);
    const Vec3d left = between(a, b), right = between(b, c);
    return {between(left, right), 3 * (right - left)};
}

struct SurfacePoint {
    Vec3d position, normal;
};

SurfacePoint evaluate(const Patch& patch, double s, double t) {
    Row positions, derivatives;
    for (int i = 0; i < 4; ++i) {
        const CurvePoint point = evaluate(patch[i], s);
        positions[i] = point.position;
        derivatives[i] = point.derivative;
    }
    const CurvePoint along_t = evaluate(positions, t), along_s = evaluate(derivatives, t);
    // At a pole the derivative along s vanishes; by l'Hopital its direction is that of the mixed derivative.
    const bool pole = along_s.position.norm() < 1e-9;
    const Vec3d tangent_s = !pole     ? along_s.position
                            : t < 0.5 ? along_s.derivative
                                      : Vec3d(-along_s.derivative);
    return {along_t.position, along_t.derivative.cross(tangent_s).normalized()};
}

/// Leaves out the triangles that a pole shrinks to a line.
void add_face(std::vector<Eigen::RowVector3i>& faces, const Array3f::Dense& V, int a, int b, int c) {
    if (V.row(a) == V.row(b) || V.row(b) == V.row(c) || V.row(c) == V.row(a)) return;
    faces.emplace_back(a, b, c);
}

Array3i::Dense patch_faces(const Array3f::Dense& V, int subdivisions) {
    const int row = subdivisions + 1, patches = int(V.rows()) / (row * row);
    std::vector<Eigen::RowVector3i> faces;
    for (int patch = 0; patch < patches; ++patch) {
        for (int j = 0; j < subdivisions; ++j) {
            for (int i = 0; i < subdivisions; ++i) {
                const int a = (patch * row + j) * row + i, b = a + 1, c = a + row, d = c + 1;
                add_face(faces, V, a, c, d);
                add_face(faces, V, a, d, b);
            }
        }
    }
    Array3i::Dense F(Eigen::Index(faces.size()), 3);
    for (size_t f = 0; f < faces.size(); ++f) F.row(Eigen::Index(f)) = faces[f];
    return F;
}

}  // namespace

Mesh make_teapot(float height, int subdivisions) {
    if (!(height > 0) || !std::isfinite(height))
        throw ArgumentError(fmt::format("teapot: height: expected a number > 0, got {}", height));
    if (subdivisions < 1 || subdivisions > 1024)
        throw ArgumentError(fmt::format("teapot: expected 1 to 1024 subdivisions, got {}", subdivisions));
    const std::vector<Patch> patches = all_patches();
    const int row = subdivisions + 1;
    const Eigen::Index count = Eigen::Index(patches.size()) * row * row;
    Array3f::Dense V(count, 3), N(count, 3);
    Array2f::Dense UV(count, 2);
    parallel_for(size_t(count), 4096, [&](size_t index) {
        const int i = int(index) % row, j = int(index) / row % row;
        const double s = double(i) / subdivisions, t = double(j) / subdivisions;
        const SurfacePoint point = evaluate(patches[index / (size_t(row) * row)], s, t);
        const auto vertex = Eigen::Index(index);
        V.row(vertex) = (point.position * (height / newell_height)).cast<float>().transpose();
        N.row(vertex) = point.normal.cast<float>().transpose();
        UV.row(vertex) << float(s), float(1 - t);
    });
    MeshData data;
    data.name = "teapot";
    data.F = patch_faces(V, subdivisions);
    data.V = std::move(V);
    data.N = std::move(N);
    data.UV = std::move(UV);
    return Mesh(std::move(data));
}

}  // namespace easypbr

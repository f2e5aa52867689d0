// Flat shapes and the icosphere.
#include "easypbr/geometry/primitives.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <vector>

#include "easypbr/geometry/require.h"

namespace easypbr {

using geometry::require_between;
using geometry::require_positive;

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

using Triangle = std::array<int32_t, 3>;

/// Cuts every triangle in four, with a new vertex on the unit sphere above the middle of each edge.
void cut_in_four(std::vector<Vec3d>& V, std::vector<Triangle>& F) {
    std::unordered_map<uint64_t, int32_t> middles;
    middles.reserve(F.size() * 3 / 2);
    const auto middle = [&](int32_t a, int32_t b) {
        const uint64_t edge = uint64_t(std::min(a, b)) << 32 | uint64_t(std::max(a, b));
        const auto [found, is_new] = middles.try_emplace(edge, int32_t(V.size()));
        if (is_new) V.push_back((V[size_t(a)] + V[size_t(b)]).normalized());
        return found->second;
    };
    std::vector<Triangle> cut;
    cut.reserve(4 * F.size());
    for (const auto& [a, b, c] : F) {
        const int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        cut.insert(cut.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    F = std::move(cut);
}

std::vector<Vec3d> icosahedron_corners() {
    const double golden = (1 + std::sqrt(5.0)) / 2;
    std::vector<Vec3d> corners;
    for (int axis = 0; axis < 3; ++axis)
        for (const double a : {-1.0, 1.0})
            for (const double b : {-golden, golden}) {
                Vec3d corner = Vec3d::Zero();
                corner[(axis + 1) % 3] = a;
                corner[(axis + 2) % 3] = b;
                corners.push_back(corner.normalized());
            }
    return corners;
}

/// The triples of corners at the distance of an edge from each other, counter-clockwise from outside.
std::vector<Triangle> icosahedron_faces(const std::vector<Vec3d>& corners) {
    // Neighbours on the unit sphere are 1.05 apart, the others at least 1.7.
    const auto are_neighbors = [&](size_t a, size_t b) { return (corners[a] - corners[b]).norm() < 1.3; };
    std::vector<Triangle> faces;
    for (size_t a = 0; a < corners.size(); ++a)
        for (size_t b = a + 1; b < corners.size(); ++b)
            for (size_t c = b + 1; c < corners.size(); ++c) {
                if (!are_neighbors(a, b) || !are_neighbors(b, c) || !are_neighbors(c, a)) continue;
                const bool is_outwards = corners[a].dot(corners[b].cross(corners[c])) > 0;
                faces.push_back({int32_t(a), int32_t(is_outwards ? b : c), int32_t(is_outwards ? c : b)});
            }
    return faces;
}

}  // namespace

Mesh make_icosphere(float radius, int subdivisions) {
    require_positive("icosphere: radius", radius);
    require_between("icosphere: subdivisions", subdivisions, 0, 10);
    std::vector<Vec3d> V = icosahedron_corners();
    std::vector<Triangle> F = icosahedron_faces(V);
    for (int i = 0; i < subdivisions; ++i) cut_in_four(V, F);
    MeshData data;
    data.name = "icosphere";
    const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>> unit(
        V.data()->data(), Eigen::Index(V.size()), 3);
    data.V = Array3f(unit * double(radius));
    data.N = Array3f(unit);
    data.F = Array3i::Dense(Eigen::Map<const Array3i::Dense>(F.data()->data(), Eigen::Index(F.size()), 3));
    return Mesh(std::move(data));
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

Mesh make_plane(float size, int divisions) {
    require_positive("plane: size", size);
    require_between("plane: divisions", divisions, 1, 16384);
    const int side = divisions + 1;
    Array3f::Dense V(side * side, 3), N(side * side, 3);
    Array2f::Dense UV(side * side, 2);
    Array3i::Dense F(2 * divisions * divisions, 3);
    N.rowwise() = Vec3::UnitY().transpose();
    for (int j = 0, row = 0; j < side; ++j)
        for (int i = 0; i < side; ++i, ++row) {
            const float u = float(i) / float(divisions), v = float(j) / float(divisions);
            V.row(row) << size * (u - 0.5f), 0, size * (0.5f - v);
            UV.row(row) << u, v;
        }
    for (int j = 0, face = 0; j < divisions; ++j)
        for (int i = 0; i < divisions; ++i, face += 2) {
            const int a = j * side + i, b = a + 1, c = b + side, d = a + side;
            F.row(face) << a, b, c;
            F.row(face + 1) << a, c, d;
        }
    return Mesh(with_shape("plane", std::move(V), std::move(N), std::move(UV), std::move(F)));
}

Mesh make_grid(float size, int divisions) {
    require_positive("grid: size", size);
    require_between("grid: divisions", divisions, 1, 1000000);
    const int lines = 2 * (divisions + 1);
    Array3f::Dense V(2 * lines, 3);
    Array2i::Dense E(lines, 2);
    const float half = size / 2;
    for (int i = 0, line = 0; i <= divisions; ++i) {
        const float at = size * (float(i) / float(divisions) - 0.5f);
        for (const bool along_x : {true, false}) {
            const Vec3 middle = along_x ? Vec3(0, 0, at) : Vec3(at, 0, 0);
            const Vec3 arm = along_x ? Vec3(half, 0, 0) : Vec3(0, 0, half);
            V.row(2 * line) = (middle - arm).transpose();
            V.row(2 * line + 1) = (middle + arm).transpose();
            E.row(line) << 2 * line, 2 * line + 1;
            ++line;
        }
    }
    MeshData data;
    data.name = "grid";
    data.V = std::move(V);
    data.E = std::move(E);
    return Mesh(std::move(data));
}

}  // namespace easypbr

// What can be measured of a mesh, for tests.
#pragma once

#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "easypbr/core/math.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr {

inline Vec3d corner(const MeshData& mesh, Eigen::Index face, int k) {
    return mesh.V.row(mesh.F(face, k)).transpose().cast<double>();
}

inline Vec3d area_vector(const MeshData& mesh, Eigen::Index face) {
    const Vec3d origin = corner(mesh, face, 0);
    return (corner(mesh, face, 1) - origin).cross(corner(mesh, face, 2) - origin) / 2;
}

inline double area(const MeshData& mesh) {
    double sum = 0;
    for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) sum += area_vector(mesh, f).norm();
    return sum;
}

/// Volume inside a closed, outwards oriented surface (divergence theorem).
inline double volume(const MeshData& mesh) {
    double sum = 0;
    for (Eigen::Index f = 0; f < mesh.F.rows(); ++f)
        sum += corner(mesh, f, 0).dot(corner(mesh, f, 1).cross(corner(mesh, f, 2))) / 6;
    return sum;
}

using Point = std::tuple<float, float, float>;

inline Point point_of(const MeshData& mesh, int v) {
    return {mesh.V(v, 0) + 0.0f, mesh.V(v, 1) + 0.0f, mesh.V(v, 2) + 0.0f};
}

/// Whether every edge, by position, is used as often in one direction as in the other.
inline bool is_closed(const MeshData& mesh) {
    std::map<std::pair<Point, Point>, int> balance;
    for (Eigen::Index f = 0; f < mesh.F.rows(); ++f)
        for (int k = 0; k < 3; ++k) {
            const Point a = point_of(mesh, mesh.F(f, k)), b = point_of(mesh, mesh.F(f, (k + 1) % 3));
            ++balance[{a, b}];
            --balance[{b, a}];
        }
    for (const auto& [edge, count] : balance)
        if (count != 0) return false;
    return true;
}

/// Vertices - edges + faces, where vertices at the same position are one: 2 for a ball, 0 for a ring.
inline int euler_characteristic(const MeshData& mesh) {
    std::set<Point> vertices;
    std::set<std::pair<Point, Point>> edges;
    for (Eigen::Index f = 0; f < mesh.F.rows(); ++f)
        for (int k = 0; k < 3; ++k) {
            const Point a = point_of(mesh, mesh.F(f, k)), b = point_of(mesh, mesh.F(f, (k + 1) % 3));
            vertices.insert(a);
            edges.insert(std::minmax(a, b));
        }
    return int(vertices.size()) - int(edges.size()) + int(mesh.F.rows());
}

/// Smallest and mean cosine between a face's normal and the normals at its corners.
inline std::pair<double, double> normal_agreement(const MeshData& mesh) {
    double least = 1, sum = 0;
    for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
        const Vec3d normal = area_vector(mesh, f).normalized();
        for (int k = 0; k < 3; ++k) {
            const double cosine = normal.dot(mesh.N.row(mesh.F(f, k)).transpose().cast<double>());
            least = std::min(least, cosine);
            sum += cosine;
        }
    }
    return {least, sum / double(3 * mesh.F.rows())};
}

}  // namespace easypbr

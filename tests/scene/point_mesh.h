// Meshes of loose vertices.
#pragma once

#include <array>
#include <initializer_list>

#include "easypbr/scene/mesh.h"

/// A mesh of these vertices.
inline easypbr::Mesh points(std::initializer_list<std::array<float, 3>> rows) {
    easypbr::Array3f::Dense V(Eigen::Index(rows.size()), 3);
    Eigen::Index row = 0;
    for (const auto& p : rows) V.row(row++) << p[0], p[1], p[2];
    return {easypbr::Array3f(std::move(V)), easypbr::Array3i()};
}

inline easypbr::Mesh cloud(easypbr::Array3f::Dense V) {
    return {easypbr::Array3f(std::move(V)), easypbr::Array3i()};
}

// The smooth surface that the normals of a triangle's vertices tell of.
#pragma once

#include <algorithm>
#include <array>

#include "easypbr/core/math.h"

namespace easypbr::render {

/// From the place of a triangle with the barycentric coordinates u, v to the mean of its projections onto the
/// planes of the vertices, at right angles to their normals (Hanika 2021, "Hacking the Shadow Terminator").
/// Planes below the place do not count: nothing leads below the triangle where the surface is hollow.
inline Vec3 to_smooth_surface(const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& normals, float u,
                              float v) {
    const std::array<float, 3> weights{1 - u - v, u, v};
    const Vec3 place = weights[0] * corners[0] + u * corners[1] + v * corners[2];
    Vec3 way = Vec3::Zero();
    for (size_t c = 0; c < 3; ++c)
        way += weights[c] * std::max(0.0f, (corners[c] - place).dot(normals[c])) * normals[c];
    return way;
}

}  // namespace easypbr::render

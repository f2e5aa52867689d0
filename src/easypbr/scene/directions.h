// Directions of vectors and of surfaces under affine maps.
#pragma once

#include "easypbr/core/math.h"

namespace easypbr::detail {

/// The cofactor matrix: turns normals as det(M) times the inverse transpose does, and exists for singular M.
inline Mat3d cofactors(const Mat3d& M) {
    Mat3d result;
    result << M.col(1).cross(M.col(2)), M.col(2).cross(M.col(0)), M.col(0).cross(M.col(1));
    return result;
}

/// The unit vector of the same direction; +z for the zero vector.
inline Vec3d direction_or_z(const Vec3d& vector) {
    const double length = vector.norm();
    return length > 0 ? Vec3d(vector / length) : Vec3d(Vec3d::UnitZ());
}

}  // namespace easypbr::detail

// The spherical harmonics that the colours of splats are made of.
#pragma once

#include "easypbr/core/math.h"

namespace easypbr {

/// Of the first of them, which is constant.
inline constexpr float splat_constant = 0.28209479177387814f;

/// The (degree + 1)^2 real spherical harmonics of a unit vector, degree 0 to 3, in the order and with the
/// signs of Kerbl et al. 2023: those of the associated Legendre functions with the Condon-Shortley phase.
inline void spherical_harmonics(const Vec3& direction, int degree, float* basis) {
    const float x = direction.x(), y = direction.y(), z = direction.z();
    basis[0] = splat_constant;
    if (degree < 1) return;
    constexpr float c1 = 0.4886025119029199f;
    basis[1] = -c1 * y;
    basis[2] = c1 * z;
    basis[3] = -c1 * x;
    if (degree < 2) return;
    const float xx = x * x, yy = y * y, zz = z * z;
    constexpr float c2 = 1.0925484305920792f;
    basis[4] = c2 * x * y;
    basis[5] = -c2 * y * z;
    basis[6] = 0.31539156525252005f * (2 * zz - xx - yy);
    basis[7] = -c2 * x * z;
    basis[8] = c2 / 2 * (xx - yy);
    if (degree < 3) return;
    constexpr float c33 = 0.5900435899266435f, c31 = 0.4570457994644658f;
    basis[9] = -c33 * y * (3 * xx - yy);
    basis[10] = 2.890611442640554f * x * y * z;
    basis[11] = -c31 * y * (4 * zz - xx - yy);
    basis[12] = 0.3731763325901154f * z * (2 * zz - 3 * xx - 3 * yy);
    basis[13] = -c31 * x * (4 * zz - xx - yy);
    basis[14] = 1.445305721320277f * z * (xx - yy);
    basis[15] = -c33 * x * (xx - 3 * yy);
}

}  // namespace easypbr

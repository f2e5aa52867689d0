// Octahedral unit vectors (Cigolle et al. 2014), as oct_encode() and oct_decode() in
// shaders/common_encoding.glsl.
#pragma once

#include <algorithm>
#include <cmath>

#include "easypbr/core/math.h"

namespace easypbr {

/// Unit vector to [-1, 1]^2; (0, 0) for the zero vector.
inline Vec2 oct_encode(const Vec3& n) {
    const float sum = std::abs(n.x()) + std::abs(n.y()) + std::abs(n.z());
    if (!(sum > 0)) return Vec2(0, 0);
    const Vec2 p(n.x() / sum, n.y() / sum);
    if (n.z() >= 0) return p;
    return {(1 - std::abs(p.y())) * (p.x() >= 0 ? 1.0f : -1.0f),
            (1 - std::abs(p.x())) * (p.y() >= 0 ? 1.0f : -1.0f)};
}

/// The inverse; of unit length.
inline Vec3 oct_decode(const Vec2& p) {
    Vec3 n(p.x(), p.y(), 1 - std::abs(p.x()) - std::abs(p.y()));
    const float fold = std::max(-n.z(), 0.0f);
    n.x() -= n.x() >= 0 ? fold : -fold;
    n.y() -= n.y() >= 0 ? fold : -fold;
    return n.normalized();
}

}  // namespace easypbr

// Places of directions in equirectangular maps, for every ray: faster than equirect_uv() and as it to 3e-7.
#pragma once

#include <algorithm>
#include <cmath>

#include "easypbr/core/math.h"

namespace easypbr::render {

/// Arc tangent of y / x in the right quadrant, to 5e-7; 0 at the origin (Abramowitz and Stegun 1964, 4.4.49).
inline float fast_atan2(float y, float x) {
    const float ax = std::abs(x), ay = std::abs(y);
    const float most = std::max(ax, ay), least = std::min(ax, ay);
    const float t = most > 0 ? least / most : 0, t2 = t * t;
    float angle = 0.0028662257f;
    for (const float factor : {-0.0161657367f, 0.0429096138f, -0.0752896400f, 0.1065626393f, -0.1420889944f,
                               0.1999355085f, -0.3333314528f, 1.0f})
        angle = angle * t2 + factor;
    angle *= t;
    angle = ay > ax ? float(pi / 2) - angle : angle;
    angle = x < 0 ? float(pi) - angle : angle;
    return y < 0 ? -angle : angle;
}

/// As equirect_uv().
inline Vec2 sky_place(const Vec3& direction) {
    const float level = std::sqrt(direction.x() * direction.x() + direction.z() * direction.z());
    return {0.5f + fast_atan2(direction.x(), -direction.z()) * float(0.5 / pi),
            fast_atan2(level, direction.y()) * float(1 / pi)};
}

}  // namespace easypbr::render

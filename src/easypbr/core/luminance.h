// Luminance of linear Rec.709 colours.
#pragma once

#include "easypbr/core/math.h"

namespace easypbr {

inline float luminance(const Vec3& color) {
    return color.dot(Vec3(0.2126f, 0.7152f, 0.0722f));
}

/// Nothing in any channel. Eigen's isZero() takes what is below 1e-5 for nothing.
inline bool is_black(const Vec3& color) {
    return (color.array() == 0).all();
}

}  // namespace easypbr

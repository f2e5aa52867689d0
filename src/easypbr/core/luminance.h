// Luminance of linear Rec.709 colours.
#pragma once

#include "easypbr/core/math.h"

namespace easypbr {

inline float luminance(const Vec3& color) {
    return color.dot(Vec3(0.2126f, 0.7152f, 0.0722f));
}

}  // namespace easypbr

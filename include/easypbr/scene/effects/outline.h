// Settings of outlines.
#pragma once

#include "easypbr/core/math.h"
#include "easypbr/scene/auto.h"

namespace easypbr {

/// Lines along the edges of opaque surfaces in the image, as figures of papers draw them. They are unlit, are
/// drawn after tone mapping, and follow edges of the depth, normal and id targets; transparent layers and the
/// ground have none.
template <template <class> class MaybeAuto>
struct BasicOutlineSettings {
    bool enabled = false;
    float width = 2;          ///< pixels of the image, 0.5 to 16
    Vec3 color{0, 0, 0};      ///< sRGB-encoded
    bool silhouettes = true;  ///< where the depth jumps
    bool creases = true;  ///< where the normals of neighbouring pixels differ by more than crease_angle_deg
    bool objects = true;  ///< between objects, where they touch too
    float crease_angle_deg = 40;    ///< 1 to 180
    MaybeAuto<float> depth_step{};  ///< least jump, world units; automatic: 1 % of the content's diagonal
};
using OutlineSettings = BasicOutlineSettings<Auto>;

}  // namespace easypbr

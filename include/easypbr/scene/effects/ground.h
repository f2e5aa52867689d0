// Settings of the ground plane.
#pragma once

#include "easypbr/core/math.h"
#include "easypbr/scene/auto.h"

namespace easypbr {

enum class GroundMode { none, shadow, plane };

/// A ground plane under the content.
template <template <class> class MaybeAuto>
struct BasicGroundSettings {
    MaybeAuto<GroundMode> mode{};  ///< shadow: a shadow catcher; plane: a visible surface
    MaybeAuto<double> height{};    ///< along the up axis, world units; automatic: just below the content
    float shadow_strength = 1;     ///< opacity factor of the shadow catcher, 0 to 1
    Vec3 plane_color{0.5f, 0.5f, 0.5f};  ///< base colour of the plane, sRGB-encoded
    float plane_roughness = 0.7f;        ///< perceptual roughness of the plane, 0 to 1
    MaybeAuto<float> radius{};           ///< where the plane has faded out, world units; automatic: 12 radii
};
using GroundSettings = BasicGroundSettings<Auto>;

}  // namespace easypbr

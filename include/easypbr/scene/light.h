// Light: point, directional or spot, in photometric units.
#pragma once

#include <string>

#include "easypbr/core/math.h"
#include "easypbr/scene/auto.h"

namespace easypbr {

enum class LightType { point, directional, spot };

/// A light in world space. `color` is linear Rec.709 and multiplies `intensity`.
struct Light {
    LightType type = LightType::point;
    bool enabled = true;
    Vec3 position{0, 0, 0};    ///< point and spot
    Vec3 direction{0, -1, 0};  ///< where the light goes; directional and spot; need not be of unit length
    Vec3 color{1, 1, 1};
    float intensity = 1;        ///< candela (point, spot), lux (directional)
    float inner_cone_deg = 0;   ///< spot: half angle of the full-intensity cone
    float outer_cone_deg = 45;  ///< spot: half angle at which the light ends
    float range = 0;            ///< distance at which the light ends; 0: unlimited
    bool casts_shadows = true;
    /// Point and spot: radius of the glowing sphere, world units; what softens its shadows. 0: a point.
    /// Automatic: a twentieth of the content's radius.
    Auto<float> radius;
    /// Directional: half the angle under which the light is seen; the default is the sun's.
    float angular_radius_deg = 0.265f;

    bool operator==(const Light& other) const;
};

/// Throws ArgumentError that names the light and what is wrong: a number that is not finite or out of range,
/// a direction without length.
void validate(const Light& light, const std::string& name);

/// One of the three-point lights (key, fill, rim): what is automatic is inferred from the scene and the
/// camera.
struct StudioLight {
    Auto<bool> enabled;     ///< automatic: on when no environment was given
    Auto<Vec3> position;    ///< world; automatic: placed relative to the first camera, 3 scene radii away
    Vec3 color{1, 1, 1};    ///< sRGB-encoded
    Auto<float> intensity;  ///< candela; automatic: the same irradiance at the object at any scale
    bool casts_shadows = true;
    Auto<float> radius;  ///< of the glowing sphere; automatic: three tenths of the content's radius
};

}  // namespace easypbr

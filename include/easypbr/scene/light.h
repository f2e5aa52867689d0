// Light: point, directional or spot, in photometric units.
#pragma once

#include <string>

#include "easypbr/core/math.h"
#include "easypbr/scene/auto.h"

namespace easypbr {

enum class LightType { point, directional, spot };

/// What a light in world space is, as in KHR_lights_punctual, but its radius. `color` is linear Rec.709 and
/// multiplies `intensity`.
struct LightSource {
    LightType type = LightType::point;
    bool enabled = true;
    Vec3 position{0, 0, 0};    ///< point and spot
    Vec3 direction{0, -1, 0};  ///< of propagation; directional and spot; need not be of unit length
    Vec3 color{1, 1, 1};
    float intensity = 1;        ///< candela (point, spot) or lux (directional)
    float inner_cone_deg = 0;   ///< spot: half angle of full intensity, degrees
    float outer_cone_deg = 45;  ///< spot: half angle of zero intensity, degrees
    float range = 0;            ///< distance of zero intensity, world units; 0: unlimited
    bool casts_shadows = true;
    /// Directional: angular radius of the emitter in degrees; the default is that of the sun.
    float angular_radius_deg = 0.265f;

    bool operator==(const LightSource& other) const;
};

/// A light of a scene.
struct Light : LightSource {
    /// Point and spot: radius of the spherical emitter in world units, which sets the size of penumbrae. 0: a
    /// point. Automatic: 0.05 of the content's radius.
    Auto<float> radius;

    bool operator==(const Light& other) const;
};

/// Throws ArgumentError that names the light and what is wrong: a number that is not finite or out of range,
/// a direction without length.
void validate(const Light& light, const std::string& name);

/// One of the three-point lights (key, fill, rim). Automatic values are inferred from the scene and the
/// camera.
template <template <class> class MaybeAuto>
struct BasicStudioLight {
    MaybeAuto<bool> enabled{};     ///< automatic: the key, where no environment map is given
    MaybeAuto<Vec3> position{};    ///< world units; automatic: 3 content radii away, by the first camera
    Vec3 color{1, 1, 1};           ///< sRGB-encoded
    MaybeAuto<float> intensity{};  ///< candela; automatic: the same irradiance at the content at any scale
    bool casts_shadows = true;
    MaybeAuto<float> radius{};  ///< of the emitter, world units; automatic: 0.3 of the content's radius
};
using StudioLight = BasicStudioLight<Auto>;

}  // namespace easypbr

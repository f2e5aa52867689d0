// Light: point, directional, spot, or an area that emits; in photometric units.
#pragma once

#include <string>

#include "easypbr/core/math.h"
#include "easypbr/scene/auto.h"

namespace easypbr {

enum class LightType { point, directional, spot, rectangle, disc, sphere };

/// Whether a light is a surface that emits: rectangle, disc, sphere.
constexpr bool is_area(LightType type) {
    return type >= LightType::rectangle;
}

/// What a light in world space is, as in KHR_lights_punctual, but its radius. `color` is linear Rec.709 and
/// multiplies `intensity`. Area lights emit the same radiance from all their points to all directions, from
/// one side (rectangle, disc) or outwards (sphere). Like the other lights they are not in the picture, and
/// hide nothing.
struct LightSource {
    LightType type = LightType::point;
    bool enabled = true;
    Vec3d position{0, 0, 0};  ///< all but directional; the centre of area lights
    /// Of propagation; directional and spot. Rectangle and disc: the normal of the side that emits. Need not
    /// be of unit length.
    Vec3 direction{0, -1, 0};
    Vec3 color{1, 1, 1};
    float intensity = 1;        ///< candela (point, spot), lux (directional) or cd/m2 (area lights)
    float inner_cone_deg = 0;   ///< spot: half angle of full intensity, degrees
    float outer_cone_deg = 45;  ///< spot: half angle of zero intensity, degrees
    float range = 0;            ///< point, spot: distance of zero intensity, world units; 0: unlimited
    Vec2 size{1, 1};            ///< rectangle: width and height, world units
    /// Rectangle: the direction of its width, projected onto its plane. One along the normal is replaced by
    /// any.
    Vec3 width_axis{1, 0, 0};
    bool casts_shadows = true;
    /// Directional: angular radius of the emitter in degrees; the default is that of the sun.
    float angular_radius_deg = 0.265f;

    bool operator==(const LightSource& other) const;
};

/// A light of a scene.
struct Light : LightSource {
    /// World units. Point and spot: of the spherical emitter, which sets the size of penumbrae; 0: a point.
    /// Disc and sphere: of the light. Automatic: 0.05 of the content's radius; of points and spots half of
    /// the distance to the nearest surface at most.
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
    MaybeAuto<bool> enabled{};  ///< automatic: the key, where no environment map is given
    /// World units; automatic: 3 content radii away, by the first camera. The key of closed content: beside
    /// it.
    MaybeAuto<Vec3d> position{};
    Vec3 color{1, 1, 1};           ///< sRGB-encoded
    MaybeAuto<float> intensity{};  ///< candela; automatic: the same irradiance at the content at any scale
    bool casts_shadows = true;
    MaybeAuto<float> radius{};  ///< of the emitter, world units; automatic: 0.3 of the content's radius
};
using StudioLight = BasicStudioLight<Auto>;

}  // namespace easypbr

// The light that a ray brings back.
#pragma once

#include <optional>

#include "easypbr/render/raytrace/bright_sky.h"
#include "easypbr/render/raytrace/ray_random.h"
#include "easypbr/render/raytrace/ray_scene.h"

namespace easypbr {
struct ResolvedSettings;
}

namespace easypbr::render {

/// A part of a picture's lights and sky, in world directions, and what they do to the surfaces that rays
/// meet. Paths of surfaces end after `bounces`.
class RayLight {
  public:
    /// Surfaces that a path meets after the one that is seen.
    static constexpr int bounces = 3;

    /// Keeps what it makes of an environment for as long as the next call asks for the same one. `resolved`
    /// and the scene must live as long as rays are traced.
    void prepare(const ResolvedSettings& resolved, const RayScene& scene);

    /// Radiance of the sky in a direction, without the sun.
    Vec3 sky(const Vec3& direction) const;

    /// How many of the rays are best sent where the sky is brighter than on average: the part of its light
    /// that is there.
    float bright_part() const { return bright_.bright_part(); }
    /// A direction of the bright sky, and the density of such directions, per steradian.
    Vec3 bright_direction(const Vec2& u) const;
    float bright_density(const Vec3& direction) const;

    /// Radiance that a surface sends back along a ray that met it. `scattered`: the ray left a matt surface.
    Vec3 radiance(const RayHit& hit, const Vec3& direction, bool scattered, RayRandom& random) const;

  private:
    /// What a ground shows that catches shadows, by the light that arrives there: a background of one colour
    /// to mirrors, else the sky behind it.
    Vec3 caught(const RayHit& hit, const Vec3& direction, bool scattered, RayRandom& random) const;
    /// Irradiance, divided by pi.
    struct Light {
        Vec3 arrives{0, 0, 0}, all{0, 0, 0};  ///< all: if nothing stood in the way
    };
    Light from_lights(const RayHit& hit, const Vec3& normal) const;
    /// What arrives of the sky's light on a surface, likewise, by a ray in one direction.
    Vec3 open_sky(const RayHit& hit, RayRandom& random) const;
    /// Irradiance of the open sky on a surface, divided by pi.
    Vec3 even_sky(const Vec3& normal) const;

    const ResolvedSettings* resolved_ = nullptr;
    const RayScene* scene_ = nullptr;
    std::optional<Vec3> background_;
    std::string hash_;
    Image sky_;
    BrightSky bright_;  ///< of the sky's picture
};

}  // namespace easypbr::render

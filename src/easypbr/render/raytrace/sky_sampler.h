// Directions of the sky that its light comes from.
#pragma once

#include <string>

#include "easypbr/render/raytrace/bright_sky.h"
#include "easypbr/scene/environment.h"

namespace easypbr::render {

/// An environment as paths see it; in world directions.
class SkySampler {
  public:
    /// Keeps what it makes of an environment for as long as the next call asks for the same one, which must
    /// live as long as it is read. Empty: there is no sky.
    void prepare(const Environment& environment, const Mat3& R_env_world, float intensity);

    bool empty() const { return environment_.empty(); }
    /// Radiance in a unit direction.
    Vec3 radiance(const Vec3& direction) const;

    /// Whether directions are chosen at all: not of a sky that is as bright everywhere.
    bool is_sampled() const { return bright_.bright_part() > 0; }
    /// Light that is found by such directions: the integral of their radiance, of the mean of the channels.
    float brightness() const { return intensity_ * bright_.brightness(); }
    struct Sample {
        Vec3 direction;  ///< unit
        Vec3 radiance;
        float density;
    };
    /// A direction by a point of the unit square; the brighter the sky is beyond its mean, the likelier.
    Sample sample(const Vec2& u) const;
    /// A direction that was chosen in another way, with the density of those that are chosen here. The lower
    /// its own density, per steradian, the less of the sky's detail shows: the radiance is that of a smaller
    /// map then.
    Sample seen(const Vec3& direction, float density) const;

  private:
    Vec3 texel_at(const Vec2& place) const;

    Environment environment_;
    Mat3 R_env_world_ = Mat3::Identity();
    float intensity_ = 1;
    std::string hash_;
    BrightSky bright_;
};

}  // namespace easypbr::render

// Directions of the sky that its light comes from.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

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
    /// Whether directions are chosen at all: not of a sky that is as bright everywhere.
    bool is_sampled() const { return bright_.bright_part() > 0; }
    /// Light that is found by such directions: the integral of their radiance, of the mean of the channels.
    float brightness() const { return intensity_ * bright_.brightness(); }
    /// Irradiance over pi on a surface with this normal that nothing hides anything from, luminance.
    float light_on(const Vec3& normal) const;
    struct Sample {
        Vec3 direction{0, 0, 0};  ///< unit
        Vec3 radiance{0, 0, 0};
        float density = 0;
    };
    /// Directions by points of the unit square, which should be many; the brighter the sky is beyond its
    /// mean, the likelier.
    std::vector<Sample> sample(std::span<const Vec2> points) const;
    /// A direction that was chosen in another way, with the density of those that are chosen here. The lower
    /// its own density, per steradian, the less of the sky's detail shows: the radiance is that of a smaller
    /// map then.
    Sample seen(const Vec3& direction, float density) const;
    /// The same of many.
    std::vector<Sample> seen(std::span<const Vec3> directions, std::span<const float> densities) const;

  private:
    /// What is read for a place of the map, which is filtered as the background is: linearly.
    struct Texels {
        std::array<const float*, 4> at;  ///< left and right, above and below
        float x, y;                      ///< of the place between them, 0 to 1
    };
    Texels texels_at(const Vec2& place) const;
    /// Radiance of the environment map itself.
    Vec3 detail_at(const Vec2& place) const;
    /// An environment map of few texels, each as several that are filtered as above.
    Image finer() const;
    Sample seen_at(const Vec2& place, const Vec3& direction, float density) const;

    Environment environment_;
    Mat3 R_env_world_ = Mat3::Identity();
    float intensity_ = 1;
    std::string hash_;
    BrightSky bright_;
};

}  // namespace easypbr::render

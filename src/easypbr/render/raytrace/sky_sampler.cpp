#include "easypbr/render/raytrace/sky_sampler.h"

#include "easypbr/render/raytrace/sky_place.h"

namespace easypbr::render {
namespace {

/// A finer map of densities finds nothing that the radiance itself does not tell.
constexpr int widest_distribution = 512;
/// Directions of less density, per steradian, stand for at least a hundred texels of such a map.
constexpr float most_blurred = 100;

}  // namespace

void SkySampler::prepare(const Environment& environment, const Mat3& R_env_world, float intensity) {
    R_env_world_ = R_env_world;
    intensity_ = intensity;
    const std::string hash = environment.empty() ? std::string() : environment.hash();
    environment_ = environment;
    if (hash_ == hash) return;
    hash_.clear();  // until all is there: it can be interrupted
    bright_ = {};
    if (environment.empty()) return;
    Image map = environment.image();
    while (map.width() > widest_distribution) map = half_size(map);
    bright_.prepare(map);
    hash_ = hash;
}

Vec3 SkySampler::texel_at(const Vec2& place) const {
    const Image& image = environment_.image();
    const Vec2i at = pixel_at(place, {image.width(), image.height()});
    return intensity_ * Eigen::Map<const Vec3>(image.at<float>(at.x(), at.y()));
}

SkySampler::Sample SkySampler::seen(const Vec3& direction, float density) const {
    if (empty()) return {direction, Vec3::Zero(), 0};
    const Vec2 place = sky_place(R_env_world_ * direction);
    const Vec4& small = bright_.texel(place);
    const float chosen = is_sampled() ? small.w() : 0;
    if (density < most_blurred) return {direction, intensity_ * small.head<3>(), chosen};
    return {direction, texel_at(place), chosen};
}

Vec3 SkySampler::radiance(const Vec3& direction) const {
    return empty() ? Vec3(Vec3::Zero()) : texel_at(sky_place(R_env_world_ * direction));
}

SkySampler::Sample SkySampler::sample(const Vec2& u) const {
    const BrightSky::Sample sample = bright_.sample(u);
    return {R_env_world_.transpose() * sample.direction(), intensity_ * sample.radiance, sample.density};
}

}  // namespace easypbr::render

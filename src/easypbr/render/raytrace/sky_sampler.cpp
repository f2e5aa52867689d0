#include "easypbr/render/raytrace/sky_sampler.h"

namespace easypbr::render {
namespace {

/// A finer map of densities finds nothing that the radiance itself does not tell.
constexpr int widest_distribution = 512;

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

Vec3 SkySampler::texel_at(const Vec2& uv) const {
    const Image& image = environment_.image();
    const Vec2i at = pixel_at(uv, {image.width(), image.height()});
    return intensity_ * Eigen::Map<const Vec3>(image.at<float>(at.x(), at.y()));
}

Vec3 SkySampler::radiance(const Vec3& direction) const {
    return empty() ? Vec3(Vec3::Zero()) : texel_at(equirect_uv(R_env_world_ * direction));
}

float SkySampler::density(const Vec3& direction) const {
    return is_sampled() ? bright_.density(equirect_uv(R_env_world_ * direction)) : 0;
}

SkySampler::Sample SkySampler::sample(const Vec2& u) const {
    const auto [uv, density] = bright_.sample(u);
    return {R_env_world_.transpose() * equirect_direction(uv.x(), uv.y()), texel_at(uv), density};
}

}  // namespace easypbr::render

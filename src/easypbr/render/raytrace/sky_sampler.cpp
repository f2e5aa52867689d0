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

Vec2 SkySampler::place_of(const Vec3& direction) const {
    const Mat3& R = R_env_world_;
    return sky_place(R.col(0) * direction.x() + R.col(1) * direction.y() + R.col(2) * direction.z());
}

const float* SkySampler::texel_at(const Vec2& place) const {
    const Image& image = environment_.image();
    const Vec2i at = pixel_at(place, {image.width(), image.height()});
    return image.at<float>(at.x(), at.y());
}

SkySampler::Sample SkySampler::seen_at(const Vec2& place, const Vec3& direction, float density) const {
    const Vec4& small = bright_.texel(place);
    const float chosen = is_sampled() ? small.w() : 0;
    const float* texel = density < most_blurred ? small.data() : texel_at(place);
    return {direction, intensity_ * Eigen::Map<const Vec3>(texel), chosen};
}

SkySampler::Sample SkySampler::seen(const Vec3& direction, float density) const {
    if (empty()) return {direction, Vec3::Zero(), 0};
    return seen_at(place_of(direction), direction, density);
}

std::vector<SkySampler::Sample> SkySampler::seen(std::span<const Vec3> directions,
                                                 std::span<const float> densities) const {
    std::vector<Sample> samples(directions.size());
    if (empty()) return samples;
    std::vector<Vec2> places(directions.size());
    for (size_t i = 0; i < places.size(); ++i) {
        places[i] = place_of(directions[i]);
        __builtin_prefetch(&bright_.texel(places[i]));
        if (densities[i] >= most_blurred) __builtin_prefetch(texel_at(places[i]));
    }
    for (size_t i = 0; i < places.size(); ++i) samples[i] = seen_at(places[i], directions[i], densities[i]);
    return samples;
}

float SkySampler::light_on(const Vec3& normal) const {
    return empty() ? 0 : intensity_ * bright_.light_on(R_env_world_ * normal);
}

std::vector<SkySampler::Sample> SkySampler::sample(std::span<const Vec2> points) const {
    std::vector<BrightSky::Sample> places(points.size());
    bright_.sample(points, places);
    const Mat3 R_world_env = R_env_world_.transpose();
    std::vector<Sample> samples;
    samples.reserve(points.size());
    for (const BrightSky::Sample& at : places)
        samples.push_back({R_world_env.lazyProduct(at.direction()), intensity_ * at.radiance, at.density});
    return samples;
}

}  // namespace easypbr::render

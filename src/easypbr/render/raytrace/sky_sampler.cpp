#include "easypbr/render/raytrace/sky_sampler.h"

#include <algorithm>
#include <array>

#include "easypbr/native/shaders.h"
#include "easypbr/render/raytrace/sky_place.h"

namespace easypbr::render {
namespace {

/// A finer map of densities finds nothing that the radiance itself does not tell.
constexpr int widest_distribution = 512;
/// Directions of less density, per steradian, stand for at least a hundred texels of such a map.
constexpr float most_blurred = 100;
/// Directions that are turned at once, and what they read is fetched.
constexpr size_t together = 64;

/// Zeros behind what is read: idle lanes hold numbers.
struct Numbers : std::array<float, together> {
    Numbers() { fill(0); }
};

struct Rotation {
    float columns[3][3];
};

Rotation rotation_of(const Mat3& R) {
    Rotation rotation;
    std::copy_n(R.data(), 9, rotation.columns[0]);
    return rotation;
}

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
    return seen_at(sky_place(R_env_world_ * direction), direction, density);
}

std::vector<SkySampler::Sample> SkySampler::seen(std::span<const Vec3> directions,
                                                 std::span<const float> densities) const {
    std::vector<Sample> samples(directions.size());
    if (empty()) {
        for (size_t i = 0; i < samples.size(); ++i) samples[i] = {directions[i], Vec3::Zero(), 0};
        return samples;
    }
    const Rotation rotation = rotation_of(R_env_world_);
    Numbers x, y, z, u, v;
    for (size_t begin = 0; begin < samples.size(); begin += together) {
        const size_t count = std::min(together, samples.size() - begin);
        for (size_t i = 0; i < count; ++i) {
            x[i] = directions[begin + i].x();
            y[i] = directions[begin + i].y();
            z[i] = directions[begin + i].z();
        }
        native::find_map_places(rotation.columns, {x.data(), y.data(), z.data()}, int(count), u.data(),
                                v.data());
        for (size_t i = 0; i < count; ++i) {
            __builtin_prefetch(&bright_.texel({u[i], v[i]}));
            if (densities[begin + i] >= most_blurred) __builtin_prefetch(texel_at({u[i], v[i]}));
        }
        for (size_t i = 0; i < count; ++i)
            samples[begin + i] = seen_at({u[i], v[i]}, directions[begin + i], densities[begin + i]);
    }
    return samples;
}

float SkySampler::light_on(const Vec3& normal) const {
    return empty() ? 0 : intensity_ * bright_.light_on(R_env_world_ * normal);
}

std::vector<SkySampler::Sample> SkySampler::sample(std::span<const Vec2> points) const {
    std::vector<Sample> samples(points.size());
    const Rotation rotation = rotation_of(R_env_world_.transpose());
    std::array<BrightSky::Sample, together> places;
    Numbers u, cosines, sines, x, y, z;
    for (size_t begin = 0; begin < points.size(); begin += together) {
        const size_t count = std::min(together, points.size() - begin);
        bright_.sample(points.subspan(begin, count), std::span(places).first(count));
        for (size_t i = 0; i < count; ++i) {
            u[i] = places[i].u;
            cosines[i] = float(places[i].cos_theta);
            sines[i] = places[i].sin_theta();
        }
        native::find_map_directions(rotation.columns, u.data(), cosines.data(), sines.data(), int(count),
                                    {x.data(), y.data(), z.data()});
        for (size_t i = 0; i < count; ++i)
            samples[begin + i] = {{x[i], y[i], z[i]}, intensity_ * places[i].radiance, places[i].density};
    }
    return samples;
}

}  // namespace easypbr::render

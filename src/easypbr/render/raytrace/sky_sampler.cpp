#include "easypbr/render/raytrace/sky_sampler.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "easypbr/render/raytrace/sky_place.h"

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
    const int height = environment.image().height();
    row_cosines_.clear();
    for (int y = 1; y <= height; ++y) row_cosines_.push_back(std::cos(pi * y / height));
    hash_ = hash;
}

Vec3 SkySampler::texel(int x, int y) const {
    return intensity_ * Eigen::Map<const Vec3>(environment_.image().at<float>(x, y));
}

SkySampler::Sample SkySampler::seen(const Vec3& direction) const {
    if (empty()) return {direction, Vec3::Zero(), 0};
    const Vec2 place = sky_place(R_env_world_ * direction);
    const Image& image = environment_.image();
    const Vec2i at = pixel_at(place, {image.width(), image.height()});
    return {direction, texel(at.x(), at.y()), is_sampled() ? bright_.density(place) : 0};
}

Vec3 SkySampler::radiance(const Vec3& direction) const {
    if (empty()) return Vec3::Zero();
    const Image& image = environment_.image();
    const Vec2i at = pixel_at(sky_place(R_env_world_ * direction), {image.width(), image.height()});
    return texel(at.x(), at.y());
}

int SkySampler::row_of(const BrightSky::Sample& sample) const {
    const int height = environment_.image().height(), rows = bright_.rows();
    const int first = int(int64_t(sample.row) * height / rows);
    const int last = std::max(first, int(int64_t(sample.row + 1) * height / rows) - 1);
    int row = std::min(last, first + int(sample.within_row * float(last - first + 1)));
    while (row > first && row_cosines_[size_t(row) - 1] < sample.cos_theta) --row;
    while (row < last && row_cosines_[size_t(row)] > sample.cos_theta) ++row;
    return row;
}

SkySampler::Sample SkySampler::sample(const Vec2& u) const {
    const BrightSky::Sample sample = bright_.sample(u);
    const int width = environment_.image().width();
    const int x = std::min(int(sample.u * float(width)), width - 1);
    return {R_env_world_.transpose() * sample.direction(), texel(x, row_of(sample)), sample.density};
}

}  // namespace easypbr::render

#include "easypbr/render/raytrace/sky_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "easypbr/native/shaders.h"
#include "easypbr/render/raytrace/sky_place.h"

namespace easypbr::render {
namespace {

/// A finer map of densities finds nothing that the radiance itself does not tell.
constexpr int widest_distribution = 512;
/// Texels of a coarser one would show in lobes as narrow as those that read it.
constexpr int narrowest_distribution = 256, lowest_distribution = narrowest_distribution / 2;
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
    const Image& image = environment.image();
    Image map =
        image.width() < narrowest_distribution || image.height() < lowest_distribution ? finer() : image;
    while (map.width() > widest_distribution) map = half_size(map);
    bright_.prepare(map);
    hash_ = hash;
}

SkySampler::Texels SkySampler::texels_at(const Vec2& place) const {
    const Image& image = environment_.image();
    const float x = place.x() * float(image.width()) - 0.5f, y = place.y() * float(image.height()) - 0.5f;
    const float left = std::floor(x), above = std::floor(y);
    const int column = std::clamp(int(left), -1, image.width() - 1), row = int(above);
    const auto row_at = [&](int at) { return std::clamp(at, 0, image.height() - 1); };
    const auto column_at = [&](int at) { return (at + image.width()) % image.width(); };
    const int columns[2] = {column_at(column), column_at(column + 1)},
              rows[2] = {row_at(row), row_at(row + 1)};
    return {{image.at<float>(columns[0], rows[0]), image.at<float>(columns[1], rows[0]),
             image.at<float>(columns[0], rows[1]), image.at<float>(columns[1], rows[1])},
            x - left,
            y - above};
}

Vec3 SkySampler::detail_at(const Vec2& place) const {
    const Texels texels = texels_at(place);
    const auto texel = [&](int i) { return Eigen::Map<const Vec3>(texels.at[size_t(i)]); };
    const Vec3 above = texel(0) + texels.x * (texel(1) - texel(0)),
               below = texel(2) + texels.x * (texel(3) - texel(2));
    return above + texels.y * (below - above);
}

Image SkySampler::finer() const {
    const Image& image = environment_.image();
    const auto times = [](int least, int count) { return (least + count - 1) / count; };
    Image map(image.width() * times(narrowest_distribution, image.width()),
              image.height() * times(lowest_distribution, image.height()), 3, PixelType::f32);
    for (int y = 0; y < map.height(); ++y)
        for (int x = 0; x < map.width(); ++x) {
            const Vec2 place((float(x) + 0.5f) / float(map.width()), (float(y) + 0.5f) / float(map.height()));
            Eigen::Map<Vec3>(map.at<float>(x, y)) = detail_at(place);
        }
    return map;
}

SkySampler::Sample SkySampler::seen_at(const Vec2& place, const Vec3& direction, float density) const {
    const Vec4& small = bright_.texel(place);
    const float chosen = is_sampled() ? small.w() : 0;
    const Vec3 radiance = density < most_blurred ? Vec3(small.head<3>()) : detail_at(place);
    return {direction, intensity_ * radiance, chosen};
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
            if (densities[begin + i] < most_blurred) continue;
            const Texels texels = texels_at({u[i], v[i]});
            __builtin_prefetch(texels.at[0]);
            __builtin_prefetch(texels.at[2]);
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

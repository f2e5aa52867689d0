// Directions of the light that a sky has beyond its mean.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "easypbr/core/image.h"
#include "easypbr/core/math.h"

namespace easypbr::render {

/// Distribution over an equirectangular map by how much brighter its pixels are than its mean (MIS
/// compensation, Karlik et al. 2019): what is left is found by sampling BSDFs.
class BrightSky {
  public:
    /// `map`: RGB, f32, radiance.
    void prepare(const Image& map);

    /// Share of the map's light that lies above its mean, 0 to 1; 0 where the map is even but for roundings.
    float bright_part() const { return bright_part_; }
    /// That part's integral over all directions, of the mean of the channels.
    float brightness() const { return brightness_; }
    /// Luminance times the cosine to a normal of the map, integrated over the hemisphere, over pi.
    float light_on(const Vec3& normal) const;
    /// At a place of the map, 0 to 1 each: radiance, and the density of sampled directions, per steradian.
    const Vec4& texel(const Vec2& uv) const;
    struct Sample {
        float u = 0;           ///< place across the map, 0 to 1
        double cos_theta = 0;  ///< of the angle from straight up
        Vec3 radiance{0, 0, 0};
        float density = 0;  ///< per steradian

        float sin_theta() const;
        /// Unit direction of the map.
        Vec3 direction() const;
    };
    /// Places by points of the unit square, which should be many: what each reads of the tables, which are
    /// larger than caches, is fetched while others are at work. Densities are 0 where the map is even.
    void sample(std::span<const Vec2> points, std::span<Sample> samples) const;

    Sample sample(const Vec2& point) const {
        Sample sample;
        this->sample({&point, 1}, {&sample, 1});
        return sample;
    }

  private:
    Vec2i size_{0, 0};
    float bright_part_ = 0, brightness_ = 0;
    std::vector<Vec4> texels_;       ///< radiance and density
    std::vector<float> row_ends_;    ///< CDF over the rows
    std::vector<float> pixel_ends_;  ///< and within each of them
    std::vector<uint16_t> row_guide_, pixel_guide_;
    std::vector<double> row_cosines_;  ///< of the rows' upper borders and the last one's lower
};

/// The pixel of a map that a place lies in, 0 to 1 each.
Vec2i pixel_at(const Vec2& uv, Vec2i size);

}  // namespace easypbr::render

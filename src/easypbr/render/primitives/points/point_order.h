// In which order the points of a cloud are drawn, and what is kept in that order.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "easypbr/core/large_array.h"
#include "easypbr/core/math.h"
#include "easypbr/render/raster/batch_cache.h"
#include "easypbr/render/raster/point_batches.h"
#include "easypbr/scene/array.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::render {

/// The colours of points in the order of their batches. Neighbours on the screen are neighbours in memory,
/// which they seldom are in the order of a file.
class PointColors {
  public:
    PointColors() = default;
    /// Of all points of the batches: n x 3 or n x 4, of which alpha is left out. On all cores.
    PointColors(const PointBatches& batches, const ArrayXf& C);

    /// The same numbers as in C.
    Vec3 at(uint32_t place) const {
        if (codes_.empty())
            return Vec3(values_[3 * size_t(place)], values_[3 * size_t(place) + 1],
                        values_[3 * size_t(place) + 2]);
        const uint32_t code = codes_[place];
        return Vec3(float(code & 255), float(code >> 8 & 255), float(code >> 16)) / 255.0f;
    }
    void prefetch(uint32_t place) const {
        if (codes_.empty())
            __builtin_prefetch(&values_[3 * size_t(place)]);
        else
            __builtin_prefetch(&codes_[place]);
    }

  private:
    LargeVector<uint32_t> codes_;  ///< red, green and blue from the lowest bits on, where all have 8 bits
    LargeVector<float> values_;    ///< elsewhere
};

/// Of the points of a cloud. Null: there are none yet, and points are drawn in their own order.
struct PointOrder {
    const PointBatches* batches = nullptr;
    const PointColors* colors = nullptr;  ///< of the same order
};

/// Batches of clouds by the revision of their points, and their colours by that of both.
class BatchedClouds {
  public:
    /// See BatchCache. Valid until what is unused is evicted.
    PointOrder draw(const MeshData& cloud, bool with_colors) {
        if (cloud.V.rows() < small_cloud) return {};
        const auto* batches = batches_.draw(
            cloud.V.revision(), [V = cloud.V] { return std::make_shared<const PointBatches>(V); });
        if (!batches) return {};
        if (!with_colors) return {batches->get()};
        const auto colors = [batches = *batches, C = cloud.C] { return PointColors(*batches, C); };
        return {batches->get(), colors_.draw({cloud.V.revision(), cloud.C.revision()}, colors)};
    }
    void evict_unused() {
        batches_.evict_unused();
        colors_.evict_unused();
    }

  private:
    /// Points that are drawn in a millisecond.
    static constexpr Eigen::Index small_cloud = 1 << 15;

    BatchCache<uint64_t, std::shared_ptr<const PointBatches>> batches_;
    BatchCache<std::pair<uint64_t, uint64_t>, PointColors> colors_;
};

}  // namespace easypbr::render

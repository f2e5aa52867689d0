// The points of a cloud in batches of neighbours: what the raster projects many at once, or leaves out.
#pragma once

#include <cstdint>
#include <vector>

#include "easypbr/core/large_array.h"
#include "easypbr/core/math.h"
#include "easypbr/native/kernels.h"
#include "easypbr/scene/array.h"

namespace easypbr::render {

class PointBatches {
  public:
    PointBatches() = default;
    /// On all cores.
    explicit PointBatches(const Array3f& V);

    size_t count() const { return spheres_.size(); }
    int size_of(size_t batch) const;
    /// Of a batch: all x, all y, all z. Lanes beyond them can be read.
    const float* points_of(size_t batch) const { return blocks_[batch].points; }
    /// The vertices that they are, in the same order; behind the points in memory.
    const uint32_t* ids_of(size_t batch) const { return blocks_[batch].ids; }
    /// The place of the first point of a batch: places count all points in the order of the batches.
    static uint32_t first_place(size_t batch) { return uint32_t(most * batch); }
    /// The vertex at a place.
    uint32_t vertex_of(uint32_t place) const { return blocks_[place / most].ids[place % most]; }
    /// Around the points; infinite where one is not finite.
    struct Sphere {
        Vec3 center;
        float radius;
    };
    const Sphere& sphere_of(size_t batch) const { return spheres_[batch]; }

    /// Bytes of a batch in memory, from its points on: a page.
    static constexpr size_t block_size = 4096;

  private:
    static constexpr size_t most = native::PointBatch::most_points;

    struct alignas(block_size) Block {
        float points[3 * most];
        uint32_t ids[most];
    };
    static_assert(sizeof(Block) == block_size);

    size_t point_count_ = 0;
    LargeVector<Block> blocks_;
    std::vector<Sphere> spheres_;
};

/// Around points: all x, all y, all z. Infinite where one is not finite.
PointBatches::Sphere sphere_around(const float* points, int count);

}  // namespace easypbr::render

// Rasterises triangles on the CPU: for machines without a GPU, where it is several times faster than the
// driver's.
#pragma once

#include <bit>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/core/memory_pool.h"
#include "easypbr/native/kernels.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/raster/hierarchical_depth.h"
#include "easypbr/render/raster/point_raster.h"
#include "easypbr/render/raster/triangle_raster.h"
#include "easypbr/scene/array.h"

namespace easypbr::render {

/// Triangles have holes: of their pixels those with a lower alpha than the cutoff are left out.
struct AlphaTest {
    /// The alphas of pixels, whose faces count from the first of the triangles.
    std::function<void(std::span<const native::VisiblePixel> pixels, std::span<float> alpha)> alpha;
    float cutoff = 0.5f;
};

/// Which of the points of equal depth is seen: the one of the larger content, of these the one of the lower
/// number. Neither depends on the order in which they are drawn.
struct PointRank {
    uint64_t content = 0;
    uint32_t number = 0;
};

/// One layer of depth peeling. Only what is nearer than a limit is drawn, or with `backs` what is farther.
struct PeelLimits {
    PooledVector<float> depths;  ///< reversed, of the pixels of the area, row by row
    bool farthest = true;        ///< of what is drawn the farthest is kept, not the nearest
    bool backs = false;          ///< instead the nearest back faces of volumes that lie behind the limits
};

/// The nearest triangle or point of each pixel of a rectangle. Rules as OpenGL's: 8 bits of sub-pixel
/// precision, top-left. The result does not depend on the number of threads.
class VisibilityBuffer {
  public:
    /// Nothing is visible. `size` is that of the whole picture, `area` the part that is kept.
    void clear(Vec2i size, const PixelRect& area);

    /// Gives the memory back: clear() comes next.
    void release() { PooledVector<uint64_t>().swap(pixels_); }

    /// After clear(): what is drawn until end_layer() is one layer. The limits must live until then.
    void begin_layer(const PeelLimits& limits);
    /// Makes the layer what is visible. Its depths are the limits of the next one; where it holds nothing the
    /// pixel is finished.
    void end_layer(PeelLimits& limits);
    bool is_layer() const { return limits_ != nullptr; }
    /// Whether nothing but back faces of volumes are drawn: see PeelLimits::backs. There is no end_layer()
    /// then.
    bool takes_backs() const { return limits_ && limits_->backs; }

    /// Draws triangles numbered from `first_id`. Returns false, with nothing drawn, where TriangleRaster
    /// does.
    bool draw(const ScreenTriangles& triangles, uint32_t first_id, const AlphaTest* test = nullptr);

    /// Draws points numbered from `first_id` as discs or squares that face the viewer; each covers at least
    /// the pixel that it lies in. They are numbered in the order of their batches where there are any. Points
    /// before the near plane or outside of the picture are left out. `rank` decides among points of equal
    /// depth; it is asked for by id, that of what is there already too.
    void draw_points(const Array3f& V, const PointSplats& splats, uint32_t first_id,
                     const std::function<PointRank(uint32_t id)>& rank);

    /// Whether nothing of what lies within the bounds would be seen. False while a layer is drawn, of which
    /// what is seen is not always the nearest.
    bool hides(const ScreenBounds& bounds);

    const PixelRect& area() const { return raster_.area(); }
    /// Pixels of the area, row by row: 0 where there is nothing.
    std::span<const uint64_t> pixels() const { return {pixels_.data(), pixels_.size()}; }

    /// Shrinks the area to what is covered.
    void crop();

    static uint32_t id_of(uint64_t pixel) { return ~uint32_t(pixel); }
    /// Reversed depth of the nearest point, or of a triangle in the plane of its snapped vertices.
    static float depth_of(uint64_t pixel) { return std::bit_cast<float>(uint32_t(pixel >> 32)); }

  private:
    TriangleRaster raster_;
    HierarchicalDepth hierarchy_;
    PooledVector<uint64_t> pixels_;  ///< depth in the upper, complement of the id in the lower half
    const PeelLimits* limits_ = nullptr;
};

/// The depth of what is nearest in each pixel, and no more: half the memory, and nothing to convert before it
/// is uploaded.
class DepthBuffer {
  public:
    /// Every pixel holds `nothing`, which is less than 0.
    void clear(Vec2i size, float nothing);
    /// See TriangleRaster.
    bool draw(const ScreenTriangles& triangles);
    /// Keeps the larger of a pixel and a depth; from any thread.
    void put(size_t pixel, float depth);
    /// See VisibilityBuffer.
    bool hides(const ScreenBounds& bounds);
    /// Adds what another buffer of the same size and area holds.
    void add(const VisibilityBuffer& other);
    /// Row by row, reversed depths as floats' bits.
    std::span<const int32_t> bits() const { return pixels_; }

  private:
    TriangleRaster raster_;
    HierarchicalDepth hierarchy_;
    PooledVector<int32_t> pixels_;  ///< floats' bits: those of positive ones are in the order of their values
};

/// Sets the pixels of the raster's area to 1 that triangles cover. See TriangleRaster.
bool cover(TriangleRaster& raster, const ScreenTriangles& triangles, std::span<uint8_t> covered);

}  // namespace easypbr::render

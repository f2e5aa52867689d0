// Rasterises triangles on the CPU: for machines without a GPU, where it is several times faster than the
// driver's.
#pragma once

#include <bit>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/render/frame.h"
#include "easypbr/render/point_splats.h"
#include "easypbr/scene/array.h"

namespace easypbr::render {

/// The nearest triangle or point of each pixel of a rectangle. Rules as OpenGL's: 8 bits of sub-pixel
/// precision, top-left. The result does not depend on the number of threads.
class VisibilityBuffer {
  public:
    /// Nothing is visible. `size` is that of the whole picture, `area` the part that is kept.
    void clear(Vec2i size, const PixelRect& area);

    /// Draws triangles numbered from `first_id`. Faces whose winding is clockwise on the screen are left out
    /// unless `both_sides`; `mirrored` swaps the two. Returns false, with nothing drawn, when a vertex is
    /// before the near plane or so far outside of the picture that triangles would have to be clipped.
    bool draw(const Array3f& V, const Array3i& F, int first_face, int face_count, const Mat4& clip_from_mesh,
              uint32_t first_id, bool both_sides, bool mirrored);

    /// Draws points numbered from `first_id` as discs or squares that face the viewer; each covers at least
    /// the pixel that it lies in. Points before the near plane or outside of the picture are left out. Of
    /// points of equal depth the one with the larger `content` is kept, so that the picture does not depend
    /// on their order; it is asked for by id, that of what is there already too.
    void draw_points(const Array3f& V, const PointSplats& splats, uint32_t first_id,
                     const std::function<uint64_t(uint32_t id)>& content);

    const PixelRect& area() const { return area_; }
    /// Pixels of the area, row by row: 0 where there is nothing.
    std::span<const uint64_t> pixels() const { return {pixels_.data(), pixels_.size()}; }

    /// Shrinks the area to what is covered.
    void crop();

    static uint32_t id_of(uint64_t pixel) { return ~uint32_t(pixel); }
    /// Reversed depth of the nearest point, or of a triangle in the plane of its snapped vertices.
    static float depth_of(uint64_t pixel) { return std::bit_cast<float>(uint32_t(pixel >> 32)); }

  private:
    /// A vertex on the screen, x to the right and y downwards.
    struct ScreenVertex {
        int32_t x, y;  ///< 1/256 of a pixel
        float depth;   ///< reversed, (0, 1]
    };
    void draw_triangle(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c, uint32_t id,
                       const PixelRect& box);
    template <class Integer>
    void fill(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c, uint32_t id, int x0,
              int x1, int y0, int y1);

    Vec2i size_{0, 0};
    PixelRect area_;
    std::vector<uint64_t> pixels_;  ///< depth in the upper, complement of the id in the lower half
    std::vector<ScreenVertex> screen_;
};

}  // namespace easypbr::render

// Rasterises triangles on the CPU: for machines without a GPU, where it is several times faster than the
// driver's.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/render/frame.h"
#include "easypbr/scene/array.h"

namespace easypbr::render {

/// The nearest triangle of each pixel of a rectangle. Rules as OpenGL's: 8 bits of sub-pixel precision,
/// top-left. The result does not depend on the number of threads.
class VisibilityBuffer {
  public:
    /// Nothing is visible. `size` is that of the whole picture, `area` the part that is kept.
    void clear(Vec2i size, const PixelRect& area);

    /// Draws triangles numbered from `first_id`. Faces whose winding is clockwise on the screen are left out
    /// unless `both_sides`; `mirrored` swaps the two. Returns false, with nothing drawn, when a vertex is
    /// before the near plane or so far outside of the picture that triangles would have to be clipped.
    bool draw(const Array3f& V, const Array3i& F, int first_face, int face_count, const Mat4& clip_from_mesh,
              uint32_t first_id, bool both_sides, bool mirrored);

    const PixelRect& area() const { return area_; }
    /// Pixels of the area, row by row: 0 where there is nothing.
    std::span<const uint64_t> pixels() const { return {pixels_.data(), pixels_.size()}; }

    /// Shrinks the area to what is covered.
    void crop();

    static uint32_t id_of(uint64_t pixel) { return ~uint32_t(pixel); }

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

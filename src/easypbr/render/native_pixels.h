// Pixels of surfaces that were found natively, on their way into the G-buffer.
#pragma once

#include <cstdint>
#include <vector>

#include "easypbr/render/draw_list.h"
#include "easypbr/render/frame.h"
#include "easypbr/render/gbuffer.h"
#include "easypbr/render/programs.h"

namespace easypbr::render {

/// What the G-buffer holds of one pixel.
struct SurfacePixel {
    Vec3 albedo{0, 0, 0};
    Vec3 normal{0, 0, 1};  ///< unit, world, on the side that is seen
    float metallic = 0, roughness = 0;
    SurfaceKind kind = SurfaceKind::lit;
    float depth = 0;       ///< reversed; 0: nothing
    uint32_t object = 0;   ///< place in the snapshot
    uint32_t element = 0;  ///< of its object: the face or the point
};

/// Pixels of a rectangle in the targets' formats.
class NativePixels {
  public:
    void resize(const PixelRect& area, bool with_ids);

    const PixelRect& area() const { return area_; }

    /// Pixels are counted row by row in the rectangle. May be called from any thread for different pixels.
    void put(size_t index, const SurfacePixel& pixel);
    void put_nothing(size_t index);

    /// Writes the rectangle, where nothing was found too.
    void upload(const GBuffer& targets) const;

  private:
    PixelRect area_;
    bool with_ids_ = false;
    std::vector<uint16_t> albedo_, normal_;
    std::vector<uint8_t> material_;
    std::vector<float> depth_;
    std::vector<uint32_t> id_, element_;
};

/// Adds pixels to what the G-buffer holds, where they are nearer.
class SurfaceComposite {
  public:
    void draw(const Frame& frame, const NativePixels& pixels, const GBuffer& targets);

  private:
    GBuffer staging_;
    ProgramVariants programs_{"screen_triangle.vert", "composite_surface.frag"};
};

}  // namespace easypbr::render

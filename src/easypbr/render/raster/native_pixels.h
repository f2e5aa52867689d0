// Pixels of surfaces that were found natively, on their way into the G-buffer.
#pragma once

#include <cstdint>
#include <vector>

#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/programs.h"

namespace easypbr::render {

/// What the G-buffer holds of one pixel.
struct SurfacePixel {
    Vec3 albedo{0, 0, 0};
    Vec3 normal{0, 0, 1};  ///< unit, world, on the side that is seen
    float metallic = 0, roughness = 0;
    SurfaceKind kind = SurfaceKind::lit;
    float depth = 0;        ///< reversed; 0: nothing
    uint32_t object = 0;    ///< place in the snapshot
    uint32_t element = 0;   ///< of its object: the face or the vertex
    bool is_point = false;  ///< a vertex
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

/// Adds surfaces that were drawn elsewhere to what the G-buffer holds.
class SurfaceComposite {
  public:
    /// Native pixels, where they are nearer.
    void draw(const Frame& frame, const NativePixels& pixels, const GBuffer& targets,
              const SurfaceOutputs& outputs);

    /// What another G-buffer holds, whatever is in front.
    void draw_over(const Frame& frame, const GBuffer& source, const GBuffer& targets,
                   const SurfaceOutputs& outputs);

    /// Closes gaps of a pixel between points, `times` over.
    void fill_holes(const Frame& frame, const GBuffer& targets, const SurfaceOutputs& outputs, int times);

  private:
    void copy(const Frame& frame, const GBuffer& source, const PixelRect& area, const GBuffer& targets,
              const SurfaceOutputs& outputs, bool always);
    void make_staging(const Frame& frame, const SurfaceOutputs& outputs);

    GBuffer staging_;
    ProgramVariants programs_{"screen_triangle.vert", "composite_surface.frag"};
    ProgramVariants fill_{"screen_triangle.vert", "fill_holes.frag"};
};

}  // namespace easypbr::render

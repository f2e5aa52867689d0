// Surfels into the G-buffer.
#pragma once

#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/primitives/surfels/software_surfels.h"
#include "easypbr/render/primitives/surfels/surfel_splats.h"
#include "easypbr/render/raster/native_pixels.h"

namespace easypbr::render {

class SurfelPass {
  public:
    /// What the driver draws with is shared with other passes and must outlive this one.
    explicit SurfelPass(SurfelSplats& splats) : splats_(splats) {}

    /// Adds the surfels to what the G-buffer holds; natively, which is faster where there is no GPU, or by
    /// the driver. What is nearest at a pixel and within a band behind it is one surface, of whatever item.
    void draw(const Frame& frame, const std::vector<DrawItem>& items, const GBuffer& targets,
              const SurfaceOutputs& outputs, bool native);

  private:
    void draw_natively(const Frame& frame, const std::vector<DrawItem>& items, const GBuffer& targets,
                       const SurfaceOutputs& outputs);

    SurfelSplats& splats_;
    SoftwareSurfels software_;
    NativePixels pixels_;
    SurfaceComposite composite_;
};

}  // namespace easypbr::render

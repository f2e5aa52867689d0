// Adds surfaces that were drawn elsewhere to what the textures of a G-buffer hold.
#pragma once

#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/programs.h"

namespace easypbr::render {

class SurfaceComposite {
  public:
    /// A G-buffer in host memory to write to, for draw(), as large as the frame.
    const GBuffer& staging(const Frame& frame, const SurfaceOutputs& outputs);
    /// What was written to it, where it is nearer.
    void draw(const Frame& frame, const GBuffer& targets, const SurfaceOutputs& outputs,
              Transfers& transfers);

    /// What another G-buffer holds, whatever is in front.
    void draw_over(const Frame& frame, const GBuffer& source, const GBuffer& targets,
                   const SurfaceOutputs& outputs);

    /// Closes gaps of a pixel between points, `times` over.
    void fill_holes(const Frame& frame, const GBuffer& targets, const SurfaceOutputs& outputs, int times);

    // The same natively: G-buffers hold the whole frame in host memory.
    static void put_over(const GBuffer& source, const GBuffer& targets);
    static void fill_host_holes(const Frame& frame, const GBuffer& targets, int times);

  private:
    struct How {
        bool always = false;      ///< whatever is in front
        bool emission = false;    ///< the source's radiance counts
        bool extensions = false;  ///< the source holds them
    };
    void copy(const Frame& frame, const GBuffer& source, const PixelRect& area, const GBuffer& targets,
              const SurfaceOutputs& outputs, How how);

    GBuffer staging_;
    ProgramVariants programs_{"screen_triangle.vert", "composite_surface.frag"};
    ProgramVariants fill_{"screen_triangle.vert", "fill_holes.frag"};
};

}  // namespace easypbr::render

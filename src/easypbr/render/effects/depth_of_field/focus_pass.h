// Depth of field of a single frame. Stills of several samples look through different places of the lens
// instead, which is exact: see prepare_frame().
#pragma once

#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/programs.h"

namespace easypbr::render {

/// Blurs the radiance by the thin lens's circle of confusion, at half resolution, what is near over what is
/// far. What is hidden in the picture cannot be seen around what hides it, and circles are at most a
/// sixteenth of the picture's height in radius.
class FocusPass {
  public:
    /// The blurred radiance, RGBA32F, of the G-buffer's radiance and depth. `bounds` are those of all
    /// content. Until the next call.
    const gl::Texture& draw(const Frame& frame, const GBuffer& targets, const Box3d& bounds);

  private:
    void make_targets(Vec2i size);

    gl::Texture light_, confusion_, behind_, before_, hidden_, radiance_;
    gl::Framebuffer halved_, gathered_, composed_;
    ProgramVariants halve_{"screen_triangle.vert", "focus_halve.frag"};
    ProgramVariants gather_{"screen_triangle.vert", "focus_gather.frag"};
    ProgramVariants compose_{"screen_triangle.vert", "focus_compose.frag"};
};

/// Largest radius of a circle of confusion that a single frame draws, in pixels.
double largest_confusion(const Frame& frame, const Box3d& bounds);

}  // namespace easypbr::render

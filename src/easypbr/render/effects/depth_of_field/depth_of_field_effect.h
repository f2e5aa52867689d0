// Depth of field of a single frame. Stills of several samples look through different places of the lens
// instead, which is exact: see make_frame().
#pragma once

#include "easypbr/render/effects/effect.h"
#include "easypbr/render/frame/programs.h"

namespace easypbr::render {

/// Blurs the radiance by the thin lens's circle of confusion, at half resolution, what is near over what is
/// far. What is hidden in the picture cannot be seen around what hides it, and circles are at most a
/// sixteenth of the picture's height in radius.
class DepthOfFieldEffect : public Effect {
  public:
    const char* name() const override { return "depth of field"; }
    bool is_on(const Shot& shot) const override;
    int reach(const Frame& whole, const Box3d& bounds) const override;
    void draw(const EffectInputs& inputs, LitPicture& lit) override;

  private:
    void make_targets(Vec2i size);

    gl::Texture light_, confusion_, behind_, before_, hidden_;
    Target radiance_;
    gl::Framebuffer halved_, gathered_, composed_;
    ProgramVariants halve_{"screen_triangle.vert", "focus_halve.frag"};
    ProgramVariants gather_{"screen_triangle.vert", "focus_gather.frag"};
    ProgramVariants compose_{"screen_triangle.vert", "focus_compose.frag"};
};

}  // namespace easypbr::render

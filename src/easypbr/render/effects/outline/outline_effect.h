// Outlines: silhouettes, creases and borders of objects.
#pragma once

#include "easypbr/render/effects/effect.h"
#include "easypbr/render/frame/programs.h"

namespace easypbr::render {

/// Finds the edges between neighbouring pixels of the G-buffer, then draws a line of the given width around
/// each. Reversed depth is linear over a plane in the image, so a plane has no depth edge, however steep it
/// is seen.
class OutlineEffect : public Effect {
  public:
    const char* name() const override { return "outline"; }
    bool is_on(const Shot& shot) const override;
    bool draws_overlay() const override { return true; }
    int reach(const Frame& whole, const Box3d& bounds) const override;
    void draw(const EffectInputs& inputs, LitPicture& lit) override;

  private:
    void find_edges(const EffectInputs& inputs);

    gl::Texture
        edges_;  ///< RG8: whether an edge lies between a pixel and the next one to the right, and below
    gl::Framebuffer found_;
    gl::Framebuffer overlay_;
    uint32_t overlay_id_ = 0;
    ProgramVariants edge_programs_{"screen_triangle.vert", "outline_edges.frag"};
    ProgramVariants line_programs_{"screen_triangle.vert", "outline_lines.frag"};
};

}  // namespace easypbr::render

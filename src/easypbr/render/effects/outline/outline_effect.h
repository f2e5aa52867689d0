// Outlines: silhouettes, creases and borders of objects.
#pragma once

#include "easypbr/render/effects/effect.h"
#include "easypbr/render/frame/screen_shader.h"

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
    void shade(const EffectInputs& inputs, LitPicture& lit, Transfers& transfers) override;

  private:
    ShaderInputs edge_inputs(const EffectInputs& inputs) const;
    ShaderInputs line_inputs(const Frame& frame) const;
    void make_edges(Vec2i size);

    Target edges_;  ///< RG8: whether an edge lies between a pixel and the next one to the right, and below
    gl::Framebuffer found_;
    gl::Framebuffer overlay_;
    ScreenShader finding_{"outline_edges.frag", native::Shader::outline_edges};
    ScreenShader lines_{"outline_lines.frag", native::Shader::outline_lines};
};

}  // namespace easypbr::render

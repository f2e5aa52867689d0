// Depth of field of a single frame. Stills of several samples look through different places of the lens
// instead, which is exact: see make_frame().
#pragma once

#include "easypbr/render/effects/effect.h"
#include "easypbr/render/frame/screen_shader.h"

namespace easypbr::render {

/// Blurs the radiance by the thin lens's circle of confusion, at half resolution, what is near over what is
/// far. What is hidden in the picture cannot be seen around what hides it, and circles are at most a
/// sixteenth of the picture's height in radius. Colours that are shown past the tone curve stay sharp, and
/// take no part.
class DepthOfFieldEffect : public Effect {
  public:
    const char* name() const override { return "depth of field"; }
    bool is_on(const Shot& shot) const override;
    int reach(const Frame& whole, const Box3d& bounds) const override;
    void draw(const EffectInputs& inputs, LitPicture& lit) override;
    void shade(const EffectInputs& inputs, LitPicture& lit, Transfers& transfers) override;

  private:
    void make_targets(Vec2i size);
    void make_framebuffers();
    /// `overlay`: some surfaces may be shown past light and tone curve.
    ShaderInputs halve_inputs(const EffectInputs& inputs, bool overlay) const;
    ShaderInputs gather_inputs(const EffectInputs& inputs, bool overlay) const;
    ShaderInputs compose_inputs(const EffectInputs& inputs, bool overlay) const;
    void finish(LitPicture& lit) const;

    Target light_, confusion_, weight_, behind_, before_, hidden_;  ///< of half resolution
    Target radiance_;
    gl::Framebuffer halved_, gathered_, composed_;
    ScreenShader halve_{"focus_halve.frag", native::Shader::focus_halve};
    ScreenShader gather_{"focus_gather.frag", native::Shader::focus_gather};
    ScreenShader compose_{"focus_compose.frag", native::Shader::focus_compose};
};

}  // namespace easypbr::render

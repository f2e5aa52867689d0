// Bloom: light that spreads around what is bright.
#pragma once

#include <functional>
#include <vector>

#include "easypbr/render/effects/bloom/glow.h"
#include "easypbr/render/effects/effect.h"
#include "easypbr/render/frame/screen_shader.h"

namespace easypbr::render {

/// A pyramid of blurred light whose levels count alike (Jimenez 2014, "Next Generation Post Processing in
/// Call of Duty: Advanced Warfare"), the first at a quarter of the resolution. The light that is spread is
/// taken from where it was, so that the sum of all light stays, and an even picture stays as it is.
class BloomEffect : public Effect {
  public:
    const char* name() const override { return "bloom"; }
    bool is_on(const Shot& shot) const override;
    int reach(const Frame& whole, const Box3d& bounds) const override;
    void draw(const EffectInputs& inputs, LitPicture& lit) override;
    void shade(const EffectInputs& inputs, LitPicture& lit, Transfers& transfers) override;

  private:
    struct Picture {
        Target target;
        gl::Framebuffer framebuffer;
    };
    struct Level {
        Picture light, glow;
        Vec2 extent;  ///< of the picture in texels: not whole
    };
    /// Runs a shader over a level, of which a part is kept: by the driver, or natively.
    using Run = std::function<void(ScreenShader&, const ShaderInputs&, Picture& to, float kept)>;

    void begin(const Frame& frame);
    void make_levels(Vec2i size, int count);
    void make_framebuffers();
    ShaderInputs block_inputs(const Frame& frame, const Target& radiance) const;
    ShaderInputs gather_inputs() const;
    /// From the first level's light to the glow.
    void spread(const Run& run);
    void finish(LitPicture& lit);

    Glow glow_;
    Vec2i size_{0, 0};
    std::vector<Level> levels_;
    Target sums_[4];  ///< of the blocks of pixels around the first level's texels
    gl::Framebuffer summed_;
    ScreenShader blocks_{"bloom_blocks.frag", native::Shader::bloom_blocks};
    ScreenShader gather_{"bloom_gather.frag", native::Shader::bloom_gather};
    ScreenShader resample_{"bloom_resample.frag", native::Shader::bloom_resample};
};

}  // namespace easypbr::render

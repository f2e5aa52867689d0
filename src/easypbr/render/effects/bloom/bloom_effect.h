// Bloom: light that spreads around what is bright.
#pragma once

#include <vector>

#include "easypbr/render/effects/bloom/glow.h"
#include "easypbr/render/effects/effect.h"
#include "easypbr/render/frame/programs.h"

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

  private:
    struct Level {
        gl::Texture light, glow;
        gl::Framebuffer lit, glowing;
        Vec2 extent;  ///< of the picture in texels: not whole
    };
    void make_levels(Vec2i size, int count);
    void gather(const Frame& frame, const gl::Texture& radiance);
    /// Draws what a texture of this extent holds to another level, by {"DOWN"}, {"UP"}, or {}: of the same
    /// size.
    void resample(const gl::Texture& from, const Vec2& extent, const gl::Framebuffer& to,
                  const std::vector<std::string>& step, const gl::Blending& blending);

    Glow glow_;
    Vec2i size_{0, 0};
    std::vector<Level> levels_;
    gl::Texture sums_[4];  ///< of the blocks of pixels around the first level's texels
    gl::Framebuffer summed_;
    ProgramVariants blocks_{"screen_triangle.vert", "bloom_blocks.frag"};
    ProgramVariants gather_{"screen_triangle.vert", "bloom_gather.frag"};
    ProgramVariants resample_{"screen_triangle.vert", "bloom_resample.frag"};
};

}  // namespace easypbr::render

// Lights the G-buffer.
#pragma once

#include "easypbr/gpu/environment_maps.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/programs.h"
#include "easypbr/render/shadow/light_block.h"

namespace easypbr::render {

class LightingPass {
  public:
    /// Adds the light of a block to the radiance target where there is geometry, and that of an environment
    /// unless `maps` is null.
    void draw(const Frame& frame, const GBuffer& targets, const LightBlock& block,
              const gpu::EnvironmentMaps* maps);

    /// Adds the light that a block and the environment send to the pixels of the ground's catcher, with and
    /// without shadows, to `light` (GroundPass::light()).
    void draw_caught(const Frame& frame, const GBuffer& targets, const LightBlock& block,
                     const gpu::EnvironmentMaps* maps, const gl::Framebuffer& light);

  private:
    const gl::Texture& dfg(Brdf brdf);
    void set_environment(const gl::Program& program, const Frame& frame, const gpu::EnvironmentMaps& maps);
    void set_lights(const gl::Program& program, const Frame& frame, const LightBlock& block);
    void set_behind(const gl::Program& program, const Frame& frame);
    void set_extensions(const gl::Program& program, const Frame& frame, const GBuffer& targets, bool first);

    ProgramVariants programs_{"screen_triangle.vert", "lighting_surface.frag"};
    ProgramVariants catcher_{"screen_triangle.vert", "lighting_catcher.frag"};
    gl::Texture dfg_, sheen_albedo_;
    Brdf dfg_brdf_ = Brdf::height_correlated;
    gl::Buffer lights_, shadows_;
};

}  // namespace easypbr::render

// Lights the G-buffer.
#pragma once

#include "easypbr/gpu/environment_maps.h"
#include "easypbr/render/frame.h"
#include "easypbr/render/gbuffer.h"
#include "easypbr/render/programs.h"

namespace easypbr::render {

class LightingPass {
  public:
    /// Adds light to the radiance target where there is geometry. `maps` is null without an environment.
    void draw(const Frame& frame, const GBuffer& targets, const gpu::EnvironmentMaps* maps);

  private:
    const gl::Texture& dfg(Brdf brdf);

    ProgramVariants programs_{"screen_triangle.vert", "lighting_surface.frag"};
    gl::Texture dfg_;
    Brdf dfg_brdf_ = Brdf::height_correlated;
    gl::Buffer lights_;
};

}  // namespace easypbr::render

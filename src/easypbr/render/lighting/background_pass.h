// The environment behind the geometry.
#pragma once

#include "easypbr/gpu/environment_maps.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/programs.h"

namespace easypbr::render {

class BackgroundPass {
  public:
    /// Draws the environment, sharp or blurred, where there is no geometry; with `under`, behind all that
    /// does not cover its pixel.
    void draw(const Frame& frame, const GBuffer& targets, const gpu::EnvironmentMaps& maps, bool under);

  private:
    ProgramVariants programs_{"screen_triangle.vert", "background_environment.frag"};
};

}  // namespace easypbr::render

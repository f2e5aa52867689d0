// The environment behind the geometry.
#pragma once

#include "easypbr/gpu/environment_maps.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/screen_shader.h"

namespace easypbr::render {

class BackgroundPass {
  public:
    /// Draws the environment, sharp or blurred, where there is no geometry; with `under`, behind all that
    /// does not cover its pixel.
    void draw(const Frame& frame, const GBuffer& targets, const gpu::EnvironmentMaps& maps, bool under);

    /// The same natively: the radiance target is in host memory.
    void shade(const Frame& frame, const GBuffer& targets, const gpu::EnvironmentMaps& maps, bool under,
               Transfers& transfers);

  private:
    ScreenShader shader_{"background_environment.frag", native::Shader::background_environment};
};

}  // namespace easypbr::render

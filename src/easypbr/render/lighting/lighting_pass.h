// Lights the G-buffer.
#pragma once

#include <optional>

#include "easypbr/gpu/environment_maps.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/screen_shader.h"
#include "easypbr/render/lighting/mirrored_ground.h"
#include "easypbr/render/raytrace/traced_light.h"
#include "easypbr/render/shadow/light_block.h"

namespace easypbr {
enum class Brdf;
}

namespace easypbr::render {

/// What is seen through a transmissive layer.
struct TransmissionInputs {
    const gl::Texture* picture = nullptr;  ///< radiance of all that is farther, with mip levels
    native::MipPicture host_picture = {};  ///< the same for LightingPass::shade()
    int levels = 1;
    const Target* depth = nullptr;        ///< of the opaque surfaces
    const Target* exit_depth = nullptr;   ///< of volumes' back faces
    const Target* exit_normal = nullptr;  ///< of volumes' back faces
    double reach = 0;                     ///< there is no geometry farther from the camera
};

/// What lights a G-buffer.
struct LightInputs {
    bool native = false;  ///< in host memory, by LightingPass::shade()
    LightBlock block = {};
    const gpu::EnvironmentMaps* environment = nullptr;  ///< with the first block, where there is one
    std::optional<MirroredGround> ground = {};          ///< with the first block, unless rays find it
    const TracedLight* traced = nullptr;                ///< what rays found of the environment's light
    ExtensionSet extensions = 0;                        ///< of the surfaces
    const TransmissionInputs* transmission = nullptr;   ///< where they are transmissive
};

class LightingPass {
  public:
    /// Adds the light of a block to the radiance target where there is geometry, and that of the environment.
    void draw(const Frame& frame, const GBuffer& targets, const LightInputs& inputs);

    /// Adds the light that a block and the environment send to the pixels of the shadow catcher, with and
    /// without shadows, to `light` (GroundPass::light()).
    void draw_caught(const Frame& frame, const GBuffer& targets, const LightInputs& inputs,
                     const gl::Framebuffer& light);

    /// Lights natively: writes the radiance target in host memory, where the surfaces are. The
    /// shadow maps are in host memory.
    void shade(const Frame& frame, const GBuffer& targets, const LightInputs& inputs, Transfers& transfers);
    /// draw_caught() natively: with the first block it writes all of `light`.
    void shade_caught(const Frame& frame, const GBuffer& targets, const LightInputs& inputs,
                      const Target& light, Transfers& transfers);

  private:
    ShaderInputs surface_inputs(const Frame& frame, const GBuffer& targets, const LightInputs& inputs,
                                bool native);
    void set_dfg(ShaderInputs& values, Brdf brdf, bool native);
    void set_extensions(ShaderInputs& values, const Frame& frame, const GBuffer& targets, bool native);
    ScreenShader& surface_shader(const LightInputs& inputs) {
        return inputs.extensions ? extended_ : surface_;
    }
    void set_ltc(ShaderInputs& values, bool native);

    ScreenShader surface_{"lighting_surface.frag", native::Shader::lighting_surface};
    ScreenShader extended_{"lighting_surface_extended.frag", native::Shader::lighting_surface_extended};
    ScreenShader catcher_{"lighting_catcher.frag", native::Shader::lighting_catcher};
    gl::Texture dfg_, sheen_albedo_, ltc_;
    Brdf dfg_brdf_{};
};

}  // namespace easypbr::render

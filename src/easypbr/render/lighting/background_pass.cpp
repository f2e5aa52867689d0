#include "easypbr/render/lighting/background_pass.h"

#include <algorithm>
#include <cmath>

#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// Mip level of the equirectangular picture whose pixels are as large as the screen's: no aliasing, no blur.
float equirect_level(const Frame& frame, int equirect_width) {
    const double texel = 2 * pi / equirect_width;
    const double pixel = frame.orthographic() ? 0.0 : 2.0 / (frame.clip_from_view(1, 1) * frame.size.y());
    return float(std::max(0.0, std::log2(std::max(pixel, 1e-9) / texel)));
}

}  // namespace

void BackgroundPass::draw(const Frame& frame, const GBuffer& targets, const gpu::EnvironmentMaps& maps,
                          bool under) {
    const BackgroundSettings& background = frame.resolved->settings.background;
    const bool blur = background.mode == BackgroundMode::blur;
    std::vector<std::string> defines = camera_defines(frame);
    if (blur) defines.emplace_back("BLUR");
    const gl::Program& program = programs_.get(defines);
    targets.lit().bind();
    program.use();
    set_camera_uniforms(program, frame);
    program.set("u_env_from_world", Mat3(frame.resolved->R_env_world.cast<float>()));
    program.set("u_env_intensity", frame.resolved->settings.environment.intensity);
    const float level =
        blur ? background.blur * maps.last_level() : equirect_level(frame, maps.equirect().width());
    (blur ? maps.prefiltered() : maps.equirect()).bind(0);
    program.set(blur ? "u_prefiltered" : "u_equirect", 0);
    program.set("u_level", level);
    // The triangle lies infinitely far: "equal" draws it where there is no geometry.
    gl::DrawState state{.depth_test = gl::DepthTest::equal};
    if (under)
        state = {.depth_test = gl::DepthTest::always,
                 .blending = {.source = gl::Factor::one_minus_target_alpha, .target = gl::Factor::one}};
    gl::draw_screen(state);
}

}  // namespace easypbr::render

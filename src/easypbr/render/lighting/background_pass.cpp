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

ShaderInputs inputs_of(const Frame& frame, const gpu::EnvironmentMaps& maps, bool native) {
    const BackgroundSettings& background = frame.resolved->settings.background;
    const bool blur = background.mode == BackgroundMode::blur;
    ShaderInputs values;
    values.define(camera_defines(frame));
    if (blur) values.define("BLUR");
    set_camera_uniforms(values, frame);
    values.set("u_env_from_world", Mat3(frame.resolved->R_env_world.cast<float>()));
    values.set("u_env_intensity",
               frame.resolved->settings.environment.intensity * (blur ? maps.scale() : maps.seen_scale()));
    values.set("u_level",
               blur ? background.blur * maps.last_level() : equirect_level(frame, maps.equirect_width()));
    if (blur && native)
        values.set("u_prefiltered", maps.host_prefiltered());
    else if (blur)
        values.set("u_prefiltered", maps.prefiltered());
    else if (native)
        values.set("u_equirect", maps.host_equirect());
    else
        values.set("u_equirect", maps.equirect());
    return values;
}

}  // namespace

void BackgroundPass::draw(const Frame& frame, const GBuffer& targets, const gpu::EnvironmentMaps& maps,
                          bool under) {
    const ShaderInputs values = inputs_of(frame, maps, false);
    targets.lit().bind();
    // The triangle lies infinitely far: "equal" draws it where there is no geometry.
    gl::DrawState state{.depth_test = gl::DepthTest::equal};
    if (under)
        state = {.depth_test = gl::DepthTest::always,
                 .blending = {.source = gl::Factor::one_minus_target_alpha, .target = gl::Factor::one}};
    shader_.draw(values, state);
}

void BackgroundPass::shade(const Frame& frame, const GBuffer& targets, const gpu::EnvironmentMaps& maps,
                           bool under, Transfers& transfers) {
    NativeOutput output{.target = &targets.radiance, .area = targets.radiance.area()};
    if (under) {
        output.store = native::Store::under;
    } else {
        output.where = native::Where::empty;
        output.depth = &targets.depth;
    }
    shader_.shade(inputs_of(frame, maps, true), output, transfers);
}

}  // namespace easypbr::render

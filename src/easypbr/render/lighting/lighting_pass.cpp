#include "easypbr/render/lighting/lighting_pass.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "easypbr/gpu/dfg.h"
#include "easypbr/gpu/ltc.h"
#include "easypbr/render/frame/half_light.h"
#include "easypbr/render/frame/inverse_tone.h"
#include "easypbr/render/frame/shading_inputs.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// Places that soft shadows look at: of a single frame; of so many frames, which are turned against each
/// other, half of them do.
constexpr int soft_taps = 16, frames_of_few_taps = 8;

using LightUniforms = std::array<blocks::Light, lights_per_block>;
using ShadowUniforms = std::array<blocks::ShadowMap, lights_per_block>;

Vec4 vec4(double x, double y, double z, double w) {
    return Eigen::Vector4d(x, y, z, w).cast<float>();
}

void write_shadow(const LightShadow& shadow, const Vec3d& camera, int resolution, ShadowUniforms& uniforms,
                  size_t index) {
    blocks::ShadowMap& to = uniforms[index];
    const ShadowView& view = shadow.projection->views[0];
    // A cube's faces turn the axes themselves.
    const Mat3d R = shadow.projection->is_cube() ? Mat3d(Mat3d::Identity()) : view.R_light_world;
    const Vec3d t = R * (camera - view.position);
    to.x = vec4(R(0, 0), R(0, 1), R(0, 2), t.x());
    to.y = vec4(R(1, 0), R(1, 1), R(1, 2), t.y());
    to.z = vec4(R(2, 0), R(2, 1), R(2, 2), t.z());
    to.window = vec4(view.scale.x(), view.scale.y(), view.offset.x(), view.offset.y());
    const double range = view.far - view.near;
    const double per_w = view.perspective ? view.near : 1 / range;  // depth per slope of a plane
    to.depth = view.perspective ? vec4(0, view.near, 1, shadow.first_layer)
                                : vec4(-1 / range, view.far / range, 0, shadow.first_layer);
    const double texel = 1 / (std::min(view.scale.x(), view.scale.y()) * resolution);
    to.size = vec4(shadow.radius / per_w, per_w, texel, shadow.projection->nearest_depth);
}

/// Slope of the facets that frame `index` of `count` reflects in, in units of alpha: quantiles of the slopes
/// of GGX along one axis, whose distribution function is (1 + x / sqrt(1 + x^2)) / 2.
float lobe_slope(int index, int count) {
    const double u = (2 * index + 1.0) / count - 1;
    return float(u / std::sqrt(1 - u * u));
}

/// Slope of the facet that frame `index` of `count` refracts at, in units of alpha: points of the golden
/// spiral at the quantiles of GGX's slopes, P(slope < x) = x^2 / (1 + x^2).
Vec2 lobe_point(int index, int count) {
    if (count == 1) return Vec2::Zero();
    const double u = (index + 0.5) / count, radius = std::sqrt(u / (1 - u));
    const double angle = index * pi * (3 - std::sqrt(5.0));
    return Vec2(float(radius * std::cos(angle)), float(radius * std::sin(angle)));
}

/// Macros of all shaders that light.
std::vector<std::string> light_defines(const Frame& frame, const GBuffer& targets,
                                       const LightInputs& inputs) {
    const LightBlock& block = inputs.block;
    const bool with_environment = inputs.environment != nullptr;
    std::vector<std::string> defines = camera_defines(frame);
    defines.push_back(fmt::format("LIGHTS_PER_BLOCK {}", lights_per_block));
    if (!block.shadows.empty()) {
        constexpr const char* modes[] = {"SHADOWS_HARD", "SHADOWS_PCF", "SHADOWS_SOFT"};
        defines.emplace_back("SHADOWS");
        defines.emplace_back(modes[size_t(frame.resolved->settings.shadows.mode)]);
    }
    if (block.has_area()) defines.emplace_back("AREA_LIGHTS");
    if (block.cubes > 0) defines.emplace_back("SHADOW_CUBES");
    if (!block.shadows.empty() && block.has_tints()) defines.emplace_back("SHADOW_TINTS");
    if (with_environment) defines.emplace_back("ENVIRONMENT");
    if (with_environment && inputs.traced)
        defines.emplace_back("TRACED");
    else if (with_environment && targets.ambient_occlusion)
        defines.emplace_back("AMBIENT_OCCLUSION");
    return defines;
}

std::vector<std::string> defines_of(const Frame& frame, const GBuffer& targets, const LightInputs& inputs) {
    const bool with_environment = inputs.environment != nullptr;
    std::vector<std::string> defines = light_defines(frame, targets, inputs);
    defines.push_back(fmt::format("DFG_SIZE {}", gpu::dfg_size));
    if (with_environment && frame.sample_count > 1) defines.emplace_back("LOBE_SAMPLES");
    if (with_environment && targets.ambient_occlusion && frame.resolved->settings.ssao.multi_bounce)
        defines.emplace_back("MULTI_BOUNCE");
    add_extension_defines(inputs.extensions, defines);
    if (inputs.transmission) defines.emplace_back("BEHIND");
    return defines;
}

/// What all shaders that light read of the surfaces.
void set_surfaces(ShaderInputs& values, const Frame& frame, const GBuffer& targets) {
    set_camera_uniforms(values, frame);
    values.set("u_normal", targets.normal);
    values.set("u_material", targets.material);
    values.set("u_depth_target", targets.depth);
    if (targets.ambient_occlusion) values.set("u_ambient_occlusion", targets.ambient_occlusion);
}

void set_transmission(ShaderInputs& values, const Frame& frame, const TransmissionInputs& behind,
                      bool native) {
    // Without volumes in the layer nobody asks for their backs: any picture of 4 bytes a pixel will do.
    const auto or_depth = [&](const Target* target) -> const Target& {
        return target ? *target : *behind.depth;
    };
    if (native)
        values.set("u_behind_picture", behind.host_picture);
    else
        values.set("u_behind_picture", *behind.picture);
    values.set("u_behind_depth", *behind.depth);
    values.set("u_exit_depth", or_depth(behind.exit_depth));
    values.set("u_exit_normal", or_depth(behind.exit_normal));
    values.set("u_behind_levels", float(behind.levels));
    values.set("u_behind_reach", float(behind.reach));
    values.set("u_lobe_sample", lobe_point(frame.sample_index, frame.sample_count));
    values.set("u_lobe_share", 1 / std::sqrt(float(frame.sample_count)));
    if (const std::optional<Vec3> background = background_radiance(*frame.resolved)) {
        values.define("BEFORE_COLOR");
        values.set("u_background", *background);
    }
}

void set_environment(ShaderInputs& values, const Frame& frame, const LightInputs& inputs, bool native) {
    const gpu::EnvironmentMaps& maps = *inputs.environment;
    if (native) {
        values.set("u_prefiltered", maps.host_prefiltered());
        values.set("u_irradiance", maps.host_irradiance());
    } else {
        values.set("u_prefiltered", maps.prefiltered());
        values.set("u_irradiance", maps.irradiance());
    }
    values.set("u_env_from_world", Mat3(frame.resolved->R_env_world.cast<float>()));
    values.set("u_last_level", maps.last_level());
    if (frame.sample_count > 1)
        values.set("u_lobe_slope", lobe_slope(frame.sample_index, frame.sample_count));
    values.set("u_env_intensity", frame.resolved->settings.environment.intensity * maps.scale());
    if (!inputs.traced) return;
    values.set("u_traced_scale", half_light_scale(frame.resolved->exposure));
    values.set("u_sky_visibility", inputs.traced->sky_visibility);
    values.set("u_indirect_diffuse", inputs.traced->indirect_diffuse);
    values.set("u_indirect_specular", inputs.traced->indirect_specular);
}

void set_lights(ShaderInputs& values, const Frame& frame, const LightBlock& block, bool native) {
    LightUniforms lights{};
    for (size_t i = 0; i < block.lights.size(); ++i)
        lights[i] = light_uniform(*block.lights[i], frame.camera.position());
    values.set_block(0, "u_lights", gl::bytes_of(lights));
    values.set("u_plain_lights", int(block.plain()));
    values.set("u_block_lights", int(block.lights.size()));
    if (block.shadows.empty()) return;

    ShadowUniforms shadows{};
    for (size_t i = 0; i < block.shadows.size(); ++i)
        write_shadow(block.shadows[i], frame.camera.position(), block.resolution, shadows, i);
    values.set_block(1, "u_shadows", gl::bytes_of(shadows));
    if (native)
        values.set("u_shadow_maps", block.host_maps);
    else
        values.set("u_shadow_maps", *block.maps);
    if (native) {
        values.set("u_tint_absorption", block.host_absorption);
        values.set("u_tint_moment", block.host_moment);
    } else if (block.tints) {
        values.set("u_tint_absorption", block.tints->absorption);
        values.set("u_tint_moment", block.tints->moment);
    }
    values.set("u_single_lights", int(block.lights.size() - block.cubes));
    values.set("u_shadow_resolution", float(block.resolution));
    values.set("u_sample_index", float(frame.sample_index));
    values.set("u_soft_taps", frame.sample_count < frames_of_few_taps ? soft_taps : soft_taps / 2);
    set_noise_uniforms(values, frame);
}

}  // namespace

void LightingPass::set_dfg(ShaderInputs& values, Brdf brdf, bool native) {
    static_assert(gpu::dfg_size == 64 && lights_per_block == 64, "cmake/native.cmake says so too");
    if (native) {
        values.set("u_dfg", gpu::host_dfg(brdf));
        return;
    }
    if (!dfg_ || dfg_brdf_ != brdf) {
        dfg_ = gl::Texture(gl::Format::rg16f, gpu::dfg_size, gpu::dfg_size);
        dfg_.upload(std::as_bytes(gpu::dfg_table(brdf)));
        dfg_.sampling(gl::Filtering::linear);
        dfg_brdf_ = brdf;
    }
    values.set("u_dfg", dfg_);
}

void LightingPass::set_extensions(ShaderInputs& values, const Frame& frame, const GBuffer& targets,
                                  bool native) {
    if (!native && !sheen_albedo_) {
        sheen_albedo_ = gl::Texture(gl::Format::r16f, gpu::dfg_size, gpu::dfg_size);
        sheen_albedo_.upload(std::as_bytes(gpu::sheen_albedo_table()));
        sheen_albedo_.sampling(gl::Filtering::linear);
    }
    values.set("u_extension0", targets.extension[0]);
    values.set("u_extension1", targets.extension[1]);
    if (native)
        values.set("u_sheen_albedo", gpu::host_sheen_albedo());
    else
        values.set("u_sheen_albedo", sheen_albedo_);
    values.set("u_tap_gap", 1.0f / float(frame.sample_count));
    values.set("u_tap_offset", (float(frame.sample_index) + 0.5f) / float(frame.sample_count));
}

void LightingPass::set_ltc(ShaderInputs& values, bool native) {
    if (native) {
        values.set("u_ltc", gpu::host_ltc());
        return;
    }
    if (!ltc_) {
        ltc_ = gl::Texture(gl::Format::rgba32f, gpu::ltc_size, gpu::ltc_size);
        ltc_.upload(std::as_bytes(gpu::ltc_table()));
    }
    values.set("u_ltc", ltc_);
}

ShaderInputs LightingPass::surface_inputs(const Frame& frame, const GBuffer& targets,
                                          const LightInputs& inputs, bool native) {
    const ShadingSettings& shading = frame.resolved->settings.shading;
    ShaderInputs values;
    values.define(defines_of(frame, targets, inputs));
    set_surfaces(values, frame, targets);
    values.set("u_albedo", targets.albedo);
    set_dfg(values, shading.brdf, native);
    set_brdf(values, shading);
    values.set("u_first_block", inputs.block.first ? 1.0f : 0.0f);
    if (inputs.block.has_area()) set_ltc(values, native);
    if (inputs.extensions) set_extensions(values, frame, targets, native);
    if (inputs.transmission) set_transmission(values, frame, *inputs.transmission, native);
    if (inputs.environment) set_environment(values, frame, inputs, native);
    if (inputs.ground) inputs.ground->set(values);
    set_lights(values, frame, inputs.block, native);
    return values;
}

void LightingPass::draw(const Frame& frame, const GBuffer& targets, const LightInputs& inputs) {
    const LightBlock& block = inputs.block;
    const ShaderInputs values = surface_inputs(frame, targets, inputs, false);
    targets.lit().bind();
    // Layers of extended surfaces leave only a part of the emission that stands in the target.
    // The first block knows how much the surface covers.
    const auto kept = inputs.extensions ? gl::Factor::source1_color : gl::Factor::one;
    gl::DrawState state =
        targets.covered_state({.source = gl::Factor::one,
                               .target = kept,
                               .source_alpha = block.first ? gl::Factor::one : gl::Factor::zero,
                               .target_alpha = block.first ? gl::Factor::zero : gl::Factor::one});
    state.scissor = screen_state(frame.covered).scissor;
    surface_shader(inputs).draw(values, state);
}

void LightingPass::shade(const Frame& frame, const GBuffer& targets, const LightInputs& inputs,
                         Transfers& transfers) {
    const bool first = inputs.block.first;
    ShaderInputs values = surface_inputs(frame, targets, inputs, true);
    if (first && targets.emission.is_ahead()) {
        values.define("EMISSION");
        values.set("u_emission", targets.emission);
    }
    surface_shader(inputs).shade(values,
                                 {.target = &targets.radiance,
                                  .area = targets.depth.area(),
                                  .store = first ? native::Store::replace : native::Store::add_light,
                                  .where = native::Where::covered,
                                  .depth = &targets.depth},
                                 transfers);
}

namespace {

ShaderInputs caught_inputs(const Frame& frame, const GBuffer& targets, const LightInputs& inputs,
                           bool native) {
    ShaderInputs values;
    values.define(light_defines(frame, targets, inputs));
    set_surfaces(values, frame, targets);
    if (inputs.environment) set_environment(values, frame, inputs, native);
    set_lights(values, frame, inputs.block, native);
    return values;
}

}  // namespace

void LightingPass::draw_caught(const Frame& frame, const GBuffer& targets, const LightInputs& inputs,
                               const gl::Framebuffer& light) {
    light.bind();
    catcher_.draw(caught_inputs(frame, targets, inputs, false), targets.covered_state(gl::add));
}

void LightingPass::shade_caught(const Frame& frame, const GBuffer& targets, const LightInputs& inputs,
                                const Target& light, Transfers& transfers) {
    const bool first = inputs.block.first;
    if (first) light.write(frame.whole());
    catcher_.shade(caught_inputs(frame, targets, inputs, true),
                   {.target = &light,
                    .area = frame.whole(),
                    .store = first ? native::Store::replace : native::Store::add,
                    .where = native::Where::covered,
                    .depth = &targets.depth},
                   transfers);
}

}  // namespace easypbr::render

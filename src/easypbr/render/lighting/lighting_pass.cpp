#include "easypbr/render/lighting/lighting_pass.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "easypbr/gpu/dfg.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

constexpr unsigned tint_unit = 9;
constexpr int extension_unit = 12;
constexpr int behind_unit = 20;
constexpr int traced_unit = 24;

/// What the uniform blocks hold is stated once, in the text that the shaders include.
namespace blocks {
using vec4 = Vec4;
#include "light_blocks.glsl"
// std140 rounds the size of an element up to that of a vec4.
static_assert(sizeof(Light) == 4 * sizeof(vec4) && sizeof(ShadowMap) == 6 * sizeof(vec4));
static_assert(sizeof(vec4) == 16 && alignof(vec4) <= 16);
}  // namespace blocks

using LightUniforms = std::array<blocks::Light, lights_per_block>;
using ShadowUniforms = std::array<blocks::ShadowMap, lights_per_block>;

void write_light(const LightSource& light, const Vec3d& camera, LightUniforms& uniforms, size_t index) {
    blocks::Light& to = uniforms[index];
    const float kind = light.type == LightType::directional ? 0.0f
                       : light.type == LightType::point     ? 1.0f
                                                            : 2.0f;
    to.position << (light.position.cast<double>() - camera).cast<float>(), kind;
    to.color << light.color * light.intensity, light.range > 0 ? 1 / (light.range * light.range) : 0.0f;
    to.direction << light.direction.normalized(), 0;
    // KHR_lights_punctual: the cone fades from 1 at the inner to 0 at the outer angle.
    const float inner = float(std::cos(radians(light.inner_cone_deg))),
                outer = float(std::cos(radians(light.outer_cone_deg)));
    const float scale = 1 / std::max(1e-3f, inner - outer);
    to.cone << scale, -outer * scale, 0, 0;
}

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
    if (block.cubes > 0) defines.emplace_back("SHADOW_CUBES");
    if (!block.shadows.empty() && block.tints) defines.emplace_back("SHADOW_TINTS");
    if (with_environment) defines.emplace_back("ENVIRONMENT");
    if (with_environment && inputs.traced)
        defines.emplace_back("TRACED");
    else if (with_environment && targets.ambient_occlusion)
        defines.emplace_back("AMBIENT_OCCLUSION");
    return defines;
}

std::vector<std::string> defines_of(const Frame& frame, const GBuffer& targets, const LightInputs& inputs) {
    const bool with_environment = inputs.environment != nullptr;
    const ShadingSettings& shading = frame.resolved->settings.shading;
    std::vector<std::string> defines = light_defines(frame, targets, inputs);
    defines.push_back(fmt::format("DFG_SIZE {}", gpu::dfg_size));
    if (with_environment && frame.sample_count > 1) defines.emplace_back("LOBE_SAMPLES");
    if (with_environment && targets.ambient_occlusion && frame.resolved->settings.ssao.multi_bounce)
        defines.emplace_back("MULTI_BOUNCE");
    if (shading.multiple_scattering) defines.emplace_back("MULTIPLE_SCATTERING");
    if (shading.brdf == Brdf::ue4) defines.emplace_back("BRDF_UE4");
    if (shading.brdf == Brdf::separable) defines.emplace_back("BRDF_SEPARABLE");
    add_extension_defines(inputs.extensions, defines);
    if (inputs.transmission) defines.emplace_back("BEHIND");
    return defines;
}

}  // namespace

const gl::Texture& LightingPass::dfg(Brdf brdf) {
    if (!dfg_ || dfg_brdf_ != brdf) {
        dfg_ = gl::Texture(gl::Format::rg16f, gpu::dfg_size, gpu::dfg_size);
        dfg_.upload(std::as_bytes(gpu::dfg_table(brdf)));
        dfg_.sampling(gl::Filtering::linear);
        dfg_brdf_ = brdf;
    }
    return dfg_;
}

void LightingPass::set_extensions(const gl::Program& program, const Frame& frame, const GBuffer& targets,
                                  bool first) {
    if (!sheen_albedo_) {
        sheen_albedo_ = gl::Texture(gl::Format::r16f, gpu::dfg_size, gpu::dfg_size);
        sheen_albedo_.upload(std::as_bytes(gpu::sheen_albedo_table()));
        sheen_albedo_.sampling(gl::Filtering::linear);
    }
    const gl::Texture* sources[] = {&targets.extension[0].texture(), &targets.extension[1].texture(),
                                    &sheen_albedo_};
    const char* samplers[] = {"u_extension0", "u_extension1", "u_sheen_albedo"};
    for (int i = 0; i < 3; ++i) {
        sources[i]->bind(unsigned(extension_unit + i));
        program.set(samplers[i], extension_unit + i);
    }
    program.set("u_first_block", first ? 1.0f : 0.0f);
    program.set("u_tap_gap", 1.0f / float(frame.sample_count));
    program.set("u_tap_offset", (float(frame.sample_index) + 0.5f) / float(frame.sample_count));
}

void LightingPass::set_transmission(const gl::Program& program, const Frame& frame,
                                    const TransmissionInputs& behind) {
    const gl::Texture* sources[] = {behind.picture, behind.depth, behind.exit_depth, behind.exit_normal};
    const char* samplers[] = {"u_behind", "u_behind_depth", "u_exit_depth", "u_exit_normal"};
    for (int i = 0; i < 4; ++i) {
        // Without volumes in the layer nobody asks for their backs.
        (sources[i] ? sources[i] : behind.depth)->bind(unsigned(behind_unit + i));
        program.set(samplers[i], behind_unit + i);
    }
    program.set("u_behind_levels", float(behind.levels));
    program.set("u_behind_reach", float(behind.reach));
    program.set("u_lobe_sample", lobe_point(frame.sample_index, frame.sample_count));
    program.set("u_lobe_share", 1 / std::sqrt(float(frame.sample_count)));
}

void LightingPass::draw(const Frame& frame, const GBuffer& targets, const LightInputs& inputs) {
    const LightBlock& block = inputs.block;
    targets.lit().bind();
    const Target* sources[] = {&targets.albedo, &targets.normal, &targets.material, &targets.depth};
    for (unsigned unit = 0; unit < 4; ++unit) sources[unit]->bind(unit);
    dfg(frame.resolved->settings.shading.brdf).bind(4);
    const gl::Program& program = programs_.get(defines_of(frame, targets, inputs));
    program.use();
    set_camera_uniforms(program, frame);
    const char* samplers[] = {"u_albedo",      "u_normal",     "u_material",    "u_depth_target",     "u_dfg",
                              "u_prefiltered", "u_irradiance", "u_shadow_maps", "u_ambient_occlusion"};
    if (targets.ambient_occlusion) targets.ambient_occlusion.bind(8);
    for (int unit = 0; unit < 9; ++unit) program.set(samplers[unit], unit);
    program.set("u_dielectric_f0", frame.resolved->settings.shading.dielectric_f0);
    if (inputs.extensions) set_extensions(program, frame, targets, block.first);
    if (inputs.transmission) set_transmission(program, frame, *inputs.transmission);
    if (inputs.environment) set_environment(program, frame, inputs);
    set_lights(program, frame, block);
    // Layers of extended surfaces leave only a part of the emission that stands in the target.
    // The first block knows how much the surface covers.
    const auto kept = inputs.extensions ? gl::Factor::source1_color : gl::Factor::one;
    gl::DrawState state =
        targets.covered_state({.source = gl::Factor::one,
                               .target = kept,
                               .source_alpha = block.first ? gl::Factor::one : gl::Factor::zero,
                               .target_alpha = block.first ? gl::Factor::zero : gl::Factor::one});
    state.scissor = screen_state(frame.covered).scissor;
    gl::draw_screen(state);
}

void LightingPass::draw_caught(const Frame& frame, const GBuffer& targets, const LightInputs& inputs,
                               const gl::Framebuffer& light) {
    light.bind();
    const gl::Program& program = catcher_.get(light_defines(frame, targets, inputs));
    program.use();
    set_camera_uniforms(program, frame);
    const std::pair<const char*, const Target*> sources[] = {
        {"u_normal", &targets.normal}, {"u_material", &targets.material}, {"u_depth_target", &targets.depth}};
    for (int unit = 0; unit < 3; ++unit) {
        program.set(sources[unit].first, unit);
        sources[unit].second->bind(unsigned(unit));
    }
    program.set("u_irradiance", 6);
    program.set("u_shadow_maps", 7);
    program.set("u_ambient_occlusion", 8);
    if (targets.ambient_occlusion) targets.ambient_occlusion.bind(8);
    if (inputs.environment) set_environment(program, frame, inputs);
    set_lights(program, frame, inputs.block);
    gl::draw_screen(targets.covered_state(gl::add));
}

void LightingPass::set_environment(const gl::Program& program, const Frame& frame,
                                   const LightInputs& inputs) {
    const gpu::EnvironmentMaps& maps = *inputs.environment;
    maps.prefiltered().bind(5);
    maps.irradiance().bind(6);
    program.set("u_env_from_world", Mat3(frame.resolved->R_env_world.cast<float>()));
    program.set("u_last_level", maps.last_level());
    if (frame.sample_count > 1)
        program.set("u_lobe_slope", lobe_slope(frame.sample_index, frame.sample_count));
    program.set("u_env_intensity", frame.resolved->settings.environment.intensity);
    if (!inputs.traced) return;
    const std::pair<const char*, const Target*> sources[] = {
        {"u_sky_visibility", &inputs.traced->sky_visibility},
        {"u_indirect_diffuse", &inputs.traced->indirect_diffuse},
        {"u_indirect_specular", &inputs.traced->indirect_specular}};
    for (int i = 0; i < 3; ++i) {
        program.set(sources[i].first, traced_unit + i);
        sources[i].second->bind(unsigned(traced_unit + i));
    }
}

void LightingPass::set_lights(const gl::Program& program, const Frame& frame, const LightBlock& block) {
    if (!lights_) lights_ = gl::Buffer(sizeof(LightUniforms));
    LightUniforms lights{};
    for (size_t i = 0; i < block.lights.size(); ++i)
        write_light(*block.lights[i], frame.camera.position(), lights, i);
    lights_.update(0, gl::bytes_of(lights));
    lights_.bind_uniform(0);
    program.set("u_plain_lights", int(block.plain()));
    if (block.shadows.empty()) return;

    if (!shadows_) shadows_ = gl::Buffer(sizeof(ShadowUniforms));
    ShadowUniforms shadows{};
    for (size_t i = 0; i < block.shadows.size(); ++i)
        write_shadow(block.shadows[i], frame.camera.position(), block.maps->width(), shadows, i);
    shadows_.update(0, gl::bytes_of(shadows));
    shadows_.bind_uniform(1);
    block.maps->bind(7);
    if (block.tints) {
        block.tints->absorption.bind(tint_unit);
        block.tints->moment.bind(tint_unit + 1);
        program.set("u_tint_absorption", int(tint_unit));
        program.set("u_tint_moment", int(tint_unit + 1));
    }
    program.set("u_single_lights", int(block.lights.size() - block.cubes));
    program.set("u_cube_lights", int(block.lights.size()));
    program.set("u_shadow_resolution", float(block.maps->width()));
    program.set("u_sample_index", float(frame.sample_index));
    set_noise_uniforms(program, frame);
}

}  // namespace easypbr::render

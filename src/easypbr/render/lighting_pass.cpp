#include "easypbr/render/lighting_pass.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easypbr/gpu/dfg.h"

namespace easypbr::render {
namespace {

/// As the block in shaders/lighting_surface.frag; any number of lights is drawn in blocks of this many.
constexpr size_t lights_per_block = 64;

struct LightBlock {
    struct {
        Vec4 position, color, direction, cone;
    } lights[lights_per_block];
};

void write_light(const Light& light, const Vec3d& camera, LightBlock& block, size_t index) {
    auto& to = block.lights[index];
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

/// Slope of the facets that frame `index` of `count` reflects in, in units of alpha: quantiles of the slopes
/// of GGX along one axis, whose distribution function is (1 + x / sqrt(1 + x^2)) / 2.
float lobe_slope(int index, int count) {
    const double u = (2 * index + 1.0) / count - 1;
    return float(u / std::sqrt(1 - u * u));
}

std::vector<std::string> defines_of(const Frame& frame, bool with_environment) {
    const ShadingSettings& shading = frame.resolved->settings.shading;
    std::vector<std::string> defines = camera_defines(frame);
    defines.push_back(fmt::format("DFG_SIZE {}", gpu::dfg_size));
    defines.push_back(fmt::format("LIGHTS_PER_BLOCK {}", lights_per_block));
    if (with_environment) defines.emplace_back("ENVIRONMENT");
    if (with_environment && frame.sample_count > 1) defines.emplace_back("LOBE_SAMPLES");
    if (shading.multiple_scattering) defines.emplace_back("MULTIPLE_SCATTERING");
    if (shading.brdf == Brdf::ue4) defines.emplace_back("BRDF_UE4");
    if (shading.brdf == Brdf::separable) defines.emplace_back("BRDF_SEPARABLE");
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

void LightingPass::draw(const Frame& frame, const GBuffer& targets, const gpu::EnvironmentMaps* maps) {
    const std::vector<Light>& lights = frame.resolved->lights;
    if (!lights_) lights_ = gl::Buffer(sizeof(LightBlock));
    targets.lit.bind();
    glEnable(GL_SCISSOR_TEST);
    glScissor(frame.covered.x, frame.covered.y, frame.covered.width, frame.covered.height);
    // The triangle lies infinitely far: "less" draws it where there is geometry, and skips the rest before
    // shading.
    targets.test_covered();
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_ONE, GL_ONE, GL_ONE, GL_ZERO);

    const gl::Texture* sources[] = {&targets.albedo, &targets.normal, &targets.material, &targets.depth};
    for (unsigned unit = 0; unit < 4; ++unit) sources[unit]->bind(unit);
    dfg(frame.resolved->settings.shading.brdf).bind(4);
    if (maps) {
        maps->prefiltered().bind(5);
        maps->irradiance().bind(6);
    }
    lights_.bind_uniform(0);
    size_t first = 0;
    do {
        const bool with_environment = maps && first == 0;
        const size_t count = std::min(lights.size() - first, lights_per_block);
        const gl::Program& program = programs_.get(defines_of(frame, with_environment));
        program.use();
        set_camera_uniforms(program, frame);
        const char* samplers[] = {"u_albedo", "u_normal",      "u_material",  "u_depth_target",
                                  "u_dfg",    "u_prefiltered", "u_irradiance"};
        for (int unit = 0; unit < 7; ++unit) program.set(samplers[unit], unit);
        program.set("u_dielectric_f0", frame.resolved->settings.shading.dielectric_f0);
        program.set("u_light_count", int(count));
        if (with_environment) {
            program.set("u_env_from_world", Mat3(frame.resolved->R_env_world.cast<float>()));
            program.set("u_last_level", maps->last_level());
            if (frame.sample_count > 1)
                program.set("u_lobe_slope", lobe_slope(frame.sample_index, frame.sample_count));
            program.set("u_env_intensity", frame.resolved->settings.environment.intensity);
        }
        LightBlock block{};
        for (size_t i = 0; i < count; ++i) write_light(lights[first + i], frame.camera.position(), block, i);
        lights_.update(0, gl::bytes_of(block));
        draw_screen_triangle();
        first += count;
    } while (first < lights.size());
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    targets.reset_depth_range();
}

}  // namespace easypbr::render

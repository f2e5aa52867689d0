#include "easypbr/render/frame/shading_inputs.h"

#include <algorithm>
#include <cmath>

#include "easypbr/render/frame/screen_shader.h"
#include "easypbr/scene/light_falloff.h"

namespace easypbr::render {

namespace {

/// Numbers by which shaders/light_blocks.glsl knows the types.
float light_code(LightType type) {
    if (type == LightType::directional) return 0;
    return type == LightType::point ? 1.0f : float(type);
}

void add_area(const ResolvedLight& light, double unit, blocks::Light& to) {
    // A sphere has no direction of its own.
    ResolvedLight placed = light;
    if (light.type == LightType::sphere) placed.direction = Vec3(0, 0, 1);
    const EmitterAxes axes = emitter_axes(placed);
    to.color << light.color * light.intensity, 0;
    to.direction << placed.direction.normalized(), float(emitting_area(light) / (unit * unit));
    to.cone << (axes.x / unit).cast<float>(), float(axes.y.norm() / unit);
}

}  // namespace

blocks::Light light_uniform(const ResolvedLight& light, const Vec3d& origin, double unit) {
    // Intensities of lights at a place fall with the square of lengths in this unit.
    const auto scale_of_light = float(light.type == LightType::directional ? 1.0 : 1 / (unit * unit));
    const auto range = float(light.range / unit);
    blocks::Light to;
    to.position << ((light.position - origin) / unit).cast<float>(), light_code(light.type);
    to.color << light.color * (light.intensity * scale_of_light), range > 0 ? 1 / (range * range) : 0.0f;
    if (is_area(light.type)) {
        add_area(light, unit, to);
        return to;
    }
    const float radius = light.type == LightType::directional ? std::tan(radians(light.angular_radius_deg))
                                                              : light.radius / float(unit);
    to.direction << light.direction.normalized(), radius;
    // KHR_lights_punctual: the cone fades from 1 at the inner to 0 at the outer angle.
    const float inner = float(std::cos(radians(light.inner_cone_deg))),
                outer = float(std::cos(radians(light.outer_cone_deg)));
    const float scale = 1 / std::max(1e-3f, inner - outer);
    to.cone << scale, -outer * scale, 0, 0;
    return to;
}

void set_brdf(ShaderInputs& values, const ShadingSettings& shading) {
    if (shading.multiple_scattering) values.define("MULTIPLE_SCATTERING");
    if (shading.brdf == Brdf::ue4) values.define("BRDF_UE4");
    if (shading.brdf == Brdf::separable) values.define("BRDF_SEPARABLE");
    values.set("u_dielectric_f0", shading.dielectric_f0);
}

}  // namespace easypbr::render

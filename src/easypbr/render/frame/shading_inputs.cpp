#include "easypbr/render/frame/shading_inputs.h"

#include <algorithm>
#include <cmath>

#include "easypbr/render/frame/screen_shader.h"

namespace easypbr::render {

blocks::Light light_uniform(const LightSource& light, const Vec3d& origin, double unit) {
    const float kind = light.type == LightType::directional ? 0.0f
                       : light.type == LightType::point     ? 1.0f
                                                            : 2.0f;
    // Intensities of lights at a place fall with the square of lengths in this unit.
    const auto scale_of_light = float(light.type == LightType::directional ? 1.0 : 1 / (unit * unit));
    const auto range = float(light.range / unit);
    blocks::Light to;
    to.position << ((light.position.cast<double>() - origin) / unit).cast<float>(), kind;
    to.color << light.color * (light.intensity * scale_of_light), range > 0 ? 1 / (range * range) : 0.0f;
    to.direction << light.direction.normalized(), 0;
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

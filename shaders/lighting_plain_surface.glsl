// Surfaces without extensions, as the G-buffer holds them.
#include "common_area_light.glsl"
#include "common_surface.glsl"
#include "lighting_sky.glsl"
#include "lighting_plain.glsl"

// What is seen of an area light of radiance 1.
vec3 area_scattered(Light light, Surface s) {
    AreaLobe lobe = lobe_around(s.normal, s.view, ltc_at(s.n_dot_v, s.roughness));
    vec3 specular = s.energy.single * area_form(lobe, light, s.position);
    if (has_multiple_scattering) specular *= compensation(s.energy.f0, s.energy.e);
    return specular + s.diffuse * area_irradiance(light, s.position, s.normal);
}

// As those of lighting_transmission.glsl and lighting_extended_surface.glsl.
vec4 transmitted(Surface s) { return vec4(0.0, 0.0, 0.0, 1.0); }
float kept_below(Surface s) { return 1.0; }

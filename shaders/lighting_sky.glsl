// The environment's light: what of it lies in a lobe, how much of it reaches a surface, and what other surfaces send it
// instead.
#include "common_environment.glsl"

#feature ENVIRONMENT has_environment
#feature LOBE_SAMPLES samples_lobes
#feature MULTI_BOUNCE has_multi_bounce
#feature TRACED has_traced_light

uniform samplerCube u_prefiltered;
uniform samplerCube u_irradiance;
uniform float u_last_level;
uniform float u_env_intensity;
uniform float u_lobe_slope;  // of the facet that this frame reflects in, in units of alpha
// See render/raytrace/traced_light.h.
uniform float u_traced_scale;  // of indirect light
uniform sampler2D u_sky_visibility;
uniform sampler2D u_indirect_diffuse;
uniform sampler2D u_indirect_specular;

// Average radiance of the environment in a lobe around a direction.
vec3 prefiltered(vec3 direction, float roughness) {
    float level = prefiltered_level(roughness, u_last_level);
    return has_environment ? u_env_intensity * textureLod(u_prefiltered, u_env_from_world * direction, level).rgb : vec3(0.0);
}

#include "lighting_ground.glsl"

// Around a direction that it reflects.
vec3 mirrored_lobe(vec3 position, vec3 normal, vec3 direction, float roughness, float alpha) {
    return with_ground(prefiltered(above_horizon(direction, alpha), roughness), position, normal, direction, alpha);
}

// Average radiance in the specular lobe of a surface at `position`.
vec3 lobe_radiance(vec3 position, vec3 normal, vec3 view, float n_dot_v, float roughness, float alpha) {
    // The lobe leans towards the normal the more the rougher the surface is.
    vec3 dominant = normalize(mix(reflect(-view, normal), normal, alpha * alpha));
    if (!samples_lobes) return mirrored_lobe(position, normal, dominant, roughness, alpha);
    // Seen from the side a lobe is NoV times as wide across the plane of incidence as within it, whereas the
    // environment is prefiltered for NoV = 1. The frames of an accumulated picture take it narrower, side by side
    // within the plane.
    float narrowed = mix(min(n_dot_v, 1.0), 1.0, alpha);
    float slope = u_lobe_slope * alpha * sqrt(1.0 - narrowed * narrowed);
    vec3 facet = normalize(view + dominant);
    vec3 within = view - facet * dot(facet, view);
    vec3 h = normalize(facet + within * (slope * inversesqrt(max(dot(within, within), 1e-12))));
    return mirrored_lobe(position, normal, reflect(-view, h), roughness * sqrt(narrowed), alpha * narrowed);
}

// Visibility with what surfaces of this albedo reflect into each other's recesses (Jimenez et al. 2016, a fit).
vec3 diffuse_visibility(float visibility, vec3 albedo) {
    if (!has_multi_bounce) return vec3(visibility);
    vec3 a = 2.0404 * albedo - 0.3324, b = -4.7951 * albedo + 0.6417, c = 2.7552 * albedo + 0.6903;
    return max(vec3(visibility), ((visibility * a + b) * visibility + c) * visibility);
}

// Part of the specular lobe that a surface sees (Lagarde and de Rousiers 2014).
vec3 specular_visibility(float n_dot_v, float alpha, float visibility, vec3 f0) {
    float part = clamp(pow(n_dot_v + visibility, exp2(-16.0 * alpha - 1.0)) - 1.0 + visibility, 0.0, 1.0);
    return diffuse_visibility(part, f0);
}

vec3 traced(sampler2D target) { return texelFetch(target, ivec2(gl_FragCoord.xy), 0).rgb; }

vec3 indirect_diffuse() { return u_traced_scale * traced(u_indirect_diffuse); }

// Light of the environment that leaves a surface evenly: by its diffuse lobe, and after several bounces between its facets. To
// those the ground is what it is to the specular lobe.
vec3 matt_light(Surface s, float visibility) {
    vec3 sky = has_environment ? u_env_intensity * textureLod(u_irradiance, u_env_from_world * s.normal, 0.0).rgb : vec3(0.0);
    if (has_traced_light) sky = sky * traced(u_sky_visibility) + indirect_diffuse();
    vec3 between = has_ground ? with_even_ground(sky, s.normal) : sky;
    return (s.energy.multiple * between + s.diffuse * sky) * diffuse_visibility(visibility, s.diffuse);
}

// Average radiance in the specular lobe, of which `lobe` is the environment's and the ground's.
vec3 mirrored_light(vec3 lobe, float n_dot_v, float alpha, float visibility, vec3 f0) {
    if (has_traced_light) {
        vec4 scene = texelFetch(u_indirect_specular, ivec2(gl_FragCoord.xy), 0);
        lobe = lobe * (1.0 - scene.a) + u_traced_scale * scene.rgb;
    }
    return lobe * specular_visibility(n_dot_v, alpha, visibility, f0);
}

// What arrives of the sky's light in the lobe of the sheen: occluded, or with traced light in place of what is hidden.
vec3 sheen_light(vec3 lobe, float visibility) {
    if (has_traced_light) lobe = lobe * traced(u_sky_visibility) + indirect_diffuse();
    return lobe * visibility;
}

// How much of the environment's light reaches a surface, and what other surfaces send it instead.
// Visibility with what surfaces of this albedo reflect into each other's recesses (Jimenez et al. 2016, a fit).
vec3 diffuse_visibility(float visibility, vec3 albedo) {
#ifdef MULTI_BOUNCE
    vec3 a = 2.0404 * albedo - 0.3324, b = -4.7951 * albedo + 0.6417, c = 2.7552 * albedo + 0.6903;
    return max(vec3(visibility), ((visibility * a + b) * visibility + c) * visibility);
#else
    return vec3(visibility);
#endif
}

// Part of the specular lobe that a surface sees (Lagarde and de Rousiers 2014).
vec3 specular_visibility(float n_dot_v, float alpha, float visibility, vec3 f0) {
    float part = clamp(pow(n_dot_v + visibility, exp2(-16.0 * alpha - 1.0)) - 1.0 + visibility, 0.0, 1.0);
    return diffuse_visibility(part, f0);
}

#ifdef TRACED
// See render/ray_pass.h.
uniform sampler2D u_sky_visibility;
uniform sampler2D u_indirect_diffuse;
uniform sampler2D u_indirect_specular;

vec3 traced(sampler2D target) { return texelFetch(target, ivec2(gl_FragCoord.xy), 0).rgb; }
#endif

// Irradiance divided by pi.
vec3 diffuse_light(vec3 normal, float visibility, vec3 albedo) {
    vec3 sky = u_env_intensity * textureLod(u_irradiance, u_env_from_world * normal, 0.0).rgb;
#ifdef TRACED
    sky = sky * traced(u_sky_visibility) + traced(u_indirect_diffuse);
#endif
    return sky * diffuse_visibility(visibility, albedo);
}

// Average radiance in the specular lobe, of which `lobe` is the environment's.
vec3 mirrored_light(vec3 lobe, float n_dot_v, float alpha, float visibility, vec3 f0) {
    lobe *= u_env_intensity;
#ifdef TRACED
    vec4 scene = texelFetch(u_indirect_specular, ivec2(gl_FragCoord.xy), 0);
    lobe = lobe * (1.0 - scene.a) + scene.rgb;
#endif
    return lobe * specular_visibility(n_dot_v, alpha, visibility, f0);
}

// Average radiance in the lobe of the sheen, which is as wide as the sky.
vec3 sheen_light(vec3 lobe, float visibility) {
    lobe *= u_env_intensity;
#ifdef TRACED
    lobe = lobe * traced(u_sky_visibility) + traced(u_indirect_diffuse);
#endif
    return lobe * visibility;
}

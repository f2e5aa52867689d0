// Lighting of surfaces without extensions.

// Fills in what the following needs; `kind` is the code of the surface's.
void prepare(inout Surface s, vec3 albedo, float metallic, float kind) {
    s.f0 = mix(vec3(u_dielectric_f0), albedo, metallic);
    vec2 dfg = dfg_at(s.n_dot_v, s.roughness);
    Energy dielectric = surface_energy(vec3(u_dielectric_f0), dfg);
    s.energy = mixed_energy(dielectric, surface_energy(albedo, dfg), metallic);
    // Below lies what the dielectric does not reflect: the metal has nothing below.
    s.diffuse = albedo * (1.0 - metallic) * (1.0 - dielectric.single - dielectric.multiple);
}

// Light from one direction into the view: the BRDF times the cosine.
vec3 scattered(vec3 l, Surface s) {
    vec3 h = normalize(l + s.view);
    float n_dot_l = clamp(dot(s.normal, l), 0.0, 1.0);
    float n_dot_h = clamp(dot(s.normal, h), 0.0, 1.0);
    float v_dot_h = clamp(dot(s.view, h), 0.0, 1.0);
    vec3 specular = D_ggx(n_dot_h, s.alpha) * V_smith(s.n_dot_v, max(n_dot_l, 1e-5), s.roughness) * F_schlick(v_dot_h, s.f0);
    if (has_multiple_scattering) specular *= compensation(s.energy.f0, s.energy.e);
    return n_dot_l * (s.diffuse / pi + specular);
}

// Light of the environment on a surface that sees a part of it.
vec3 indirect(Surface s, float visibility) {
    vec3 lobe = lobe_radiance(s.position, s.normal, s.view, s.n_dot_v, s.roughness, s.alpha);
    return s.energy.single * mirrored_light(lobe, s.n_dot_v, s.alpha, visibility, s.f0) + matt_light(s, visibility);
}

// Lighting of surfaces with glTF's material extensions: varnish over sheen over the base (Khronos, "glTF 2.0 extensions",
// KHR_materials_*). Layers are combined by albedo scaling: what a layer reflects of a uniform environment, seen from where
// it is seen, is taken from what lies below. So a white surface in a uniform environment still disappears.

uniform usampler2D u_extension0;
uniform usampler2D u_extension1;
#ifdef SHEEN
uniform sampler2D u_sheen_albedo;
#endif

const vec3 coat_f0 = vec3(0.04);  // index of refraction 1.5

// What varnish reflects of a uniform environment.
float coat_albedo(float n_dot_v, float roughness) {
    Energy energy = surface_energy(coat_f0, dfg_at(n_dot_v, roughness));
    return energy.single.r + energy.multiple.r;
}

#ifdef SHEEN
// What sheen of the colour 1 reflects of a uniform environment.
float sheen_albedo(float cosine, float roughness) {
    const float nodes = float(DFG_SIZE);
    vec2 uv = (vec2(sqrt(clamp(cosine, 0.0, 1.0)), roughness) * (nodes - 1.0) + 0.5) / nodes;
    return textureLod(u_sheen_albedo, uv, 0.0).r;
}
#endif

// Roughnesses (alpha) along the tangent and the bitangent.
vec2 anisotropic_alpha(Surface s, float alpha) {
    return vec2(mix(alpha, 1.0, s.extension.anisotropy * s.extension.anisotropy), alpha);
}

vec3 tangent_space(Surface s, vec3 direction, float cosine) {
    return vec3(dot(s.extension.tangent, direction), dot(cross(s.normal, s.extension.tangent), direction), cosine);
}

// Fills in what plain surfaces have too, and what each layer leaves of those below.
void prepare_extended(inout Surface s, vec3 albedo, float metallic, bool extended, ivec2 pixel) {
    if (extended)
        s.extension = unpack_extension(texelFetch(u_extension0, pixel, 0), texelFetch(u_extension1, pixel, 0), s.normal);
    else
        s.extension = plain_extension(s.normal, vec3(u_dielectric_f0));
    Extension e = s.extension;
    s.f0 = mix(e.f0, albedo, metallic);
    s.f90 = mix(vec3(e.f90), vec3(1.0), metallic);
    float roughness = s.roughness;
#ifdef ANISOTROPY
    // The albedo of an anisotropic lobe is that of an isotropic one with the root mean square of its alphas to 0.06
    // at any angle and strength.
    vec2 alpha = anisotropic_alpha(s, s.alpha);
    roughness = sqrt(sqrt(dot(alpha, alpha) * 0.5));
#endif
    vec2 dfg = dfg_at(s.n_dot_v, roughness);
    s.energy = surface_energy(s.f0, s.f90, dfg);
#ifdef IRIDESCENCE
    s.film = e.iridescence > 0.0 ? F_film(min(s.n_dot_v, 1.0), e.film_ior, e.film_thickness, s.f0) : s.f0;
    Energy film = surface_energy(s.film, s.film, dfg);
    s.energy.single = mix(s.energy.single, film.single, e.iridescence);
    s.energy.multiple = mix(s.energy.multiple, film.multiple, e.iridescence);
#endif
    // A tinted reflection must not tint what is below with its complement (KHR_materials_specular).
    vec3 dielectric = (1.0 - metallic) * (e.f0 * dfg.x + e.f90 * dfg.y);
    vec3 below = 1.0 - s.energy.single - s.energy.multiple - (max_channel(dielectric) - dielectric);
    vec3 refracted = albedo * (1.0 - metallic) * max(below, 0.0);
    s.diffuse = refracted * (1.0 - e.transmission);
#ifdef TRANSMISSION
    s.through = refracted * e.transmission;
#endif
    s.keep = 1.0;
#ifdef SHEEN
    s.extension.sheen_roughness = max(e.sheen_roughness, least_sheen_roughness);
    s.sheen_albedo = sheen_albedo(s.n_dot_v, s.extension.sheen_roughness);
    s.sheen_keep = 1.0 - max_channel(e.sheen_color) * min(s.sheen_albedo, 1.0);
    s.keep *= s.sheen_keep;
#endif
#ifdef CLEARCOAT
    s.coat_n_dot_v = abs(dot(e.coat_normal, s.view)) + 1e-5;
    s.coat_albedo = e.clearcoat * coat_albedo(s.coat_n_dot_v, e.coat_roughness);
    s.keep *= 1.0 - s.coat_albedo;
#endif
}

#ifdef TRANSMISSION
// A light on the other side: the specular lobe around the way straight through (KHR_materials_transmission).
float transmitted_lobe(vec3 l, Surface s) {
    float n_dot_l = -dot(s.normal, l);
    if (n_dot_l <= 0.0) return 0.0;
    vec3 mirrored = l + 2.0 * n_dot_l * s.normal;
    // Without refraction facets turn nothing.
    float roughness = max(s.roughness * clamp(2.0 * s.extension.ior - 2.0, 0.0, 1.0), 0.045);
    float n_dot_h = clamp(dot(s.normal, normalize(mirrored + s.view)), 0.0, 1.0);
    return n_dot_l * D_ggx(n_dot_h, roughness * roughness) * V_smith(s.n_dot_v, n_dot_l, roughness);
}
#endif

// Light from one direction into the view: the BRDF times the cosine.
vec3 scattered(vec3 l, Surface s) {
    Extension e = s.extension;
    vec3 h = normalize(l + s.view);
    float n_dot_l = clamp(dot(s.normal, l), 0.0, 1.0), n_dot_h = clamp(dot(s.normal, h), 0.0, 1.0);
    float v_dot_h = clamp(dot(s.view, h), 0.0, 1.0), safe_n_dot_l = max(n_dot_l, 1e-5);
    vec3 fresnel = F_schlick90(v_dot_h, s.f0, s.f90);
    vec3 compensated = s.f0;
#ifdef IRIDESCENCE
    if (e.iridescence > 0.0) fresnel = mix(fresnel, F_film(v_dot_h, e.film_ior, e.film_thickness, s.f0), e.iridescence);
    compensated = mix(compensated, s.film, e.iridescence);
#endif
#ifdef ANISOTROPY
    vec2 alpha = anisotropic_alpha(s, s.alpha);
    float lobe = D_ggx_anisotropic(tangent_space(s, h, n_dot_h), alpha) *
                 V_smith_anisotropic(tangent_space(s, s.view, s.n_dot_v), tangent_space(s, l, safe_n_dot_l), alpha);
#else
    float lobe = D_ggx(n_dot_h, s.alpha) * V_smith(s.n_dot_v, safe_n_dot_l, s.roughness);
#endif
    vec3 specular = lobe * fresnel;
#ifdef MULTIPLE_SCATTERING
    specular *= 1.0 + compensated * (1.0 / s.energy.e - 1.0);
#endif
    vec3 result = n_dot_l * (s.diffuse / pi + specular);
#ifdef TRANSMISSION
    result += s.extension.transmittance * s.through * transmitted_lobe(l, s);
#endif
#ifdef SHEEN
    float sheen = D_charlie(n_dot_h, e.sheen_roughness) * V_charlie(min(s.n_dot_v, 1.0), safe_n_dot_l, e.sheen_roughness);
    float keep = min(s.sheen_keep, 1.0 - max_channel(e.sheen_color) * min(sheen_albedo(n_dot_l, e.sheen_roughness), 1.0));
    result = result * keep + e.sheen_color * (n_dot_l * sheen / max(s.sheen_albedo, 1.0));
#endif
#ifdef CLEARCOAT
    float coat_n_dot_l = clamp(dot(e.coat_normal, l), 0.0, 1.0), coat_roughness = max(e.coat_roughness, 0.045);
    float coat = D_ggx(clamp(dot(e.coat_normal, h), 0.0, 1.0), coat_roughness * coat_roughness) *
                 V_smith(s.coat_n_dot_v, max(coat_n_dot_l, 1e-5), coat_roughness) * F_schlick(v_dot_h, coat_f0).r;
    result = result * (1.0 - s.coat_albedo) + e.clearcoat * coat_n_dot_l * coat;
#endif
    return result;
}

#ifdef ENVIRONMENT
#ifdef ANISOTROPY
// The lobe is drawn out along the tangent: narrow lobes side by side, as the slopes of GGX's facets are distributed, each
// as wide as the gap to the next of this frame or, in a still, of all frames.
vec3 anisotropic_radiance(Surface s) {
    vec2 alpha = anisotropic_alpha(s, s.alpha);
    float spread = sqrt(max(alpha.x * alpha.x - alpha.y * alpha.y, 0.0));
    if (spread < 0.01) return lobe_radiance(s.normal, s.view, s.n_dot_v, s.roughness, s.alpha);
    const int taps = 8;
    vec3 sum = vec3(0.0);
    float total = 0.0;
    for (int i = 0; i < taps; ++i) {
        float u = (2.0 * (float(i) + u_tap_offset)) / float(taps) - 1.0;
        float steep = inversesqrt(1.0 - u * u);
        vec3 facet = normalize(s.normal + s.extension.tangent * (spread * u * steep));
        vec3 l = reflect(-s.view, facet);
        float weight = max(dot(s.normal, l), 0.0);
        float gap = spread * steep * steep * steep * u_tap_gap / float(taps);
        sum += weight * prefiltered(l, sqrt(sqrt(min(alpha.y * alpha.y + gap * gap, 1.0))));
        total += weight;
    }
    return total > 1e-3 ? sum / total : prefiltered(s.normal, 1.0);
}
#endif

#ifdef SHEEN
// Average radiance in the lobe of the sheen, which is as wide as the sky: directions on three rings, each for the part of
// the sky around it, weighted by the lobe.
vec3 sheen_radiance(Surface s) {
    vec3 b1, b2;
    frame_around(s.normal, b1, b2);
    // Cosine, part of the sky, directions.
    const vec3 rings[3] = vec3[](vec3(0.12, 0.25, 6.0), vec3(0.42, 0.35, 6.0), vec3(0.8, 0.4, 3.0));
    vec3 sum = vec3(0.0);
    float total = 0.0;
    for (int ring = 0; ring < 3; ++ring) {
        float cosine = rings[ring].x, sine = sqrt(1.0 - cosine * cosine);
        for (float i = 0.0; i < rings[ring].z; ++i) {
            float angle = turn * (i + u_tap_offset + 0.5 * float(ring)) / rings[ring].z;
            vec3 l = s.normal * cosine + (b1 * cos(angle) + b2 * sin(angle)) * sine;
            float n_dot_h = clamp(dot(s.normal, normalize(l + s.view)), 0.0, 1.0);
            float roughness = s.extension.sheen_roughness;
            float weight = D_charlie(n_dot_h, roughness) * V_charlie(min(s.n_dot_v, 1.0), cosine, roughness) * cosine;
            weight *= rings[ring].y / rings[ring].z;
            sum += weight * prefiltered(l, 0.6);
            total += weight;
        }
    }
    return sum / max(total, 1e-20);
}
#endif

vec3 indirect(Surface s, float visibility) {
#ifdef ANISOTROPY
    vec3 lobe = anisotropic_radiance(s);
#else
    vec3 lobe = lobe_radiance(s.normal, s.view, s.n_dot_v, s.roughness, s.alpha);
#endif
    vec3 result = s.energy.single * mirrored_light(lobe, s.n_dot_v, s.alpha, visibility, s.f0) +
                  (s.energy.multiple + s.diffuse) * diffuse_light(s.normal, visibility, s.diffuse);
    Extension e = s.extension;
#ifdef SHEEN
    if (max_channel(e.sheen_color) > 0.0)
        result = result * s.sheen_keep + e.sheen_color * min(s.sheen_albedo, 1.0) * sheen_light(sheen_radiance(s), visibility);
#endif
#ifdef CLEARCOAT
    float coat_alpha = e.coat_roughness * e.coat_roughness;
    vec3 coat = lobe_radiance(e.coat_normal, s.view, s.coat_n_dot_v, e.coat_roughness, coat_alpha);
    result = result * (1.0 - s.coat_albedo) +
             s.coat_albedo * mirrored_light(coat, s.coat_n_dot_v, coat_alpha, visibility, vec3(0.04));
#endif
    return result;
}
#endif

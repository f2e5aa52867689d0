// Lighting of surfaces with glTF's material extensions: varnish over sheen over the base (Khronos, "glTF 2.0 extensions",
// KHR_materials_*). Layers are combined by albedo scaling: what a layer reflects of a uniform environment, seen from where
// it is seen, is taken from what lies below. So a white surface in a uniform environment still disappears.
#include "common_lobes.glsl"

#feature CLEARCOAT has_clearcoat
#feature SHEEN has_sheen
#feature TRANSMISSION has_transmission
#feature IRIDESCENCE has_iridescence
#feature ANISOTROPY has_anisotropy

uniform sampler2D u_sheen_albedo;

const vec3 coat_f0 = vec3(0.04);  // index of refraction 1.5

// What varnish reflects of a uniform environment.
float coat_albedo(float n_dot_v, float roughness) {
    Energy energy = surface_energy(coat_f0, dfg_at(n_dot_v, roughness));
    return energy.single.r + energy.multiple.r;
}

// What sheen of the colour 1 reflects of a uniform environment.
float sheen_albedo(float cosine, float roughness) {
    const float nodes = float(DFG_SIZE);
    vec2 uv = (vec2(sqrt(clamp(cosine, 0.0, 1.0)), roughness) * (nodes - 1.0) + 0.5) / nodes;
    return textureLod(u_sheen_albedo, uv, 0.0).r;
}

// Roughnesses (alpha) along the tangent and the bitangent.
vec2 anisotropic_alpha(Surface s, float alpha) {
    return vec2(mix(alpha, 1.0, s.extension.anisotropy * s.extension.anisotropy), alpha);
}

vec3 tangent_space(Surface s, vec3 direction, float cosine) {
    return vec3(dot(s.extension.tangent, direction), dot(cross(s.normal, s.extension.tangent), direction), cosine);
}

// The angle at which facets reflect a direction of view, on average: there the Fresnel term of Schlick weighs the reflectance
// at grazing angles as it does over the whole lobe. On rough surfaces few facets are seen at grazing angles.
float mean_facet_cosine(float n_dot_v, float roughness, vec2 dfg) {
    float mean = 1.0 - pow(clamp(dfg.y / max(dfg.x + dfg.y, 1e-6), 0.0, 1.0), 0.2);
    return mix(n_dot_v, max(n_dot_v, mean), smoothstep(0.0, 0.2, roughness));
}

// Fills in what plain surfaces have too, and what each layer leaves of those below. The extension is known.
void prepare_extended(inout Surface s, vec3 albedo, float metallic) {
    Extension e = s.extension;
    s.f0 = mix(e.f0, albedo, metallic);
    s.f90 = mix(vec3(e.f90), vec3(1.0), metallic);
    float roughness = s.roughness;
    if (has_anisotropy) {
        // The albedo of an anisotropic lobe is about that of an isotropic one with the root mean square of its alphas: off by
        // 10 % at strengths to 0.5, by 38 % at strength 1 and 85 degrees across the grain.
        vec2 alpha = anisotropic_alpha(s, s.alpha);
        roughness = sqrt(sqrt(dot(alpha, alpha) * 0.5));
    }
    vec2 dfg = dfg_at(s.n_dot_v, roughness);
    Energy dielectric = surface_energy(e.f0, vec3(e.f90), dfg);
    s.energy = mixed_energy(dielectric, surface_energy(albedo, dfg), metallic);
    if (has_iridescence) {
        float cosine = mean_facet_cosine(min(s.n_dot_v, 1.0), roughness, dfg);
        s.film = e.iridescence > 0.0 ? F_film(cosine, e.film_ior, e.film_thickness, s.f0) : s.f0;
        Energy film = surface_energy(s.film, s.film, dfg);
        s.energy.single = mix(s.energy.single, film.single, e.iridescence);
        s.energy.multiple = mix(s.energy.multiple, film.multiple, e.iridescence);
        dielectric.single = mix(dielectric.single, film.single, e.iridescence);
        dielectric.multiple = mix(dielectric.multiple, film.multiple, e.iridescence);
    }
    // A tinted reflection must not tint what is below with its complement (KHR_materials_specular).
    vec3 tinted = e.f0 * dfg.x + e.f90 * dfg.y;
    vec3 below = 1.0 - dielectric.single - dielectric.multiple - (max_channel(tinted) - tinted);
    vec3 refracted = albedo * (1.0 - metallic) * max(below, 0.0);
    s.diffuse = refracted * (1.0 - e.transmission);
    s.through = refracted * e.transmission;
    s.keep = 1.0;
    if (has_sheen) {
        s.extension.sheen_roughness = max(e.sheen_roughness, least_sheen_roughness);
        s.sheen_albedo = sheen_albedo(s.n_dot_v, s.extension.sheen_roughness);
        s.sheen_keep = 1.0 - max_channel(e.sheen_color) * min(s.sheen_albedo, 1.0);
        s.keep *= s.sheen_keep;
    }
    if (has_clearcoat) {
        s.coat_n_dot_v = abs(dot(e.coat_normal, s.view)) + 1e-5;
        s.coat_albedo = e.clearcoat * coat_albedo(s.coat_n_dot_v, e.coat_roughness);
        s.keep *= 1.0 - s.coat_albedo;
    }
}

// Facets turn nothing without refraction, and into what is less dense as much as out of it.
float turning(float ior) { return clamp(2.0 * max(ior, 1.0 / ior) - 2.0, 0.0, 1.0); }
float transmitted_roughness(Surface s) { return max(s.roughness * turning(s.extension.ior), 0.045); }

// A light on the other side: the specular lobe around the way straight through (KHR_materials_transmission).
float transmitted_lobe(vec3 l, Surface s) {
    float n_dot_l = -dot(s.normal, l);
    vec3 mirrored = l + 2.0 * n_dot_l * s.normal;
    float roughness = transmitted_roughness(s);
    float n_dot_h = clamp(dot(s.normal, normalize(mirrored + s.view)), 0.0, 1.0);
    float lobe = n_dot_l * D_ggx(n_dot_h, roughness * roughness) * V_smith(s.n_dot_v, max(n_dot_l, 1e-5), roughness);
    return n_dot_l > 0.0 ? lobe : 0.0;
}

// D V of the base's specular lobe.
float lobe_of(vec3 l, vec3 h, float n_dot_h, float n_dot_l, Surface s) {
    if (!has_anisotropy) return D_ggx(n_dot_h, s.alpha) * V_smith(s.n_dot_v, n_dot_l, s.roughness);
    vec2 alpha = anisotropic_alpha(s, s.alpha);
    return D_ggx_anisotropic(tangent_space(s, h, n_dot_h), alpha) *
           V_smith_anisotropic(tangent_space(s, s.view, s.n_dot_v), tangent_space(s, l, n_dot_l), alpha);
}

// Light from one direction into the view, below all layers: the BRDF times the cosine.
vec3 scattered_by_base(vec3 l, vec3 h, float n_dot_l, Surface s) {
    Extension e = s.extension;
    float n_dot_h = clamp(dot(s.normal, h), 0.0, 1.0), v_dot_h = clamp(dot(s.view, h), 0.0, 1.0);
    vec3 fresnel = F_schlick90(v_dot_h, s.f0, s.f90);
    vec3 compensated = s.energy.f0;
    if (has_iridescence) {
        fresnel = e.iridescence > 0.0 ? mix(fresnel, F_film(v_dot_h, e.film_ior, e.film_thickness, s.f0), e.iridescence) : fresnel;
        compensated = mix(compensated, s.film, e.iridescence);
    }
    vec3 specular = lobe_of(l, h, n_dot_h, max(n_dot_l, 1e-5), s) * fresnel;
    if (has_multiple_scattering) specular *= compensation(compensated, s.energy.e);
    return n_dot_l * (s.diffuse / pi + specular);
}

// What the sheen leaves of one direction's light.
float sheen_keep(float n_dot_l, Surface s) {
    Extension e = s.extension;
    float albedo = min(sheen_albedo(n_dot_l, e.sheen_roughness), 1.0);
    return min(s.sheen_keep, 1.0 - max_channel(e.sheen_color) * albedo);
}

// What sheen, which leaves `keep` of it, and varnish make of the base's light.
vec3 under_layers(vec3 base, vec3 l, vec3 h, float n_dot_l, float keep, Surface s) {
    Extension e = s.extension;
    vec3 result = base;
    float n_dot_h = clamp(dot(s.normal, h), 0.0, 1.0), v_dot_h = clamp(dot(s.view, h), 0.0, 1.0);
    if (has_sheen) {
        float sheen =
            D_charlie(n_dot_h, e.sheen_roughness) * V_charlie(min(s.n_dot_v, 1.0), max(n_dot_l, 1e-5), e.sheen_roughness);
        result = result * keep + e.sheen_color * (n_dot_l * sheen / max(s.sheen_albedo, 1.0));
    }
    if (has_clearcoat) {
        float coat_n_dot_l = clamp(dot(e.coat_normal, l), 0.0, 1.0), coat_roughness = max(e.coat_roughness, 0.045);
        float coat = D_ggx(clamp(dot(e.coat_normal, h), 0.0, 1.0), coat_roughness * coat_roughness) *
                     V_smith(s.coat_n_dot_v, max(coat_n_dot_l, 1e-5), coat_roughness) * F_schlick(v_dot_h, coat_f0).r;
        result = result * (1.0 - s.coat_albedo) + e.clearcoat * coat_n_dot_l * coat;
    }
    return result;
}

// The same with all layers.
vec3 scattered(vec3 l, Surface s) {
    vec3 h = normalize(l + s.view);
    float n_dot_l = clamp(dot(s.normal, l), 0.0, 1.0);
    vec3 base = scattered_by_base(l, h, n_dot_l, s);
    if (has_transmission) base += transmittance_over(s.extension, s.extension.thickness) * s.through * transmitted_lobe(l, s);
    float keep = 1.0;
    if (has_sheen) keep = sheen_keep(n_dot_l, s);
    return under_layers(base, l, h, n_dot_l, keep, s);
}

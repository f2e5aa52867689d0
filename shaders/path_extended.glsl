// The same with glTF's material extensions. Transmission passes a thin surface straight, or as its roughness spreads it. It
// enters a volume by refraction; what has entered leaves it by refraction, or stays by total internal reflection.
#include "common_arriving.glsl"
#include "common_encoding.glsl"
#include "common_surface.glsl"
#include "lighting_extended.glsl"
#include "path_surface.glsl"

in float v_inside;     // 1: the path comes from within the volume
in vec4 v_dielectric;  // Extension: f0, f90
in vec4 v_coat;        // coat_normal, clearcoat
in vec4 v_sheen;       // sheen_color, sheen_roughness
in vec4 v_film;        // iridescence, film_ior, film_thickness, coat_roughness
in vec4 v_tangent;     // tangent, anisotropy
in vec3 v_volume;      // transmission, ior over that of the medium around, thickness
in vec3 v_absorption;  // of a surface without a volume: over its thickness

Extension path_extension() {
    Extension e;
    e.f0 = v_dielectric.xyz;
    e.f90 = v_dielectric.w;
    e.coat_normal = v_coat.xyz;
    e.clearcoat = v_coat.w;
    e.coat_roughness = max(v_film.w, 0.045);
    e.sheen_color = v_sheen.xyz;
    e.sheen_roughness = v_sheen.w;
    e.iridescence = v_film.x;
    e.film_ior = v_film.y;
    e.film_thickness = v_film.z;
    e.anisotropy = v_tangent.w;
    vec3 bitangent, any_tangent;
    frame_around(v_normal, any_tangent, bitangent);
    vec3 tangent = v_tangent.xyz - v_normal * dot(v_normal, v_tangent.xyz);
    e.tangent = dot(tangent, tangent) > 1e-12 ? tangent * inversesqrt(max(dot(tangent, tangent), 1e-12)) : any_tangent;
    e.transmission = v_volume.x;
    e.ior = v_volume.y;
    e.thickness = v_volume.z;
    e.dispersion = 0.0;  // A path in a volume has the index of its channel.
    e.absorption = v_absorption;
    return e;
}

Surface path_surface() {
    Surface s = bare_surface();
    s.extension = path_extension();
    prepare_extended(s, v_albedo, v_parameters.x);
    if (has_transmission) s.through = s.extension.thickness > 0.0 ? s.through : s.through * exp(-v_absorption);
    return s;
}

bool is_inside() { return v_inside > 0.5; }
bool is_volume(Surface s) { return s.extension.thickness > 0.0; }

// Light goes through as it comes.
bool is_clear(Surface s) { return v_parameters.y * turning(s.extension.ior) < 0.045; }

// What facets leave of the light of a direction in which it passes a surface, or is kept within: what they hide is scattered
// again, and lost where single scattering is asked for (Walter et al. 2007, equation 34).
float unmasked(vec3 l, Surface s) {
    float cosine = abs(dot(s.normal, l)), tangent2 = 1.0 / max(cosine * cosine, 1e-12) - 1.0;
    float masked = 2.0 / (1.0 + sqrt(1.0 + s.alpha * s.alpha * tangent2));
    return has_multiple_scattering || is_clear(s) ? 1.0 : masked;
}

// The sheen leaves what it does not reflect of light from everywhere: no energy is lost.
vec3 scattered_above(vec3 l, Surface s) {
    vec3 h = normalize(l + s.view);
    float n_dot_l = clamp(dot(s.normal, l), 0.0, 1.0), keep = 1.0;
    if (has_sheen) keep = s.sheen_keep;
    return under_layers(scattered_by_base(l, h, n_dot_l, s), l, h, n_dot_l, keep, s);
}

// What stays in a volume at a facet: Fresnel's reflectance is the same from both sides, at the angle in what is less dense.
float kept_part(float cosine, Surface s) {
    return luminance(F_schlick90(cosine, s.extension.f0, vec3(s.extension.f90)));
}
float kept_between(float inner, float outer, Surface s) { return kept_part(s.extension.ior < 1.0 ? inner : outer, s); }

// What one facet lets into a volume: of what s.through says of all together, by Fresnel's reflectance at it.
vec3 passed_by(Surface s, vec3 h) {
    float of_all = 1.0 - luminance(s.energy.single), of_facet = 1.0 - kept_part(max(dot(h, s.view), 0.0), s);
    return is_clear(s) ? s.through : s.through * of_facet / max(of_all, 1e-6);
}

// Of light that a lamp sends from within a rough volume: the directions in which paths enter it (Walter et al. 2007, equation
// 17), times what they take with them, over the square of the index: all of the light leaves that the lamp sends to the face.
vec3 entering(vec3 l, Surface s) {
    float eta = s.extension.ior;
    vec3 h = normalize(s.view + eta * l);
    h = eta < 1.0 ? h : -h;
    float outer = dot(h, s.view), inner = -dot(h, l), across = outer - eta * inner;
    float facets = 4.0 * outer * visible_density(dot(s.normal, h), s.n_dot_v, s.alpha);
    float density = facets * inner / max(across * across, 1e-12);
    vec3 passed = s.through;
    if (!has_multiple_scattering) passed = passed_by(s, h) * unmasked(l, s);
    return outer > 0.0 && inner > 0.0 ? passed * density : vec3(0.0);
}

// `light` of a direction above the face, or what roughness spreads of light from below, times the cosine.
vec3 above_face(vec3 light, vec3 l, Surface s) {
    vec3 below = mirrored_at_face(l);
    vec3 spread = vec3(0.0);
    if (has_transmission) {
        vec2 dfg = dfg_at(s.n_dot_v, transmitted_roughness(s));
        float kept = has_multiple_scattering ? dfg.x + dfg.y : 1.0;
        float lobe = (transmitted_lobe(l, s) + transmitted_lobe(below, s)) / kept;
        vec3 through = is_volume(s) ? entering(l, s) : s.through * lobe;
        spread = is_clear(s) ? vec3(0.0) : s.keep * through;
    }
    vec3 result = dot(l, v_face) > 0.0 ? light : spread;
    return is_inside() ? vec3(0.0) : result;
}

// Light from a direction into the view: the BRDF or the BTDF, times the cosine.
vec3 reflected(vec3 l, Surface s) {
    return above_face(scattered_above(l, s) + scattered_above(mirrored_at_face(l), s), l, s);
}

// Parts of the directions; the others are those of a cosine.
struct Lobes {
    float specular, coat, through;
};

Lobes lobes_of(Surface s) {
    Extension e = s.extension;
    float specular = s.keep * luminance(s.energy.single + s.energy.multiple), coat = 0.0, through = 0.0;
    float matt = s.keep * luminance(s.diffuse);
    if (has_sheen) matt += luminance(e.sheen_color) * min(s.sheen_albedo, 1.0);
    if (has_clearcoat) coat = s.coat_albedo;
    if (has_transmission) through = s.keep * luminance(s.through);
    // Where there are several lobes each of them gets some.
    specular = max(specular, 0.1 * (matt + coat + through));
    coat = coat > 0.0 ? max(coat, 0.1 * (specular + matt)) : 0.0;
    matt = matt > 0.0 ? max(matt, 0.1 * specular) : 0.0;
    float sum = max(specular + coat + through + matt, 1e-6);
    Lobes lobes;
    lobes.specular = specular / sum;
    lobes.coat = coat / sum;
    lobes.through = through / sum;
    return lobes;
}

float specular_density(vec3 h, Surface s) {
    float n_dot_h = dot(s.normal, h);
    if (!has_anisotropy) return visible_density(n_dot_h, s.n_dot_v, s.alpha);
    vec2 alpha = anisotropic_alpha(s, s.alpha);
    vec3 v = tangent_space(s, s.view, s.n_dot_v);
    float masked = s.n_dot_v + length(vec3(alpha * v.xy, v.z));
    return n_dot_h > 0.0 ? D_ggx_anisotropic(tangent_space(s, h, n_dot_h), alpha) / (2.0 * masked) : 0.0;
}

float density_above(vec3 l, Surface s, Lobes lobes) {
    vec3 h = normalize(l + s.view);
    float matt = 1.0 - lobes.specular - lobes.coat - lobes.through;
    float density = lobes.specular * specular_density(h, s) + matt * max(dot(s.normal, l), 0.0) * inverse_pi;
    if (has_clearcoat) {
        Extension e = s.extension;
        density += lobes.coat * visible_density(dot(e.coat_normal, h), s.coat_n_dot_v, e.coat_roughness * e.coat_roughness);
    }
    return density;
}

float density_below(vec3 l, Surface s) {
    float roughness = transmitted_roughness(s);
    vec3 h = normalize(l - 2.0 * dot(s.normal, l) * s.normal + s.view);
    return visible_density(dot(s.normal, h), s.n_dot_v, roughness * roughness);
}

// Roughness of a volume's surface spreads what leaves it.
bool leaves_spread(Surface s) { return is_inside() && !is_clear(s); }

// Of directions in which paths leave a volume: facets as the view sees them (Heitz 2018), refraction (Walter et al. 2007,
// equation 17), and what Fresnel's reflectance leaves, as left_or_kept() of path_scatter_extended.frag chooses it. A path takes
// all of the light of such a direction with it but for what unmasked() says, so that this is the BTDF times the cosine, too.
float leaving(vec3 l, Surface s) {
    float eta = s.extension.ior;
    vec3 h = normalize(l + eta * s.view);
    h = eta < 1.0 ? -h : h;
    float inner = dot(h, s.view), outer = -dot(h, l), across = eta * inner - outer;
    float facets = 4.0 * inner * visible_density(dot(s.normal, h), s.n_dot_v, s.alpha);
    float density = facets * outer / max(across * across, 1e-12) * (1.0 - kept_between(inner, outer, s));
    return inner > 0.0 && outer > 0.0 && dot(l, v_face) < 0.0 ? density : 0.0;
}

// Of directions that could have been found by more than one lobe.
float density_of(vec3 l, Surface s, Lobes lobes) {
    vec3 below = mirrored_at_face(l);
    float above = density_above(l, s, lobes) + density_above(below, s, lobes), through = 0.0;
    if (has_transmission) through = lobes.through * (density_below(l, s) + density_below(below, s));
    float outside = dot(l, v_face) > 0.0 ? above : through, inside = is_clear(s) ? 0.0 : leaving(l, s);
    return is_inside() ? inside : outside;
}

// Roughness of a thin surface spreads what goes through: next-event estimation finds it, too.
bool is_spreading(Surface s) { return !is_volume(s) && !is_clear(s); }

// As those of path_plain.glsl.
vec3 bsdf(vec3 l, Surface s) {
    vec3 outside = dot(l, v_face) > 0.0 || is_spreading(s) ? reflected(l, s) : vec3(0.0);
    return leaves_spread(s) ? vec3(leaving(l, s) * unmasked(l, s)) : outside;
}
float bsdf_density(vec3 l, Surface s) { return density_of(l, s, lobes_of(s)); }

// Of light that a lamp sends from within a rough volume: the directions in which paths stay there, as those of entering().
float staying(vec3 l, Surface s) {
    float eta = s.extension.ior;
    vec3 h = normalize(l + s.view);
    float cosine = dot(h, s.view), outer2 = 1.0 - eta * eta * (1.0 - cosine * cosine);
    float kept = outer2 > 0.0 ? kept_between(cosine, sqrt(max(outer2, 0.0)), s) : 1.0;
    return kept * visible_density(dot(s.normal, h), s.n_dot_v, s.alpha) / (eta * eta);
}

// As that of path_plain.glsl. What lets light pass has it from below the face, too.
vec3 reflected_unmirrored(vec3 l, Surface s) {
    vec3 light = scattered_above(l, s);
    vec3 outside = s.extension.transmission > 0.0 ? above_face(light, l, s) : light;
    float found = dot(l, v_face) > 0.0 ? staying(l, s) : leaving(l, s);
    vec3 inside = leaves_spread(s) ? vec3(found * unmasked(l, s)) : vec3(0.0);
    return is_inside() ? inside : outside;
}

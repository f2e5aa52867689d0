// Surfaces of the core model that paths meet: how they reflect, and how directions are distributed that go on from them.
#include "common_arriving.glsl"
#include "common_encoding.glsl"
#include "common_surface.glsl"
#include "lighting_plain.glsl"
#include "path_surface.glsl"

#feature SHADOW_CATCHER catches_shadows  // light counts by its irradiance, whatever the surface

Surface path_surface() {
    Surface s = bare_surface();
    prepare(s, v_albedo, v_parameters.x, 0.0);
    return s;
}

// What a surface makes of `light`.
vec3 seen_of(vec3 light, vec3 l, Surface s) {
    if (catches_shadows) light = vec3(max(dot(s.normal, l), 0.0) * inverse_pi);
    return light;
}

// `light` of a direction above the face.
vec3 above_face(vec3 light, vec3 l, Surface s) { return dot(l, v_face) > 0.0 ? seen_of(light, l, s) : vec3(0.0); }

// Light from a direction above the face into the view: the BRDF times the cosine.
vec3 reflected(vec3 l, Surface s) { return above_face(scattered(l, s) + scattered(mirrored_at_face(l), s), l, s); }

// Of a light without an area, by the normal alone: light of a single direction would show the faces where interpolated
// normals turn away from it, or towards it. Rays find whether a face hides it.
vec3 reflected_unmirrored(vec3 l, Surface s) { return seen_of(scattered(l, s), l, s); }

// Which part of the directions is chosen by the specular lobe.
float specular_part(Surface s) {
    float specular = luminance(s.energy.single + s.energy.multiple), diffuse = luminance(s.diffuse);
    float part = clamp(specular / max(specular + diffuse, 1e-6), 0.1, 0.9);
    part = diffuse > 0.0 ? part : 1.0;
    return catches_shadows ? 0.0 : part;
}

float lobe_density(vec3 l, Surface s, float part) {
    float specular = visible_density(dot(s.normal, normalize(l + s.view)), s.n_dot_v, s.alpha);
    return part * specular + (1.0 - part) * max(dot(s.normal, l), 0.0) * inverse_pi;
}

// Of the directions of sample(), per steradian.
float density_of(vec3 l, Surface s, float part) {
    return lobe_density(l, s, part) + lobe_density(mirrored_at_face(l), s, part);
}

// For directions that have been found otherwise: what the surface makes of their light, and how likely it samples them.
vec3 bsdf(vec3 l, Surface s) { return reflected(l, s); }
float bsdf_density(vec3 l, Surface s) { return density_of(l, s, specular_part(s)); }

// A direction by three numbers in [0, 1).
vec3 sampled(Surface s, float part, vec3 u) {
    vec3 b1, b2;
    frame_around(s.normal, b1, b2);
    vec3 v = vec3(dot(b1, s.view), dot(b2, s.view), max(dot(s.normal, s.view), 1e-5));
    vec3 h = visible_facet(v, vec2(s.alpha), u.xy);
    vec3 mirrored = 2.0 * dot(v, h) * h - v;
    vec3 matt = cosine_direction(u.xy);
    vec3 chosen = u.z < part ? mirrored : matt;
    vec3 l = normalize(b1 * chosen.x + b2 * chosen.y + s.normal * chosen.z);
    return dot(l, v_face) < 0.0 ? mirrored_at_face(l) : l;
}

// A surface that a path meets: how it reflects, and how directions are distributed that go on from it. Directions under the
// face, where a mapped or interpolated normal sends some, are mirrored at the face: nothing is lost, and nothing
// passes through.
#include "common_arriving.glsl"
#include "common_encoding.glsl"
#include "common_surface.glsl"
#include "lighting_plain.glsl"

#feature SHADOW_CATCHER catches_shadows  // light counts by its irradiance, whatever the surface

in vec3 v_position;
in vec3 v_normal;      // interpolated and mapped
in vec3 v_face;        // of the element itself, towards where the path comes from
in vec3 v_view;        // unit, back along the path
in vec3 v_albedo;
in vec2 v_parameters;  // metallic, roughness

const float inverse_pi = 0.31830988618379067;

Surface path_surface() {
    Surface s;
    s.position = v_position;
    s.normal = v_normal;
    // Seen from below its mapped normal a surface shows what it shows as far above.
    s.view = v_view - min(2.0 * dot(v_normal, v_view), 0.0) * v_normal;
    s.n_dot_v = dot(s.normal, s.view) + 1e-5;
    // See lighting_surface.frag.
    s.roughness = max(v_parameters.y, 0.045);
    s.alpha = s.roughness * s.roughness;
    prepare(s, v_albedo, v_parameters.x, 0.0);
    return s;
}

vec3 mirrored_at_face(vec3 l) { return l - 2.0 * dot(l, v_face) * v_face; }

// Light from a direction above the face into the view: the BRDF times the cosine.
vec3 reflected(vec3 l, Surface s) {
    vec3 light = scattered(l, s) + scattered(mirrored_at_face(l), s);
    if (catches_shadows) light = vec3(max(dot(s.normal, l), 0.0) * inverse_pi);
    return dot(l, v_face) > 0.0 ? light : vec3(0.0);
}

// Which part of the directions is chosen by the specular lobe.
float specular_part(Surface s) {
    float specular = luminance(s.energy.single + s.energy.multiple), diffuse = luminance(s.diffuse);
    float part = clamp(specular / max(specular + diffuse, 1e-6), 0.1, 0.9);
    part = diffuse > 0.0 ? part : 1.0;
    return catches_shadows ? 0.0 : part;
}

// Of directions that normals of GGX's visible facets mirror the view to (Heitz 2018), and of a cosine.
float lobe_density(vec3 l, Surface s, float part) {
    vec3 h = normalize(l + s.view);
    float n_dot_h = dot(s.normal, h), a2 = s.alpha * s.alpha;
    float masked = s.n_dot_v + sqrt(s.n_dot_v * s.n_dot_v * (1.0 - a2) + a2);
    float specular = n_dot_h > 0.0 ? D_ggx(n_dot_h, s.alpha) / (2.0 * masked) : 0.0;
    return part * specular + (1.0 - part) * max(dot(s.normal, l), 0.0) * inverse_pi;
}

// Of the directions of sample(), per steradian.
float density_of(vec3 l, Surface s, float part) {
    return lobe_density(l, s, part) + lobe_density(mirrored_at_face(l), s, part);
}

// A direction by three numbers in [0, 1); visible facets by spherical caps (Dupuy and Benyoub 2023).
vec3 sampled(Surface s, float part, vec3 u) {
    vec3 b1, b2;
    frame_around(s.normal, b1, b2);
    vec3 v = vec3(dot(b1, s.view), dot(b2, s.view), max(dot(s.normal, s.view), 1e-5));
    vec3 stretched = normalize(vec3(s.alpha * v.xy, v.z));
    float phi = 2.0 * pi * u.x;
    float z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
    float r = sqrt(max(1.0 - z * z, 0.0));
    vec3 cap = vec3(r * cos(phi), r * sin(phi), z) + stretched;
    vec3 h = normalize(vec3(s.alpha * cap.xy, max(cap.z, 1e-6)));
    vec3 mirrored = 2.0 * dot(v, h) * h - v;
    float radius = sqrt(u.y);
    vec3 matt = vec3(radius * cos(phi), radius * sin(phi), sqrt(max(1.0 - u.y, 0.0)));
    vec3 chosen = u.z < part ? mirrored : matt;
    vec3 l = normalize(b1 * chosen.x + b2 * chosen.y + s.normal * chosen.z);
    return dot(l, v_face) < 0.0 ? mirrored_at_face(l) : l;
}

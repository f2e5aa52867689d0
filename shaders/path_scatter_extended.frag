// path_scatter.frag for surfaces with glTF's material extensions.
#include "path_extended.glsl"

in vec3 v_random;  // in [0, 1)
in vec3 v_light_direction;
in vec3 v_light;           // radiance
in float v_light_density;  // of such directions, per steradian; 0: none was chosen

out vec3 o_light;      // of this direction, unless it is hidden
out vec3 o_direction;  // below the face where the path goes through
out vec3 o_weight;     // what the path's throughput is multiplied by
out float o_density;   // of the direction, per steradian; very large where no other direction is possible
out vec3 o_keep;       // of the light that the surface emits

const float only_direction = 1e30;

// A facet of a lobe around the normal n, as the view sees it.
vec3 facet_around(vec3 n, vec3 t, vec3 view, vec2 alpha, vec2 u) {
    vec3 b = cross(n, t);
    vec3 h = visible_facet(vec3(dot(t, view), dot(b, view), max(dot(n, view), 1e-5)), alpha, u);
    return t * h.x + b * h.y + n * h.z;
}

vec3 mirrored_by(vec3 h, vec3 view) { return normalize(2.0 * dot(view, h) * h - view); }

// A facet that refracts; what is clear has but one.
vec3 refracting_facet(Surface s, vec3 t, vec2 u) {
    vec3 h = facet_around(s.normal, t, s.view, vec2(s.alpha), u);
    return is_clear(s) || dot(h, s.view) <= 0.0 ? s.normal : h;
}

// Into a volume.
vec3 refracted(Surface s, vec3 h) {
    float eta = 1.0 / s.extension.ior, cosine = dot(h, s.view);
    return (eta * cosine - sqrt(max(1.0 - eta * eta * (1.0 - cosine * cosine), 0.0))) * h - eta * s.view;
}

// A direction above the face, or with -1 below it.
vec3 on_side(vec3 l, float side) { return side * dot(l, v_face) > 0.0 ? l : mirrored_at_face(l); }

// Out of a volume, or back into it.
vec3 left_or_kept(Surface s, vec3 h, float u) {
    float eta = s.extension.ior, cosine = dot(h, s.view);
    float sine2 = eta * eta * (1.0 - cosine * cosine), outer = sqrt(max(1.0 - sine2, 0.0));
    bool leaves = sine2 < 1.0 && u >= kept_between(cosine, outer, s);
    return leaves ? (eta * cosine - outer) * h - eta * s.view : mirrored_by(h, s.view);
}

void main() {
    Surface s = path_surface();
    Lobes lobes = lobes_of(s);
    bool spreads = is_spreading(s);
    float found = v_light_density + density_of(v_light_direction, s, lobes);
    o_light = v_light_density > 0.0 ? v_light * bsdf(v_light_direction, s) / found : vec3(0.0);

    vec3 b1, b2;
    frame_around(s.normal, b1, b2);
    vec2 u = v_random.xy;
    vec3 matt = cosine_direction(u);
    vec3 l = b1 * matt.x + b2 * matt.y + s.normal * matt.z;
    vec2 alpha = vec2(s.alpha);
    vec3 t = b1;
    if (has_anisotropy) {
        alpha = anisotropic_alpha(s, s.alpha);
        t = s.extension.tangent;
    }
    float specular_end = lobes.specular, coat_end = specular_end + lobes.coat, through_end = coat_end + lobes.through;
    if (has_clearcoat) {
        Extension e = s.extension;
        vec3 c1, c2;
        frame_around(e.coat_normal, c1, c2);
        vec3 coat = mirrored_by(facet_around(e.coat_normal, c1, s.view, vec2(e.coat_roughness * e.coat_roughness), u), s.view);
        l = v_random.z < coat_end ? coat : l;
    }
    l = v_random.z < specular_end ? mirrored_by(facet_around(s.normal, t, s.view, alpha, u), s.view) : l;
    l = on_side(normalize(l), 1.0);
    bool only = is_inside();
    vec3 passed = s.through;
    float left = 1.0;  // of what facets hide
    if (has_transmission) {
        bool passes = v_random.z >= coat_end && v_random.z < through_end;
        float roughness = transmitted_roughness(s);
        vec3 m = mirrored_by(facet_around(s.normal, b1, s.view, vec2(roughness * roughness), u), s.view);
        vec3 spread = m - 2.0 * dot(s.normal, m) * s.normal;
        vec3 h = refracting_facet(s, b1, u);
        vec3 straight = is_volume(s) ? refracted(s, h) : -s.view;
        straight = normalize(is_inside() ? left_or_kept(s, h, v_random.z) : straight);
        l = passes ? on_side(spreads ? normalize(spread) : straight, -1.0) : l;
        l = is_inside() ? (dot(straight, h) > 0.0 ? on_side(straight, 1.0) : straight) : l;
        only = only || (passes && !spreads);
        // Facets hide all directions on their other side.
        bool is_shown = dot(straight, h) * dot(straight, s.normal) > 0.0;
        left = has_multiple_scattering || is_shown ? unmasked(l, s) : 0.0;
        if (!has_multiple_scattering) passed = passed_by(s, h) * left;
    }
    o_direction = l;
    float density = density_of(l, s, lobes);
    // Next-event estimation finds what leaves a rough volume, and nothing within it.
    only = only && !(is_inside() && density > 0.0);
    o_density = only ? only_direction : density;
    o_weight = density > 0.0 ? reflected(l, s) / density : vec3(0.0);
    o_weight = only ? s.keep * passed / max(lobes.through, 1e-6) : o_weight;
    o_weight = is_inside() ? vec3(left) : o_weight;
    o_keep = is_inside() ? vec3(1.0) : vec3(s.keep);
}

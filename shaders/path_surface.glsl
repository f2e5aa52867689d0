// A surface that a path meets. Directions under the face, where a mapped or interpolated normal sends some, are mirrored at
// the face: nothing is lost, and nothing passes through.
in vec3 v_position;
in vec3 v_normal;      // interpolated and mapped
in vec3 v_face;        // of the element itself, towards where the path comes from
in vec3 v_view;        // unit, back along the path
in vec3 v_albedo;
in vec2 v_parameters;  // metallic, roughness

const float inverse_pi = 0.31830988618379067;

// Without what the model makes of it.
Surface bare_surface() {
    Surface s;
    s.position = v_position;
    s.normal = v_normal;
    // Seen from below its mapped normal a surface shows what it shows as far above.
    s.view = v_view - min(2.0 * dot(v_normal, v_view), 0.0) * v_normal;
    s.n_dot_v = dot(s.normal, s.view) + 1e-5;
    // See lighting_surface.frag.
    s.roughness = max(v_parameters.y, 0.045);
    s.alpha = s.roughness * s.roughness;
    return s;
}

vec3 mirrored_at_face(vec3 l) { return l - 2.0 * dot(l, v_face) * v_face; }

// A facet that is seen from v, in the frame of the lobe, by two numbers in [0, 1): spherical caps (Dupuy and Benyoub 2023).
vec3 visible_facet(vec3 v, vec2 alpha, vec2 u) {
    vec3 stretched = normalize(vec3(alpha * v.xy, v.z));
    float phi = 2.0 * pi * u.x;
    float z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
    float r = sqrt(max(1.0 - z * z, 0.0));
    vec3 cap = vec3(r * cos(phi), r * sin(phi), z) + stretched;
    return normalize(vec3(alpha * cap.xy, max(cap.z, 1e-6)));
}

// Of the directions that such facets mirror the view to (Heitz 2018).
float visible_density(float n_dot_h, float n_dot_v, float alpha) {
    float a2 = alpha * alpha;
    float masked = n_dot_v + sqrt(n_dot_v * n_dot_v * (1.0 - a2) + a2);
    return n_dot_h > 0.0 ? D_ggx(n_dot_h, alpha) / (2.0 * masked) : 0.0;
}

// A direction of a cosine, in the frame of the normal.
vec3 cosine_direction(vec2 u) {
    float radius = sqrt(u.y), phi = 2.0 * pi * u.x;
    return vec3(radius * cos(phi), radius * sin(phi), sqrt(max(1.0 - u.y, 0.0)));
}

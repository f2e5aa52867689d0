// Light of the environment on surfaces with glTF's material extensions.

// The lobe is drawn out along the tangent: narrow lobes side by side, as the slopes of GGX's facets are distributed, each
// as wide as the gap to the next of this frame or, in a still, of all frames.
vec3 anisotropic_radiance(Surface s) {
    vec2 alpha = anisotropic_alpha(s, s.alpha);
    float spread = sqrt(max(alpha.x * alpha.x - alpha.y * alpha.y, 0.0));
    vec3 round_lobe = vec3(0.0);
    if (any_lane(spread < 0.01)) round_lobe = lobe_radiance(s.position, s.normal, s.view, s.n_dot_v, s.roughness, s.alpha);
    if (!any_lane(spread >= 0.01)) return round_lobe;
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
        float tap = sqrt(min(alpha.y * alpha.y + gap * gap, 1.0));
        sum += weight * prefiltered(above_horizon(l, tap), sqrt(tap));
        total += weight;
    }
    vec3 along = sum / max(total, 1e-3);
    if (any_lane(total <= 1e-3)) along = total > 1e-3 ? along : prefiltered(s.normal, 1.0);
    // Its width across the horizon.
    float rises = dot(s.extension.tangent, u_ground.xyz);
    float width = sqrt(mix(alpha.y * alpha.y, alpha.x * alpha.x, rises * rises));
    along = with_ground(along, s.position, s.normal, reflect(-s.view, s.normal), width);
    return spread < 0.01 ? round_lobe : along;
}

// Cosine, part of the sky, directions.
const vec3 rings[3] = vec3[](vec3(0.12, 0.25, 6.0), vec3(0.42, 0.35, 6.0), vec3(0.8, 0.4, 3.0));

// Average radiance in the lobe of the sheen, which is as wide as the sky: directions on three rings, each for the part of
// the sky around it, weighted by the lobe.
vec3 sheen_radiance(Surface s) {
    vec3 b1, b2;
    frame_around(s.normal, b1, b2);
    vec3 sum = vec3(0.0);
    float total = 0.0;
    for (int ring = 0; ring < 3; ++ring) {
        float cosine = rings[ring].x, sine = sqrt(1.0 - cosine * cosine);
        for (int i = 0; i < int(rings[ring].z); ++i) {
            float angle = full_turn * (float(i) + u_tap_offset + 0.5 * float(ring)) / rings[ring].z;
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

vec3 indirect(Surface s, float visibility) {
    vec3 lobe = has_anisotropy ? anisotropic_radiance(s) : lobe_radiance(s.position, s.normal, s.view, s.n_dot_v, s.roughness, s.alpha);
    vec3 result = s.energy.single * mirrored_light(lobe, s.n_dot_v, s.alpha, visibility, s.f0) + matt_light(s, visibility);
    Extension e = s.extension;
    if (has_sheen && any_lane(max_channel(e.sheen_color) > 0.0))
        result = result * s.sheen_keep + e.sheen_color * min(s.sheen_albedo, 1.0) * sheen_light(sheen_radiance(s), visibility);
    if (has_clearcoat) {
        float coat_alpha = e.coat_roughness * e.coat_roughness;
        vec3 coat = lobe_radiance(s.position, e.coat_normal, s.view, s.coat_n_dot_v, e.coat_roughness, coat_alpha);
        result = result * (1.0 - s.coat_albedo) +
                 s.coat_albedo * mirrored_light(coat, s.coat_n_dot_v, coat_alpha, visibility, vec3(0.04));
    }
    return result;
}

// Tone curves: linear Rec.709 radiance times exposure in, linear display light in [0, 1] out.
#feature TONE_ACES has_aces_curve
#feature TONE_REINHARD has_reinhard_curve
#feature TONE_AGX has_agx_curve
#feature TONE_NEUTRAL has_neutral_curve
#feature TONE_NONE is_clamped
#feature SCENE_LINEAR is_scene_linear
#feature PARTLY_COVERED is_partly_covered
#feature COVERED_AT_EDGES is_covered_at_edges  // nothing shines through: a mean of opaque surfaces, of caught shadow and of nothing

// Stephen Hill's fit of the ACES reference and output transforms (sRGB).
vec3 aces(vec3 c) {
    const mat3 input_matrix = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
    const mat3 output_matrix =
        mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
    vec3 v = input_matrix * c;
    v = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    return clamp(output_matrix * v, 0.0, 1.0);
}

// Reinhard et al. 2002, on luminance.
vec3 reinhard(vec3 c) { return clamp(c / (1.0 + dot(c, vec3(0.2126, 0.7152, 0.0722))), 0.0, 1.0); }

// AgX (Sobotka), the base look: log encoding, a sixth-order fit of the sigmoid, 2.2 display power.
vec3 agx(vec3 c) {
    const mat3 inset = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051, 0.0784335999999992,
                            0.878468636469772, 0.0784336, 0.0792237451477643, 0.0791661274605434, 0.879142973793104);
    const mat3 outset = mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438, -0.0980208811401368,
                             1.15190312990417, -0.0980434501171241, -0.0990297440797205, -0.0989611768448433,
                             1.15107367264116);
    const float min_ev = -12.47393, max_ev = 4.026069;
    vec3 x = (clamp(log2(max(inset * c, vec3(1e-10))), min_ev, max_ev) - min_ev) / (max_ev - min_ev);
    vec3 x2 = x * x, x4 = x2 * x2;
    vec3 y = 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232;
    return pow(clamp(outset * y, 0.0, 1.0), vec3(2.2));
}

// Khronos PBR Neutral tone mapper (specification of 2024).
vec3 neutral(vec3 c) {
    const float start = 0.8 - 0.04, desaturation = 0.15;
    float low = min(c.r, min(c.g, c.b));
    c -= low < 0.08 ? low - 6.25 * low * low : 0.04;
    float peak = max(c.r, max(c.g, c.b));
    const float d = 1.0 - start;
    float new_peak = 1.0 - d * d / (peak + d - start);
    vec3 compressed = c * (new_peak / peak);
    compressed = mix(vec3(new_peak), compressed, 1.0 / (desaturation * (peak - new_peak) + 1.0));
    return peak < start ? max(c, 0.0) : compressed;
}

// Without a curve radiance is scene-referred: for HDR files.
vec3 tone_map(vec3 c) {
    if (has_aces_curve) return aces(c);
    if (has_reinhard_curve) return reinhard(c);
    if (has_agx_curve) return agx(c);
    if (has_neutral_curve) return neutral(c);
    return is_clamped ? clamp(c, 0.0, 1.0) : c;
}

// Display light, premultiplied by its alpha, of premultiplied radiance. `covered`: the part of a pixel that surfaces cover, which
// is less than its alpha where a shadow is caught.
vec4 displayed(vec4 radiance, float exposure, float covered) {
    if (is_covered_at_edges) return vec4(tone_map(radiance.rgb * (exposure / max(covered, 1e-6))) * covered, radiance.a);
    if (!is_partly_covered) return vec4(tone_map(radiance.rgb * exposure) * radiance.a, radiance.a);
    // The curve is for what a surface shows, not for what its opacity leaves of it. Light that is brighter than its
    // coverage (a reflection on clear glass) covers more of what is behind: up to all.
    vec3 c = radiance.rgb * exposure;
    if (is_scene_linear) return vec4(c, radiance.a);
    float coverage = clamp(max(radiance.a, max(c.r, max(c.g, c.b))), 0.0, 1.0);
    return vec4(coverage > 0.0 ? tone_map(c / coverage) * coverage : vec3(0.0), coverage);
}

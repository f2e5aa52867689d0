// Part of a light that the casters of a shadow map leave to a receiver.
#include "common_lanes.glsl"
#include "common_noise.glsl"

#feature SHADOWS_HARD has_hard_shadows
#feature SHADOWS_PCF has_filtered_shadows
#feature SHADOWS_SOFT has_soft_shadows

// Of the one texel that the point falls in.
float lit_hard(Receiver r) {
    vec2 texel = (floor(r.at.xy * u_shadow_resolution) + 0.5) / u_shadow_resolution;
    float plane = r.depth + dot(r.slope, texel - r.at.xy);
    return textureLod(u_shadow_maps, r.at, 0.0).r > plane ? 0.0 : 1.0;
}

// The surface's plane at the four texels around a corner, where its depth is given, in the order of textureGather.
vec4 texel_planes(float depth, vec2 texel_slope) {
    return depth + 0.5 * (texel_slope.x * vec4(-1.0, 1.0, 1.0, -1.0) + texel_slope.y * vec4(1.0, 1.0, -1.0, -1.0));
}

// Those of the four texels around `corner` (in texels) that are not in front of the plane.
vec4 lit_texels(vec2 corner, float layer, float depth, vec2 texel_slope) {
    vec4 casters = textureGather(u_shadow_maps, vec3(corner / u_shadow_resolution, layer));
    return vec4(lessThanEqual(casters, texel_planes(depth, texel_slope)));
}

// Percentage-closer filtering (Reeves et al. 1987): the mean of 3x3 texels, interpolated between texels.
float lit_filtered(Receiver r) {
    vec2 at = r.at.xy * u_shadow_resolution - 0.5;
    vec2 base = floor(at), f = at - base;
    vec2 texel_slope = r.slope / u_shadow_resolution;
    // Corner (0, 0) lies between the texels -1 and 0, half a texel before the point's own.
    float depth = r.depth - dot(texel_slope, f + 0.5);
    vec4 low_low = lit_texels(base, r.at.z, depth, texel_slope);
    vec4 high_low = lit_texels(base + vec2(2.0, 0.0), r.at.z, depth + 2.0 * texel_slope.x, texel_slope);
    vec4 low_high = lit_texels(base + vec2(0.0, 2.0), r.at.z, depth + 2.0 * texel_slope.y, texel_slope);
    vec4 high_high = lit_texels(base + 2.0, r.at.z, depth + 2.0 * (texel_slope.x + texel_slope.y), texel_slope);
    // Columns weigh 1 - f, 1, 1, f, and so do rows; textureGather starts below on the left and turns.
    vec4 left = vec4(1.0 - f.x, 1.0, 1.0, 1.0 - f.x), right = vec4(1.0, f.x, f.x, 1.0);
    vec4 low = vec4(1.0, 1.0, 1.0 - f.y, 1.0 - f.y), high = vec4(f.y, f.y, 1.0, 1.0);
    return (dot(low_low, left * low) + dot(high_low, right * low) + dot(low_high, left * high) +
            dot(high_high, right * high)) / 9.0;
}

uniform int u_soft_taps;  // of the search for casters, and of the filter
// Widest search and filter, in map coordinates.
const float widest = 0.15;

// Of a tap on a disc, unit: turned by the golden angle from that of the tap before (Vogel 1979).
vec2 next_direction(vec2 direction) {
    const float cosine = -0.737368878, sine = 0.675490294;
    return vec2(cosine * direction.x - sine * direction.y, sine * direction.x + cosine * direction.y);
}

// What the plane changes by between a point and the texels around it, with roundings.
float plane_margin(Receiver r) { return dot(abs(r.slope), vec2(1.5 / u_shadow_resolution)) + 1e-6 * abs(r.depth); }

// No caster within the cone between a point and the light is nearer to the light; `search` is the cone's widest radius, in
// map coordinates. The nearest caster bounds the part of the cone that can hold any, which is narrower then.
float nearest_caster(Receiver r, vec2 search, bool needed) {
    vec2 least = vec2(2.0 / u_shadow_resolution);  // the texels around the point
    float nearest = layer_bounds(u_shadow_maps, r.at, max(search, least), needed).y;
    for (int i = 0; i < 2; ++i) {
        vec2 within = min(search, r.light * max(nearest - r.depth, 0.0));
        nearest = layer_bounds(u_shadow_maps, r.at, max(within, least), needed).y;
    }
    return nearest;
}

// Whether casters hide the light at all texels that the filter looks at.
bool hides_all(Receiver r, vec2 radius, float height, bool needed) {
    float texel = 1.0 / u_shadow_resolution;
    float farthest = layer_bounds(u_shadow_maps, r.at, radius + 2.0 * texel, needed).x;
    float plane = dot(abs(r.slope), radius);
    return farthest > r.depth + max(0.5 * height, plane) + 2.0 * plane_margin(r);
}

// Percentage-closer soft shadows (Fernando 2005): the mean depth of what is in the light's way gives the size of the
// penumbra. A texel is in the way when it lies in the cone between the point and the light, which in map coordinates
// and depth is a cone again, so that neighbours of the point on its own surface are not taken for casters.
float lit_soft(Receiver r, bool needed) {
    float texel = 1.0 / u_shadow_resolution;
    float turn = 6.28318531 * frame_noise(gl_FragCoord.xy, u_sample_index);
    vec2 first_direction = vec2(cos(turn), sin(turn)), direction = first_direction;
    float reach = min(r.reach, widest / max(r.light.x, r.light.y));
    vec2 search = r.light * reach;
    bool searches = needed && reach > 0.0;
    float nearest = nearest_caster(r, search, needed);
    if (!any_lane(needed && nearest >= r.depth - plane_margin(r))) return 1.0;
    // The texels around the point are looked at as well: the cone is narrower than they are where casters are near.
    vec2 corner = floor(r.at.xy * u_shadow_resolution - 0.5) + 1.0;
    float plane = r.depth + dot(r.slope, corner * texel - r.at.xy);
    vec4 casters = textureGather(u_shadow_maps, vec3(corner * texel, r.at.z));
    vec4 blocks = vec4(greaterThan(casters, texel_planes(plane, r.slope * texel)));
    float sum = dot(blocks, casters), count = dot(blocks, vec4(1.0));
    int taps = any_lane(searches) ? u_soft_taps : 0;
    for (int i = 0; i < taps; ++i) {
        // Denser towards the middle: casters near the point are seen in the narrow part of the cone only.
        float rho = (float(i) + 0.5) / float(u_soft_taps);
        if (!any_lane(searches && r.depth + rho * reach <= nearest)) break;
        vec2 at = r.at.xy + search * (rho * direction);
        direction = next_direction(direction);
        at = (floor(at * u_shadow_resolution) + 0.5) * texel;
        float caster = textureLod(u_shadow_maps, vec3(at, r.at.z), 0.0).r;
        float blocked = step(r.depth + max(rho * reach, dot(r.slope, at - r.at.xy)), caster);
        blocked = searches ? blocked : 0.0;
        sum += blocked * caster;
        count += blocked;
    }
    float height = sum / max(count, 1.0) - r.depth;  // of the casters over the point
    vec2 radius = clamp(r.light * height, vec2(0.5 * texel), vec2(widest));
    float lit = 0.0;
    bool partly = needed && count > 0.0 && !hides_all(r, radius, height, needed && count > 0.0);
    taps = any_lane(partly) ? u_soft_taps : 0;
    direction = first_direction;
    for (int i = 0; i < taps; ++i) {
        float rho = sqrt((float(i) + 0.5) / float(u_soft_taps));
        vec2 at = (r.at.xy + radius * (rho * direction)) * u_shadow_resolution - 0.5;
        direction = next_direction(direction);
        vec2 base = floor(at), f = at - base;
        corner = base + 1.0;
        plane = dot(r.slope, corner * texel - r.at.xy);
        vec4 texels = lit_texels(corner, r.at.z, r.depth + max(0.5 * rho * height, plane), r.slope * texel);
        vec2 across = mix(texels.wx, texels.zy, f.x);
        lit += mix(across.x, across.y, f.y);
    }
    return count > 0.0 ? lit / float(u_soft_taps) : 1.0;
}

// `needed`: whether the light counts at all; what no one needs may be anything.
float lit_part(Receiver r, bool needed) {
    if (has_hard_shadows) return lit_hard(r);
    return has_filtered_shadows ? lit_filtered(r) : lit_soft(r, needed);
}

// Shadow maps (Williams 1978). A map's depth grows towards the light and is linear on the map for every plane, which
// render/shadow_view.h defines: the plane of the lit surface is compared with each texel, so that it does not shadow
// itself at any slope or scale.
#include "common_noise.glsl"

struct ShadowMap {
    vec4 x, y, z;  // rows: from a position relative to the camera to the light's frame
    vec4 window;   // map coordinates = window.xy * (x, y) / w + window.zw
    vec4 depth;    // depth = (depth.x * z + depth.y) / w; z: 1 where w = z, 0 where w = 1; w: first layer
    vec4 size;     // x: the light's radius as a slope per unit of depth; y: depth per slope of a plane;
                   // z: size of a texel per w; w: no caster's depth is larger
};
layout(std140, binding = 1) uniform Shadows { ShadowMap u_shadows[LIGHTS_PER_BLOCK]; };
uniform sampler2DArray u_shadow_maps;
uniform float u_shadow_resolution;
uniform float u_sample_index;

// A lit point on a map.
struct Receiver {
    vec3 at;      // map coordinates, layer
    float depth;
    vec2 slope;   // of the surface: change of depth per map coordinate
    vec2 light;   // the light's radius in map coordinates per unit of depth
    float reach;  // how much nearer to the light a caster can be
};

// Grazing light sees planes at most this steep (86.5 degrees): their depths are not to be extrapolated further.
const float least_cosine = 0.06;
// Texels that the surface is lifted: what is bent or rough below a texel must not shadow itself.
const float lift = 0.5;
// Roundings of positions and depths, relative.
const float rounding = 4e-6;

// `p` and `n` are the position and the normal of the surface in the light's frame.
Receiver receive(ShadowMap map, vec3 p, vec3 n, float layer) {
    bool perspective = map.depth.z > 0.5;
    p += n * (lift * map.size.z * (perspective ? max(p.z, 0.0) : 1.0));
    // Behind a light nothing casts: a depth of 2 is before all casters.
    float w = perspective ? max(p.z, 0.5 * map.size.y) : 1.0;
    float towards = perspective ? dot(n, p) : n.z;
    float steepest = least_cosine * (perspective ? length(p) : 1.0);
    Receiver r;
    r.at = vec3(map.window.xy * p.xy / w + map.window.zw, layer);
    r.depth = (map.depth.x * p.z + map.depth.y) / w;
    r.slope = map.size.y * n.xy / (min(towards, -steepest) * map.window.xy);
    r.light = map.size.x * map.window.xy;
    r.reach = max(map.size.w - r.depth, 0.0);
    r.depth += rounding * (perspective ? r.depth : 1.0);
    return r;
}

#ifdef SHADOWS_HARD
// Of the one texel that the point falls in.
float lit_part(Receiver r, bool needed) {
    vec2 texel = (floor(r.at.xy * u_shadow_resolution) + 0.5) / u_shadow_resolution;
    float plane = r.depth + dot(r.slope, texel - r.at.xy);
    return textureLod(u_shadow_maps, r.at, 0.0).r > plane ? 0.0 : 1.0;
}
#endif

#if defined(SHADOWS_PCF) || defined(SHADOWS_SOFT)
// The surface's plane at the four texels around a corner, where its depth is given, in the order of textureGather.
vec4 texel_planes(float depth, vec2 texel_slope) {
    return depth + 0.5 * (texel_slope.x * vec4(-1.0, 1.0, 1.0, -1.0) + texel_slope.y * vec4(1.0, 1.0, -1.0, -1.0));
}

// Those of the four texels around `corner` (in texels) that are not in front of the plane.
vec4 lit_texels(vec2 corner, float layer, float depth, vec2 texel_slope) {
    vec4 casters = textureGather(u_shadow_maps, vec3(corner / u_shadow_resolution, layer));
    return vec4(lessThanEqual(casters, texel_planes(depth, texel_slope)));
}
#endif

#ifdef SHADOWS_PCF
// Percentage-closer filtering (Reeves et al. 1987): the mean of 3x3 texels, interpolated between texels.
float lit_part(Receiver r, bool needed) {
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
#endif

#ifdef SHADOWS_SOFT
const int search_taps = 16;
const int filter_taps = 16;
// Widest search and filter, in map coordinates.
const float widest = 0.15;
const float golden_angle = 2.39996323;

// Percentage-closer soft shadows (Fernando 2005): the mean depth of what is in the light's way gives the size of the
// penumbra. A texel is in the way when it lies in the cone between the point and the light, which in map coordinates
// and depth is a cone again, so that neighbours of the point on its own surface are not taken for casters.
float lit_part(Receiver r, bool needed) {
    float texel = 1.0 / u_shadow_resolution;
    float turn = 6.28318531 * frame_noise(gl_FragCoord.xy, u_sample_index);
    float reach = min(r.reach, widest / max(r.light.x, r.light.y));
    vec2 search = r.light * reach;
    // The texels around the point are looked at in any case: the cone is narrower than they are where casters are near.
    vec2 corner = floor(r.at.xy * u_shadow_resolution - 0.5) + 1.0;
    float plane = r.depth + dot(r.slope, corner * texel - r.at.xy);
    vec4 casters = textureGather(u_shadow_maps, vec3(corner * texel, r.at.z));
    vec4 blocks = vec4(greaterThan(casters, texel_planes(plane, r.slope * texel)));
    float sum = dot(blocks, casters), count = dot(blocks, vec4(1.0));
    int taps = needed && reach > 0.0 ? search_taps : 0;
    for (int i = 0; i < taps; ++i) {
        // Denser towards the middle: casters near the point are seen in the narrow part of the cone only.
        float rho = (float(i) + 0.5) / float(search_taps), angle = turn + golden_angle * float(i);
        vec2 at = r.at.xy + search * (rho * vec2(cos(angle), sin(angle)));
        at = (floor(at * u_shadow_resolution) + 0.5) * texel;
        float caster = textureLod(u_shadow_maps, vec3(at, r.at.z), 0.0).r;
        float blocked = step(r.depth + max(rho * reach, dot(r.slope, at - r.at.xy)), caster);
        sum += blocked * caster;
        count += blocked;
    }
    float height = sum / max(count, 1.0) - r.depth;  // of the casters over the point
    vec2 radius = clamp(r.light * height, vec2(0.5 * texel), vec2(widest));
    float lit = 0.0;
    taps = needed && count > 0.0 ? filter_taps : 0;
    for (int i = 0; i < taps; ++i) {
        float rho = sqrt((float(i) + 0.5) / float(filter_taps)), angle = turn + golden_angle * float(i);
        vec2 at = (r.at.xy + radius * (rho * vec2(cos(angle), sin(angle)))) * u_shadow_resolution - 0.5;
        vec2 base = floor(at), f = at - base;
        corner = base + 1.0;
        plane = dot(r.slope, corner * texel - r.at.xy);
        vec4 texels = lit_texels(corner, r.at.z, r.depth + max(0.5 * rho * height, plane), r.slope * texel);
        vec2 across = mix(texels.wx, texels.zy, f.x);
        lit += mix(across.x, across.y, f.y);
    }
    return count > 0.0 ? lit / float(filter_taps) : 1.0;
}
#endif

// Part of a light that reaches a receiver: a number, or a colour where casters let some of it through.
#ifdef SHADOW_TINTS
#include "common_shadow_tint.glsl"
#define PART vec3
PART part_of_light(Receiver r, bool needed) {
    float lit = lit_part(r, needed);
    return lit * tint_part(r, needed && lit > 0.0);
}
float brightness(vec3 part) { return luminance(part); }
#else
#define PART float
PART part_of_light(Receiver r, bool needed) { return lit_part(r, needed); }
float brightness(float part) { return part; }
#endif

// For a light with one map.
PART shadow_single(int index, vec3 position, vec3 normal, bool needed) {
    ShadowMap map = u_shadows[index];
    vec3 p = vec3(dot(map.x.xyz, position) + map.x.w, dot(map.y.xyz, position) + map.y.w,
                  dot(map.z.xyz, position) + map.z.w);
    vec3 n = vec3(dot(map.x.xyz, normal), dot(map.y.xyz, normal), dot(map.z.xyz, normal));
    return part_of_light(receive(map, p, n, map.depth.w), needed);
}

#ifdef SHADOW_CUBES
// The same for a cube: the face that the largest component names.
PART shadow_cube(int index, vec3 position, vec3 normal, bool needed) {
    ShadowMap map = u_shadows[index];
    vec3 p = position + vec3(map.x.w, map.y.w, map.z.w), a = abs(p);
    float face = a.x >= a.y && a.x >= a.z ? 0.0 : a.y >= a.z ? 2.0 : 4.0;
    vec3 q = face < 1.0 ? p.yzx : face < 3.0 ? p.zxy : p;
    vec3 n = face < 1.0 ? normal.yzx : face < 3.0 ? normal.zxy : normal;
    float side = q.z < 0.0 ? -1.0 : 1.0;
    q.z *= side;
    n.z *= side;
    return part_of_light(receive(map, q, n, map.depth.w + face + (side < 0.0 ? 1.0 : 0.0)), needed);
}
#endif

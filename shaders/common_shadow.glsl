// Shadow maps (Williams 1978). A map's depth grows towards the light and is linear on the map for every plane, which
// render/shadow_view.h defines: the plane of the lit surface is compared with each texel, so that it does not shadow
// itself at any slope or scale. Included by common_lights.glsl.
#feature SHADOW_TINTS has_shadow_tints

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

#include "common_shadow_filter.glsl"
#include "common_shadow_tint.glsl"

// Part of a light that reaches a receiver: grey unless casters let some of it through.
vec3 part_of_light(Receiver r, bool needed) {
    float lit = lit_part(r, needed);
    return has_shadow_tints ? lit * tint_part(r, needed && lit > 0.0) : vec3(lit);
}

float brightness(vec3 part) { return has_shadow_tints ? luminance(part) : part.r; }

// For a light with one map.
vec3 shadow_single(int index, vec3 position, vec3 normal, bool needed) {
    ShadowMap map = u_shadows[index];
    vec3 p = vec3(dot(map.x.xyz, position) + map.x.w, dot(map.y.xyz, position) + map.y.w,
                  dot(map.z.xyz, position) + map.z.w);
    vec3 n = vec3(dot(map.x.xyz, normal), dot(map.y.xyz, normal), dot(map.z.xyz, normal));
    return part_of_light(receive(map, p, n, map.depth.w), needed);
}

// The same for a cube: the face that the largest component names.
vec3 shadow_cube(int index, vec3 position, vec3 normal, bool needed) {
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

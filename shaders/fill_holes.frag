// Closes gaps between points: a pixel most of whose neighbours lie on one surface before it takes after the nearest.
#include "common_projection.glsl"

#feature OBJECT_ID has_ids

uniform sampler2D u_albedo;
uniform sampler2D u_normal;
uniform sampler2D u_material;
uniform sampler2D u_depth_target;
uniform vec2 u_size;
uniform usampler2D u_id;
uniform usampler2D u_element;

layout(location = 0) out vec4 o_albedo;
layout(location = 1) out vec2 o_normal;
layout(location = 2) out vec4 o_material;
layout(location = 3) out float o_depth;
layout(location = 5) out uint o_id;
layout(location = 6) out uint o_element;

// Distance along the optical axis, where there is nothing too.
float axial(float depth) { return is_orthographic || depth > 0.0 ? axial_distance(depth) : 3e38; }

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float own = texelFetch(u_depth_target, p, 0).r, nearest = 0.0;
    ivec2 best = p;
    float depths[8];
    int k = 0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            if (x == 0 && y == 0) continue;
            ivec2 q = clamp(p + ivec2(x, y), ivec2(0), ivec2(u_size) - 1);
            depths[k] = texelFetch(u_depth_target, q, 0).r;
            if (depths[k] > nearest) {
                nearest = depths[k];
                best = q;
            }
            ++k;
        }
    // One percent of the distance holds a surface together; five of eight surround a gap and no silhouette.
    float reach = axial(nearest) * 1.01;
    int count = 0;
    for (int i = 0; i < 8; ++i) count += depths[i] > 0.0 && axial(depths[i]) <= reach ? 1 : 0;
    if (count < 5 || (own > 0.0 && axial(own) <= reach)) discard;
    o_albedo = texelFetch(u_albedo, best, 0);
    o_normal = texelFetch(u_normal, best, 0).rg;
    o_material = texelFetch(u_material, best, 0);
    o_depth = nearest;
    gl_FragDepth = nearest;
    if (has_ids) {
        o_id = texelFetch(u_id, best, 0).r;
        o_element = texelFetch(u_element, best, 0).r;
    }
}

// Closes gaps between points: a pixel most of whose neighbours lie on one surface before it takes after the nearest.
uniform sampler2D u_albedo;
uniform sampler2D u_normal;
uniform sampler2D u_material;
uniform sampler2D u_depth_target;
uniform vec2 u_size;
uniform vec3 u_depth;  // as in common_camera.glsl

layout(location = 0) out vec4 o_albedo;
layout(location = 1) out vec2 o_normal;
layout(location = 2) out vec4 o_material;
layout(location = 3) out float o_depth;
#ifdef OBJECT_ID
uniform usampler2D u_id;
uniform usampler2D u_element;
layout(location = 5) out uint o_id;
layout(location = 6) out uint o_element;
#endif

// Distance along the optical axis of a reversed depth.
float axial(float depth) {
#ifdef ORTHOGRAPHIC
    return mix(u_depth.y, u_depth.x, depth);
#else
    return depth > 0.0 ? u_depth.x / depth : 3e38;
#endif
}

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
#ifdef OBJECT_ID
    o_id = texelFetch(u_id, best, 0).r;
    o_element = texelFetch(u_element, best, 0).r;
#endif
}

// Second step of surface splatting (Botsch et al. 2005). Without ACCUMULATE: the nearest distance of each pixel, pushed
// back by the surfel's size. With it: weighted sums of what lies before that. FARTHEST: the farthest distance, pulled
// forward, and what lies behind that. ONE_SURFEL: no distance is pushed, and ids say which surfel alone is summed.
#include "common_projection.glsl"

#feature PEEL is_peeling
#feature FARTHEST finds_farthest
#feature ACCUMULATE is_accumulating
#feature OBJECT_ID has_ids
#feature ONE_SURFEL is_single

uniform sampler2D u_depth_target;  // of what hides surfels; PEEL: where the last layer ended
uniform vec2 u_size;
uniform vec3 u_material;           // metallic, roughness, code of the kind

flat in vec2 v_centre;
flat in vec4 v_axes;
flat in vec4 v_plane;
flat in vec4 v_distance;
flat in float v_least;
flat in vec3 v_normal;
flat in vec4 v_color;
flat in uint v_element;

#ifdef ACCUMULATE  // The steps' targets have numbers of other types at the same places.
layout(location = 0) out vec4 o_albedo;    // sums; a: of the weights
layout(location = 1) out vec4 o_normal;    // sums; a: of the distances
layout(location = 2) out vec4 o_material;  // sums of metallic, roughness, code of the kind, opacity
#else
layout(location = 0) out uint o_id;
layout(location = 1) out uint o_element;
#endif

uniform int u_object_id;
uniform usampler2D u_id, u_element;  // ONE_SURFEL, of what is summed: of each pixel's nearest surfel

void main() {
    vec2 d = gl_FragCoord.xy - v_centre;
    float far = max(abs(d.x), abs(d.y)) / v_least;
    float screen = far * far;
    float scale = v_plane.w / (dot(v_plane.xy, d) + v_plane.z);
    vec2 uv = vec2(v_axes.w * d.x - v_axes.z * d.y, v_axes.x * d.y - v_axes.y * d.x) * scale;
    float r2 = dot(uv, uv);
    bool on_plane = r2 < screen;
    float z = v_distance.z + (on_plane ? dot(uv, v_distance.xy) : 0.0);
    r2 = on_plane ? r2 : screen;
    float depth = reversed_depth(z);
    float limit = textureLod(u_depth_target, gl_FragCoord.xy / u_size, 0.0).r;
    if (!(r2 <= 1.0) || depth < limit) discard;
    if (is_peeling && depth == limit) discard;
#ifdef ACCUMULATE  // As above.
    if (is_single) {
        ivec2 p = ivec2(gl_FragCoord.xy);
        if (texelFetch(u_id, p, 0).r != uint(u_object_id) || texelFetch(u_element, p, 0).r != v_element) discard;
    }
    gl_FragDepth = depth;
    float weight = max((1.0 - r2) * (1.0 - r2), 1e-4);
    o_albedo = vec4(v_color.rgb, 1.0) * weight;
    o_normal = vec4(v_normal, z) * weight;
    o_material = vec4(u_material, v_color.a) * weight;
#else
    gl_FragDepth = reversed_depth(finds_farthest ? max(z - v_distance.w, u_depth.x) : z + v_distance.w);
    if (has_ids) {
        o_id = uint(u_object_id);
        o_element = v_element;
    }
#endif
}

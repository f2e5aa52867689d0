// Third step of surface splatting: sums divided by their weights, into the G-buffer.
#include "common_encoding.glsl"

uniform sampler2D u_albedo_sum;
uniform sampler2D u_normal_sum;
uniform sampler2D u_material_sum;
uniform vec2 u_size;
uniform vec3 u_depth;  // as in common_camera.glsl

#ifdef PEEL
uniform sampler2D u_band;  // where it ends, reversed depth
uniform float u_owner;
layout(location = 5) out vec2 o_claim;
#endif
layout(location = 0) out vec4 o_albedo;
layout(location = 1) out vec2 o_normal;
layout(location = 2) out vec4 o_material;
layout(location = 3) out float o_depth;
layout(location = 4) out vec4 o_emission;
#ifdef OBJECT_ID
uniform usampler2D u_id;
uniform usampler2D u_element;
layout(location = 5) out uint o_id;
layout(location = 6) out uint o_element;
#endif

void main() {
    vec2 uv = gl_FragCoord.xy / u_size;
    vec4 albedo = textureLod(u_albedo_sum, uv, 0.0), normal = textureLod(u_normal_sum, uv, 0.0);
    if (albedo.a <= 0.0) discard;
    vec4 material = textureLod(u_material_sum, uv, 0.0) / albedo.a;
    float z = normal.a / albedo.a;
#ifdef ORTHOGRAPHIC
    float depth = (u_depth.y - z) / (u_depth.y - u_depth.x);
#else
    float depth = u_depth.x / z;
#endif
#ifdef PEEL
    o_albedo = vec4(albedo.rgb / albedo.a, material.w);
    o_claim = vec2(u_owner, textureLod(u_band, uv, 0.0).r);
#else
    o_albedo = vec4(albedo.rgb / albedo.a, 1.0);
#endif
    o_normal = oct_encode(normalize(normal.xyz)) * 0.5 + 0.5;
    o_material = vec4(material.xy, 1.0, material.z);
    o_depth = depth;
    o_emission = vec4(0.0, 0.0, 0.0, 1.0);
    gl_FragDepth = depth;
#ifdef OBJECT_ID
    ivec2 p = ivec2(gl_FragCoord.xy);
    o_id = texelFetch(u_id, p, 0).r;
    o_element = texelFetch(u_element, p, 0).r;
#endif
}

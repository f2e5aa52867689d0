// Third step of surface splatting: sums divided by their weights, into the G-buffer.
#include "common_encoding.glsl"
#include "common_projection.glsl"

#feature PEEL is_peeling
#feature OBJECT_ID has_ids

uniform sampler2D u_albedo_sum;
uniform sampler2D u_normal_sum;
uniform sampler2D u_material_sum;
uniform vec2 u_size;
uniform sampler2D u_band;  // of peeling: where it ends, reversed depth
uniform float u_owner;
uniform usampler2D u_id;
uniform usampler2D u_element;

layout(location = 0) out vec4 o_albedo;
layout(location = 1) out vec2 o_normal;
layout(location = 2) out vec4 o_material;
layout(location = 3) out float o_depth;
layout(location = 4) out vec4 o_emission;
#ifdef PEEL  // Layers have a target of another type in the place of the ids.
layout(location = 5) out vec2 o_claim;
#else
layout(location = 5) out uint o_id;
layout(location = 6) out uint o_element;
#endif

void main() {
    vec2 uv = gl_FragCoord.xy / u_size;
    vec4 albedo = textureLod(u_albedo_sum, uv, 0.0), normal = textureLod(u_normal_sum, uv, 0.0);
    if (albedo.a <= 0.0) discard;
    vec4 material = textureLod(u_material_sum, uv, 0.0) / albedo.a;
    float z = normal.a / albedo.a;
    float depth = reversed_depth(z);
    o_albedo = vec4(albedo.rgb / albedo.a, is_peeling ? material.w : 1.0);
    o_normal = oct_encode(normalize(normal.xyz)) * 0.5 + 0.5;
    o_material = vec4(material.xy, 1.0, material.z);
    o_depth = depth;
    o_emission = vec4(0.0, 0.0, 0.0, 1.0);
    gl_FragDepth = depth;
#ifdef PEEL  // As above.
    o_claim = vec2(u_owner, textureLod(u_band, uv, 0.0).r);
#else
    ivec2 p = ivec2(gl_FragCoord.xy);
    if (has_ids) {
        o_id = texelFetch(u_id, p, 0).r;
        o_element = texelFetch(u_element, p, 0).r;
    }
#endif
}

// Surfaces that were drawn elsewhere into the G-buffer, where they are nearer than what it holds.
#feature WITH_EMISSION has_emission
#feature OBJECT_ID has_ids
#feature WITH_EXTENSION has_extensions

uniform sampler2D u_albedo;
uniform sampler2D u_normal;
uniform sampler2D u_material;
uniform sampler2D u_depth_target;
uniform sampler2D u_emission;
uniform usampler2D u_id;
uniform usampler2D u_element;
uniform usampler2D u_extension0;
uniform usampler2D u_extension1;
uniform vec2 u_size;

layout(location = 0) out vec4 o_albedo;
layout(location = 1) out vec2 o_normal;
layout(location = 2) out vec4 o_material;
layout(location = 3) out float o_depth;
layout(location = 4) out vec4 o_emission;
layout(location = 5) out uvec4 o_first;   // as in geometry_mesh.frag
layout(location = 6) out uvec4 o_second;

void main() {
    vec2 uv = gl_FragCoord.xy / u_size;
    float depth = textureLod(u_depth_target, uv, 0.0).r;
    o_albedo = textureLod(u_albedo, uv, 0.0);
    o_normal = textureLod(u_normal, uv, 0.0).rg;
    o_material = textureLod(u_material, uv, 0.0);
    o_depth = depth;
    o_emission = vec4(0.0, 0.0, 0.0, 1.0);
    gl_FragDepth = depth;
    if (has_emission) {
        if (depth <= 0.0) discard;
        o_emission = textureLod(u_emission, uv, 0.0);
    }
    ivec2 p = ivec2(gl_FragCoord.xy);
    if (has_ids) {
        o_first.x = texelFetch(u_id, p, 0).r;
        o_second.x = texelFetch(u_element, p, 0).r;
    }
    if (has_extensions) {
        o_first = texelFetch(u_extension0, p, 0);
        o_second = texelFetch(u_extension1, p, 0);
    }
}

// Surfaces that were drawn elsewhere into the G-buffer, where they are nearer than what it holds.
uniform sampler2D u_albedo;
uniform sampler2D u_normal;
uniform sampler2D u_material;
uniform sampler2D u_depth_target;
uniform vec2 u_size;
#ifdef WITH_EMISSION
uniform sampler2D u_emission;
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
#ifdef WITH_EXTENSION
uniform usampler2D u_extension0;
uniform usampler2D u_extension1;
layout(location = 5) out uvec4 o_extension0;
layout(location = 6) out uvec4 o_extension1;
#endif

void main() {
    vec2 uv = gl_FragCoord.xy / u_size;
    float depth = textureLod(u_depth_target, uv, 0.0).r;
    o_albedo = textureLod(u_albedo, uv, 0.0);
    o_normal = textureLod(u_normal, uv, 0.0).rg;
    o_material = textureLod(u_material, uv, 0.0);
    o_depth = depth;
    o_emission = vec4(0.0, 0.0, 0.0, 1.0);
    gl_FragDepth = depth;
#ifdef WITH_EMISSION
    if (depth <= 0.0) discard;
    o_emission = textureLod(u_emission, uv, 0.0);
#endif
#ifdef OBJECT_ID
    ivec2 p = ivec2(gl_FragCoord.xy);
    o_id = texelFetch(u_id, p, 0).r;
    o_element = texelFetch(u_element, p, 0).r;
#endif
#ifdef WITH_EXTENSION
    o_extension0 = texelFetch(u_extension0, ivec2(gl_FragCoord.xy), 0);
    o_extension1 = texelFetch(u_extension1, ivec2(gl_FragCoord.xy), 0);
#endif
}

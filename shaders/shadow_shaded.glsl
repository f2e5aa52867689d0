// What a caster with a shader of its own leaves in a shadow map, as in shadow_depth.frag.
#ifdef TINT
#include "common_tint.glsl"
uniform vec3 u_through;
uniform float u_root;
#ifdef SHADOW_TRANSMISSION
uniform sampler2D u_transmission_texture;
uniform mat3 u_transmission_uv;
uniform vec4 u_transmission_channel;
#endif
#else
layout(location = 0) out float o_shadow;
#endif

void write_shadow(vec4 color) {
#ifdef TINT
    float transmission = 1.0;
#ifdef SHADOW_TRANSMISSION
    vec2 uv = (u_transmission_uv * vec3(v_uv, 1.0)).xy;
    transmission = dot(texture(u_transmission_texture, vec2(uv.x, 1.0 - uv.y)), u_transmission_channel);
#endif
#ifdef COVERS
    color.a = 1.0;
#endif
    write_tint(1.0 - color.a + color.a * u_through * pow(max(color.rgb * transmission, 0.0), vec3(u_root)));
#else
    o_shadow = gl_FragCoord.z;
#endif
}

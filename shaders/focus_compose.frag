// The sharp picture where it is in focus, the gathered one elsewhere, and before both what is near.
#include "common_focus.glsl"

uniform sampler2D u_radiance;
uniform sampler2D u_depth_target;
uniform sampler2D u_behind;
uniform sampler2D u_before;
uniform sampler2D u_hidden;
uniform vec2 u_size;
uniform float u_light_scale;  // of the half resolution's light
uniform vec2 u_covered_size;  // of the half resolution's textures, pixels of full resolution

layout(location = 0) out vec4 o_radiance;

void main() {
    vec2 uv = gl_FragCoord.xy / u_size, half_uv = gl_FragCoord.xy / u_covered_size;
    vec4 sharp = textureLod(u_radiance, uv, 0.0);
    float radius = abs(confusion(textureLod(u_depth_target, uv, 0.0).r));
    vec4 scale = vec4(vec3(u_light_scale), 1.0);
    vec4 base = mix(sharp, scale * textureLod(u_behind, half_uv, 0.0), smoothstep(0.5, 1.5, radius));
    o_radiance = scale * textureLod(u_before, half_uv, 0.0) + (1.0 - textureLod(u_hidden, half_uv, 0.0).r) * base;
}

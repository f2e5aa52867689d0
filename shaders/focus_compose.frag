// The sharp picture where it is in focus, the gathered one elsewhere, and before both what is near. Nothing changes where the
// picture has no light.
#include "common_focus.glsl"

uniform sampler2D u_radiance;
uniform sampler2D u_depth_target;
uniform sampler2D u_behind;
uniform sampler2D u_before;
uniform sampler2D u_hidden;
uniform sampler2D u_weight;
uniform vec2 u_size;
uniform float u_light_scale;  // of the half resolution's light
uniform vec2 u_covered_size;  // of the half resolution's textures, pixels of full resolution

layout(location = 0) out vec4 o_radiance;

void main() {
    vec2 uv = gl_FragCoord.xy / u_size, half_uv = gl_FragCoord.xy / u_covered_size;
    vec4 sharp = textureLod(u_radiance, uv, 0.0);
    float depth = textureLod(u_depth_target, uv, 0.0).r;
    float radius = abs(confusion(depth));
    vec4 scale = vec4(vec3(u_light_scale), 1.0);
    // The filter reads mostly the pixel's own texel, of which the pixel is a quarter: where it has light this is 9/64 or more.
    float weight = has_overlay ? textureLod(u_weight, half_uv, 0.0).r : 1.0;
    vec4 behind = textureLod(u_behind, half_uv, 0.0) / max(weight, 0.1);
    vec4 base = mix(sharp, scale * behind, smoothstep(0.5, 1.5, radius));
    vec4 blurred = scale * textureLod(u_before, half_uv, 0.0) + (1.0 - textureLod(u_hidden, half_uv, 0.0).r) * base;
    o_radiance = has_light(uv, depth) > 0.5 ? blurred : sharp;
}

// Adds one jittered frame to the sum, tone mapped, so that each sample of an edge weighs what the eye makes of it.
#include "common_shown.glsl"

uniform sampler2D u_radiance;

layout(location = 0) out vec4 o_sum;

void main() {
    vec2 uv = gl_FragCoord.xy / u_size;
    o_sum = shown(textureLod(u_radiance, uv, 0.0), uv);
}

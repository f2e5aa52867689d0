// Tints of splats, which are rasterised natively, into a shadow map.
#include "shadow_target.glsl"

uniform sampler2D u_absorption;
uniform sampler2D u_moment;

void main() {
    vec4 absorption = texelFetch(u_absorption, ivec2(gl_FragCoord.xy), 0);
    if (absorption.rgb == vec3(0.0)) discard;
    o_absorption = absorption;
    o_moment = texelFetch(u_moment, ivec2(gl_FragCoord.xy), 0);
}

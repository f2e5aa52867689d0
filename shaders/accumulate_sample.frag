// Adds one jittered frame to the sum, tone mapped, so that each sample of an edge weighs what the eye makes of it.
#include "common_bloom.glsl"
#include "common_tone.glsl"

#feature BLOOM has_bloom
#feature OVERLAY has_overlay

uniform sampler2D u_radiance;
uniform vec2 u_size;
uniform float u_exposure;
uniform sampler2D u_overlay;  // linear display light, premultiplied

layout(location = 0) out vec4 o_sum;

void main() {
    vec4 radiance = textureLod(u_radiance, gl_FragCoord.xy / u_size, 0.0);
    if (has_bloom) radiance = with_bloom(radiance, gl_FragCoord.xy);
    o_sum = displayed(radiance, u_exposure);
    if (has_overlay) {
        vec4 over = textureLod(u_overlay, gl_FragCoord.xy / u_size, 0.0);
        o_sum = o_sum * (1.0 - over.a) + over;
    }
}

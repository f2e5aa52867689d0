// What is displayed of a frame.
#include "common_bloom.glsl"
#include "common_tone.glsl"

#feature BLOOM has_bloom
#feature OVERLAY has_overlay

uniform vec2 u_size;
uniform float u_exposure;
uniform sampler2D u_overlay;  // linear display light, premultiplied

vec4 shown(vec4 radiance, vec2 uv) {
    if (has_bloom) radiance = with_bloom(radiance, gl_FragCoord.xy);
    vec4 color = displayed(radiance, u_exposure);
    if (!has_overlay) return color;
    vec4 over = textureLod(u_overlay, uv, 0.0);
    return color * (1.0 - over.a) + over;
}

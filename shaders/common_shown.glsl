// What is displayed of a frame.
#include "common_bloom.glsl"
#include "common_tone.glsl"

#feature BLOOM has_bloom
#feature OVERLAY has_overlay
#feature SHADOW has_shadow  // of a shadow catcher, before nothing

uniform vec2 u_size;
uniform float u_exposure;
uniform sampler2D u_overlay;  // linear display light, premultiplied
uniform sampler2D u_shadow_share;  // sum of shadow_share.frag
uniform float u_share_scale;       // 1 / frames

// What surfaces leave of a pixel to the catcher.
float left_to_catcher(vec2 uv) { return textureLod(u_shadow_share, uv, 0.0).r * u_share_scale; }

vec4 shown(vec4 radiance, vec2 uv) {
    if (has_bloom) radiance = with_bloom(radiance, gl_FragCoord.xy);
    float covered = has_shadow ? clamp(1.0 - left_to_catcher(uv), 0.0, 1.0) : radiance.a;
    vec4 color = displayed(radiance, u_exposure, covered);
    if (!has_overlay) return color;
    vec4 over = textureLod(u_overlay, uv, 0.0);
    return color * (1.0 - over.a) + over;
}

// The last step: background behind what was drawn, sRGB encoding.
#include "common_bloom.glsl"
#include "common_encoding.glsl"
#include "common_tone.glsl"

#feature SUM is_sum  // of frames, tone mapped
#feature BLOOM has_bloom
#feature OVERLAY has_overlay
#feature BACKGROUND_IMAGE has_background_image
#feature LINEAR_OUTPUT is_linear_output

uniform sampler2D u_source;     // accumulated display light; or one frame's radiance
uniform vec2 u_size;
uniform float u_exposure;
uniform float u_sample_scale;   // of a sum: 1 / samples
uniform vec4 u_background;      // linear display light, premultiplied by alpha
uniform sampler2D u_background_image;  // linear display light, premultiplied
uniform vec4 u_background_uv;   // scale and offset that cover the picture without distortion
uniform sampler2D u_overlay;    // linear display light, premultiplied

layout(location = 0) out vec4 o_color;

// Display light of one frame.
vec4 shown(vec4 radiance, vec2 uv) {
    if (has_bloom) radiance = with_bloom(radiance, gl_FragCoord.xy);
    vec4 color = displayed(radiance, u_exposure);
    if (!has_overlay) return color;
    vec4 over = textureLod(u_overlay, uv, 0.0);
    return color * (1.0 - over.a) + over;
}

void main() {
    vec2 uv = gl_FragCoord.xy / u_size;
    vec4 source = textureLod(u_source, uv, 0.0);
    vec4 color = is_sum ? source * u_sample_scale : shown(source, uv);
    vec4 behind = u_background;
    if (has_background_image) {
        vec4 texel = textureLod(u_background_image, uv * u_background_uv.xy + u_background_uv.zw, 0.0);
        behind = texel + (1.0 - texel.a) * behind;
    }
    color += (1.0 - color.a) * behind;
    // Files hold straight alpha.
    vec3 straight = color.a > 0.0 ? color.rgb * (1.0 / color.a) : vec3(0.0);
    o_color = is_linear_output ? color : vec4(srgb_encode(clamp(straight, 0.0, 1.0)), color.a);
}

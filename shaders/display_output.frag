// The last step: background behind what was drawn, sRGB encoding.
#include "common_encoding.glsl"
#include "common_tone.glsl"
#ifdef BLOOM
#include "common_bloom.glsl"
#endif

uniform sampler2D u_source;  // SUM: accumulated display light; else one frame's radiance
uniform vec2 u_size;
uniform float u_exposure;
uniform float u_sample_scale;   // SUM: 1 / samples
uniform vec4 u_background;      // linear display light, premultiplied by alpha
#ifdef BACKGROUND_IMAGE
uniform sampler2D u_background_image;
uniform vec4 u_background_uv;   // scale and offset that cover the picture without distortion
#endif

#ifdef OVERLAY
uniform sampler2D u_overlay;    // linear display light, premultiplied
#endif

layout(location = 0) out vec4 o_color;

void main() {
    vec2 uv = gl_FragCoord.xy / u_size;
    vec4 source = textureLod(u_source, uv, 0.0);
#ifdef SUM
    vec4 color = source * u_sample_scale;
#else
#ifdef BLOOM
    source = with_bloom(source, gl_FragCoord.xy);
#endif
    vec4 color = displayed(source, u_exposure);
#ifdef OVERLAY
    vec4 over = textureLod(u_overlay, uv, 0.0);
    color = color * (1.0 - over.a) + over;
#endif
#endif
#ifdef BACKGROUND_IMAGE
    vec4 behind = vec4(textureLod(u_background_image, uv * u_background_uv.xy + u_background_uv.zw, 0.0).rgb, 1.0);
#else
    vec4 behind = u_background;
#endif
    color += (1.0 - color.a) * behind;
#ifdef LINEAR_OUTPUT
    o_color = color;
#else
    // Files hold straight alpha.
    vec3 straight = color.a > 0.0 ? color.rgb / color.a : vec3(0.0);
    o_color = vec4(srgb_encode(clamp(straight, 0.0, 1.0)), color.a);
#endif
}

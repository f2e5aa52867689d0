// The last step: background behind what was drawn, sRGB encoding.
#include "common_encoding.glsl"
#include "common_shown.glsl"

#feature SUM is_sum  // of frames, tone mapped
#feature BACKGROUND_IMAGE has_background_image
#feature LINEAR_OUTPUT is_linear_output

uniform sampler2D u_source;     // accumulated display light; or one frame's radiance
uniform float u_sample_scale;   // of a sum: 1 / samples
uniform vec4 u_background;      // linear display light, premultiplied by alpha
uniform sampler2D u_background_image;  // linear display light, premultiplied
uniform vec4 u_background_uv;   // scale and offset that cover the picture without distortion

layout(location = 0) out vec4 o_color;

vec4 encoded(vec4 color) {
    // Files hold straight alpha.
    vec3 straight = color.a > 0.0 ? color.rgb * (1.0 / color.a) : vec3(0.0);
    return vec4(srgb_encode(clamp(straight, 0.0, 1.0)), color.a);
}

// Viewers blend codes, not light. Black with this alpha darkens a white page by as much as the shadow darkens white; surfaces
// keep the alpha of what they cover. `left`: what surfaces and shadow leave of the source, of which surfaces leave `share`.
vec4 encoded_with_shadow(vec4 color, float left, float share) {
    left = clamp(left, 0.0, 1.0);
    float lit = max(left / max(clamp(share, left, 1.0), 1e-6), 1e-4);
    float behind = min((1.0 - color.a) / lit, 1.0), covered = 1.0 - behind;
    float alpha = 1.0 - behind * srgb_encode(vec3(lit)).x;
    vec3 surface = srgb_encode(clamp(color.rgb / max(covered, 1e-6), 0.0, 1.0)) * covered;
    return vec4(surface / max(alpha, 1e-6), alpha);
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
    if (is_linear_output) {
        o_color = color;
    } else if (has_shadow) {
        float left = 1.0 - (is_sum ? source.a * u_sample_scale : source.a);
        o_color = encoded_with_shadow(color, left, left_to_catcher(uv));
    } else {
        o_color = encoded(color);
    }
}

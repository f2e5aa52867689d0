// Colours of tables into the finished picture: neither averaged over samples nor smoothed at edges.
#include "common_encoding.glsl"
#include "common_surface_kind.glsl"
#include "common_tone.glsl"

#feature OVERLAY has_overlay
#feature LAYERS has_layers
#feature LINEAR_OUTPUT is_linear_output

uniform sampler2D u_albedo;
uniform sampler2D u_material;
uniform sampler2D u_depth_target;
uniform vec2 u_size;
uniform sampler2D u_overlay;  // linear display light, premultiplied: lines; with layers: the colours and all over them
uniform sampler2D u_radiance;
uniform float u_exposure;

layout(location = 0) out vec4 o_color;

// With all layers over it.
vec3 under_layers(vec3 color, vec4 over, vec2 uv) {
    vec4 radiance = textureLod(u_radiance, uv, 0.0);
    vec4 light = displayed(radiance, u_exposure, radiance.a);
    // The overlay holds halves: where nothing came over the colour, the colour itself is finer.
    vec3 apart = abs(over.rgb - color) - color / 1024.0;
    bool same = max(apart.r, max(apart.g, apart.b)) <= 1e-7;
    return !same || light.a > 0.0 ? light.rgb * (1.0 - over.a) + over.rgb : color;
}

void main() {
    vec2 uv = gl_FragCoord.xy / u_size;
    bool seen = textureLod(u_depth_target, uv, 0.0).r > 0.0 && is_exact(textureLod(u_material, uv, 0.0).w);
    if (!seen) discard;
    vec3 color = textureLod(u_albedo, uv, 0.0).rgb;
    if (has_overlay) {
        vec4 over = textureLod(u_overlay, uv, 0.0);
        color = has_layers ? under_layers(color, over, uv) : color * (1.0 - over.a) + over.rgb;
    }
    o_color = vec4(is_linear_output ? color : srgb_encode(color), 1.0);
}

// Colours of tables into the finished picture: neither averaged over samples nor smoothed at edges.
#include "common_encoding.glsl"
#include "common_surface_kind.glsl"
#include "common_tone.glsl"

uniform sampler2D u_albedo;
uniform sampler2D u_material;
uniform vec2 u_size;
#ifdef OVERLAY
uniform sampler2D u_overlay;  // linear display light, premultiplied: lines; LAYERS: the colours and all over them
#endif
#ifdef LAYERS
uniform sampler2D u_radiance;
uniform float u_exposure;
#endif

layout(location = 0) out vec4 o_color;

void main() {
    vec2 uv = gl_FragCoord.xy / u_size;
    if (!is_exact(textureLod(u_material, uv, 0.0).w)) discard;
    vec3 color = textureLod(u_albedo, uv, 0.0).rgb;
#ifdef OVERLAY
    vec4 over = textureLod(u_overlay, uv, 0.0);
#endif
#ifdef LAYERS
    vec4 light = displayed(textureLod(u_radiance, uv, 0.0), u_exposure);
    // The overlay holds halves: where nothing came over the colour, the colour itself is finer.
    bool same = all(lessThanEqual(abs(over.rgb - color), color / 1024.0 + 1e-7));
    if (!same || light.a > 0.0) color = light.rgb * (1.0 - over.a) + over.rgb;
#elif defined(OVERLAY)
    color = color * (1.0 - over.a) + over.rgb;
#endif
#ifdef LINEAR_OUTPUT
    o_color = vec4(color, 1.0);
#else
    o_color = vec4(srgb_encode(color), 1.0);
#endif
}

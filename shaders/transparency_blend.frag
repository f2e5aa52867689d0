// A lit layer over the picture: premultiplied by its opacity. The picture is tone(radiance) (1 - o) + overlay, where o is
// the overlay's alpha, and each layer C with opacity a makes (1 - a) times that plus a times C of it:
// - a display colour goes into the overlay;
// - light goes into the radiance, with the weight a / (1 - o (1 - a)), while the overlay is weakened by 1 - a.
#include "common_surface_kind.glsl"

#feature OVERLAY has_overlay
#feature INTO_OVERLAY is_into_overlay
#feature WEAKEN_OVERLAY is_weakening_overlay
#feature EYE_DOME has_eye_dome

uniform sampler2D u_radiance;
uniform sampler2D u_albedo;
uniform sampler2D u_material;
uniform sampler2D u_overlay;
uniform sampler2D u_shade;
uniform vec2 u_size;

#if defined(INTO_OVERLAY) || defined(WEAKEN_OVERLAY)  // A second source is for the blending of light alone.
layout(location = 0) out vec4 o_color;
#else
layout(location = 0, index = 0) out vec4 o_color;
layout(location = 0, index = 1) out vec4 o_opacity;
#endif

void main() {
    vec2 uv = gl_FragCoord.xy / u_size;
    vec4 albedo = textureLod(u_albedo, uv, 0.0);
    float opacity = albedo.a;
    float code = textureLod(u_material, uv, 0.0).w;
    if ((is_into_overlay && !is_display(code)) || ((has_overlay || is_weakening_overlay) && is_display(code))) discard;
    vec4 light = textureLod(u_radiance, uv, 0.0);
#if defined(INTO_OVERLAY) || defined(WEAKEN_OVERLAY)  // As above.
    if (is_into_overlay) {
        if (has_eye_dome && is_eye_dome(code)) albedo.rgb *= textureLod(u_shade, uv, 0.0).r;
        o_color = vec4(albedo.rgb * opacity, opacity);
    } else {
        // Through glass the overlay is seen as far as the background is.
        o_color = vec4(0.0, 0.0, 0.0, opacity * light.a);
    }
#else
    if (has_overlay) {
        float overlay = textureLod(u_overlay, uv, 0.0).a, covering = opacity * light.a;
        opacity = covering > 0.0 ? opacity / (1.0 - overlay * (1.0 - covering)) : opacity;
    }
    o_color = vec4(light.rgb, light.a) * opacity;
    o_opacity = vec4(min(opacity, 1.0));
#endif
}

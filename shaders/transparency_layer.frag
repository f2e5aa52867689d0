// A lit layer over the picture, natively: the picture and its overlay at once, which are read where they are written. See
// transparency_blend.frag.
#include "common_surface_kind.glsl"

#feature OVERLAY has_overlay
#feature EYE_DOME has_eye_dome

uniform sampler2D u_albedo;
uniform sampler2D u_material;
uniform sampler2D u_depth_target;
uniform sampler2D u_light;     // of the layer
uniform sampler2D u_radiance;  // of the picture
uniform sampler2D u_overlay;
uniform sampler2D u_shade;     // of points without normals

layout(location = 0) out vec4 o_radiance;
layout(location = 1) out vec4 o_overlay;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (texelFetch(u_depth_target, pixel, 0).r == 0.0) discard;
    vec4 albedo = texelFetch(u_albedo, pixel, 0), light = texelFetch(u_light, pixel, 0);
    vec4 picture = texelFetch(u_radiance, pixel, 0);
    float opacity = albedo.a;
    o_overlay = vec4(0.0);
    if (has_overlay) {
        float code = texelFetch(u_material, pixel, 0).w;
        bool shown = is_display(code);
        float shade = 1.0;
        if (has_eye_dome) shade = is_eye_dome(code) ? texelFetch(u_shade, pixel, 0).r : 1.0;
        vec4 overlay = texelFetch(u_overlay, pixel, 0);
        float covering = albedo.a * light.a;
        opacity = !shown && covering > 0.0 ? opacity / max(1.0 - overlay.a * (1.0 - covering), 1e-20) : opacity;
        vec4 over = vec4(albedo.rgb * (albedo.a * shade), albedo.a) + overlay * (1.0 - albedo.a);
        // Through glass the overlay is seen as far as the background is.
        o_overlay = shown ? over : overlay * (1.0 - covering);
        opacity = shown ? 0.0 : opacity;
    }
    o_radiance = light * opacity + picture * (1.0 - min(opacity, 1.0));
}

// A point's disc or square into a shadow map.
#include "shadow_target.glsl"

#feature ROUND is_round
#feature ALPHA_MASK has_alpha_mask

flat in float v_alpha;
flat in vec2 v_extent;
uniform float u_alpha_cutoff;

void main() {
    vec2 at = abs(gl_PointCoord - 0.5);
    bool outside = is_round ? dot(at / v_extent, at / v_extent) > 1.0 : any(greaterThan(at, v_extent));
    if (v_extent.x > 0.0 && outside) discard;
    if (has_alpha_mask && v_alpha < u_alpha_cutoff) discard;
    if (is_tinting)
        write_tint(vec3(1.0 - v_alpha));
    else
        write_depth();
}

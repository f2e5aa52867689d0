// A surfel's ellipse into a shadow map.
#include "shadow_target.glsl"

#feature ALPHA_MASK has_alpha_mask

flat in float v_alpha;
in vec2 v_place;
uniform float u_alpha_cutoff;

void main() {
    if (dot(v_place, v_place) > 1.0) discard;
    if (has_alpha_mask && v_alpha < u_alpha_cutoff) discard;
    if (is_tinting)
        write_tint(vec3(1.0 - v_alpha));
    else
        write_depth();
}

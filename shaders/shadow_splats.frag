// The depth of a splat that casts, larger towards the light; or what a transparent one takes from the light.
#ifdef TINT
#include "common_tint.glsl"
#else
layout(location = 0) out float o_depth;
#endif
flat in float v_alpha;
#ifdef SURFEL
in vec2 v_place;
#else
flat in vec2 v_extent;
#endif
uniform float u_alpha_cutoff;

void main() {
#ifdef SURFEL
    if (dot(v_place, v_place) > 1.0) discard;
#else
    vec2 at = abs(gl_PointCoord - 0.5);
#ifdef ROUND
    if (v_extent.x > 0.0 && dot(at / v_extent, at / v_extent) > 1.0) discard;
#else
    if (v_extent.x > 0.0 && any(greaterThan(at, v_extent))) discard;
#endif
#endif
#if defined(ALPHA_MASK)
    if (v_alpha < u_alpha_cutoff) discard;
#endif
#ifdef TINT
    write_tint(vec3(1.0 - v_alpha));
#else
    o_depth = gl_FragCoord.z;
#endif
}

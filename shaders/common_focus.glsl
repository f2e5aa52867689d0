// How far a thin lens spreads what lies at a depth, and what it does not spread.
#include "common_surface_kind.glsl"

#feature OVERLAY has_overlay

uniform sampler2D u_material;
uniform vec2 u_focus;  // circle of confusion's radius in pixels: x (of what is infinitely far) - y times reversed depth

// Radius in pixels: negative before the plane in focus, positive behind it.
float confusion(float depth) { return u_focus.x - u_focus.y * depth; }

// 0 at surfaces whose colour is shown as it is, which have no light of their own; else 1.
float has_light(vec2 uv, float depth) {
    if (!has_overlay) return 1.0;
    return depth > 0.0 && is_display(textureLod(u_material, uv, 0.0).w) ? 0.0 : 1.0;
}

// How far a thin lens spreads what lies at a depth.
uniform vec2 u_focus;  // circle of confusion's radius in pixels: x (of what is infinitely far) - y times reversed depth

// Radius in pixels: negative before the plane in focus, positive behind it.
float confusion(float depth) { return u_focus.x - u_focus.y * depth; }

// The kinds of render/surface_kind.h, from the fourth channel of the material target.
bool is_lit(float code) { return code < 0.1; }
bool is_lit_point(float code) { return abs(code - 0.06) < 0.008; }
bool is_extended(float code) { return abs(code - 0.08) < 0.01; }
bool is_display(float code) { return code > 0.1 && code < 0.7; }
bool is_eye_dome(float code) { return abs(code - 0.4) < 0.1; }
bool is_exact(float code) { return abs(code - 0.6) < 0.1; }
bool is_ground_plane(float code) { return abs(code - 0.04) < 0.01; }
bool is_ground_catcher(float code) { return abs(code - 0.8) < 0.05; }

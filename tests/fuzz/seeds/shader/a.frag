#include "common_brdf.glsl"
#feature OWN has_own
#if 1
  #include "common_tone.glsl"
#endif
uniform float strength;
vec3 shade(vec3 color) { return has_own ? color * strength : color; }

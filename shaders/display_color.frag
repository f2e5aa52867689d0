// What is displayed of scene-linear radiance, sRGB-encoded: of splats that are lit, which are blended as they are displayed.
#include "common_encoding.glsl"
#include "common_tone.glsl"

uniform float u_exposure;

in vec3 v_radiance;

out vec3 o_color;

void main() { o_color = srgb_encode(tone_map(v_radiance * u_exposure)); }
